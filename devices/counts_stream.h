#pragma once
// A stream of counts with the sensor's own clock, lines "t_us,counts\n" (load_cell.h has their parser), by a serial line or by
// UDP: of a load cell, or of what measures a displacement.
//
// By UDP each datagram holds whole lines. The sensor sends to whoever wrote "start\n" to it, for two seconds: the stream asks
// twice a second. Tried with devices/simulators only.

#include <memory>
#include <string>
#include <vector>

#include "devices/force_sensor.h"
#include "devices/load_cell.h"

namespace palpa::platform {
class SerialPort;
class UdpPort;
}  // namespace palpa::platform

namespace palpa::devices {

struct CountsReading {
    double t_host_s = 0.0;    // steady clock, stamped on arrival
    double t_device_s = 0.0;  // clock of the sensor, wrap-arounds undone
    std::int32_t counts = 0;
};

struct CountsPlace {
    std::string path;  // of the serial line
    int baud = 115200;
    std::string host;  // by UDP, if it is not empty
    int port = 0;
};

// Opens a port that was unplugged again, twice a second.
class CountsStream {
  public:
    // Throws std::runtime_error with the system's reason.
    explicit CountsStream(const CountsPlace& place);
    ~CountsStream();
    CountsStream(const CountsStream&) = delete;
    CountsStream& operator=(const CountsStream&) = delete;

    // Appends the readings that arrived, oldest first, and waits up to `wait_s` for the first.
    void read(double wait_s, std::vector<CountsReading>& out);
    const SensorHealth& health() const { return health_; }

  private:
    int read_bytes(double wait_s, std::uint8_t* bytes, std::size_t room);
    int reopen(double wait_s);
    void ask();
    void take(const LoadCellLine& line, std::vector<CountsReading>& out);

    CountsPlace place_;
    std::unique_ptr<platform::SerialPort> serial_;
    std::unique_ptr<platform::UdpPort> udp_;
    LineParser parser_;
    LoadCellClock clock_;
    SensorHealth health_;
    double last_s_ = 0.0;
    double tried_s_ = 0.0;
    double asked_s_ = -1e9;
};

}  // namespace palpa::devices
