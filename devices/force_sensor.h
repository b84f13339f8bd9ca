#pragma once
// Force sensors for calibrations, as one stream of readings with health counters.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace palpa::devices {

struct ForceReading {
    double t_host_s = 0.0;                                         // steady clock, stamped on arrival
    double t_device_s = std::numeric_limits<double>::quiet_NaN();  // the sensor's own clock, wrap-arounds undone
    double force_N = 0.0;  // pressing is positive; what is read without load is not subtracted
    double raw = 0.0;      // counts
};

struct SensorHealth {
    std::int64_t received = 0;    // readings that were handed on
    std::int64_t lost = 0;        // never came, by the sensor's own count or clock
    std::int64_t duplicate = 0;   // came twice; the second is dropped
    std::int64_t reordered = 0;   // came after a later one; dropped
    std::int64_t malformed = 0;   // wrong length, garbled line
    std::int64_t overflowed = 0;  // lost by us: nobody took them in time
    std::int64_t stalls = 0;      // silences over half a second
    std::int64_t reconnects = 0;
    std::int64_t faults = 0;  // readings with an error status of the sensor (overload, ...)
    bool alive = false;       // something came within the last half second
};

// A device, or its simulator behind the same protocol.
class ForceSensor {
  public:
    virtual ~ForceSensor() = default;
    // Appends what arrived, oldest first, waiting up to `wait_s` for the first; takes care of silences and of a device
    // that was unplugged by itself. `health` is this sensor's own, all but overflowed.
    virtual void read(double wait_s, std::vector<ForceReading>& out) = 0;
    virtual const SensorHealth& health() const = 0;
    virtual std::string name() const = 0;
};

// Seconds on the clock of the samples' t_host_s.
double steady_s();

}  // namespace palpa::devices
