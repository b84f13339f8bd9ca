#pragma once
// Tells which records of a numbered stream are new.

#include <cstdint>

#include "devices/force_sensor.h"

namespace palpa::devices {

enum class Arrival : std::uint8_t { next, duplicate, late, restart };

struct Sequence {
    bool started = false;
    std::uint32_t last = 0;        // greatest number so far, before its wrap-arounds are undone
    std::uint64_t seen = 0;        // bit k is set if record last - k came
    std::int64_t total = 0;        // `last` with its wrap-arounds undone
    std::int64_t since_start = 0;  // records from the first one to `last`; older ones were never counted as lost
};

// Counts lost, duplicate and reordered records. A record that comes late had been counted as lost (unless it is older
// than the first one) and is taken off that count.
// A jump of more than 2^20 in either direction means that the sensor was restarted, and so does a number that is not new
// where the stream was silent before it.
Arrival track(std::uint32_t number, bool after_silence, Sequence& sequence, SensorHealth& health);

}  // namespace palpa::devices
