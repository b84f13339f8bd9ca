#pragma once
// Force sensors for calibrations. Each gives a stream of readings and counters of its health.

#include <cstdint>
#include <limits>
#include <string>
#include <vector>

namespace palpa::devices {

struct ForceReading {
    double t_host_s = 0.0;                                         // steady clock, stamped on arrival
    double t_device_s = std::numeric_limits<double>::quiet_NaN();  // clock of the sensor, with wrap-arounds undone
    double force_N = 0.0;  // pressing is positive; the reading without load is not subtracted
    double raw = 0.0;      // counts
};

struct SensorHealth {
    std::int64_t received = 0;    // readings handed on
    std::int64_t lost = 0;        // readings that never came, by the count or clock of the sensor
    std::int64_t duplicate = 0;   // readings that came twice; the second is dropped
    std::int64_t reordered = 0;   // readings that came after a later one, and are dropped
    std::int64_t malformed = 0;   // packets of a wrong length, garbled lines
    std::int64_t overflowed = 0;  // readings lost here, because nobody took them in time
    std::int64_t stalls = 0;      // silences over half a second
    std::int64_t reconnects = 0;
    std::int64_t faults = 0;   // readings with a status of the sensor that is not 0
    std::int64_t invalid = 0;  // of them those that are no forces (overload, ...), and are dropped
    bool alive = false;        // whether something came within the last half second
};

// A device, or its simulator behind the same protocol.
class ForceSensor {
  public:
    virtual ~ForceSensor() = default;
    // Appends the readings that arrived, oldest first, and waits up to `wait_s` for the first. It deals with silences and
    // with a device that is unplugged. It counts in `health` all but overflowed.
    virtual void read(double wait_s, std::vector<ForceReading>& out) = 0;
    virtual const SensorHealth& health() const = 0;
    virtual std::string name() const = 0;
};

// Returns seconds on the clock of Sample::t_host_s.
double steady_s();

}  // namespace palpa::devices
