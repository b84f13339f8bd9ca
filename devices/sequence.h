#pragma once
// Which records of a numbered stream are new.

#include <cstdint>

#include "devices/force_sensor.h"

namespace palpa::devices {

enum class Arrival : std::uint8_t { next, duplicate, late, restart };

struct Sequence {
    bool started = false;
    std::uint32_t last = 0;        // the greatest so far, wrap-arounds apart
    std::uint64_t seen = 0;        // bit k: last - k came
    std::int64_t total = 0;        // `last` with its wrap-arounds undone
    std::int64_t since_start = 0;  // `last` - the first one: what is older was never counted as lost
};

// Counts lost, duplicate and reordered records. A record that comes late was counted as lost before (unless it is older
// than the first one), and no longer is.
// A jump of over 2^20 either way is no gap but a sensor that started anew.
Arrival track(std::uint32_t number, Sequence& sequence, SensorHealth& health);

}  // namespace palpa::devices
