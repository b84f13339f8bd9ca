#pragma once
// Undoes the wrap-arounds of device clocks, which count milliseconds in 32 bits and start again from 0 every 49.7 days.

#include <cstdint>

namespace palpa::platform {

struct UnwrapState {
    bool started = false;
    std::uint32_t last_ms = 0;
    std::int64_t total_ms = 0;  // last_ms with all wrap-arounds undone
};

// Returns the clock's reading with its wrap-arounds undone, in ms; the first reading is returned as it is.
//
//   total += d,   d = now - last as a signed 32-bit difference
//
// Repeated readings give the same time again, and readings out of order a correspondingly earlier time. A gap of more
// than 2^31 ms (24.8 days) between two readings cannot be told from a step backwards.
inline double unwrap_ms(std::uint32_t now_ms, UnwrapState& state) {
    if (state.started) {
        state.total_ms += static_cast<std::int32_t>(now_ms - state.last_ms);
    } else {
        state.total_ms = now_ms;
        state.started = true;
    }
    state.last_ms = now_ms;
    return static_cast<double>(state.total_ms);
}

}  // namespace palpa::platform
