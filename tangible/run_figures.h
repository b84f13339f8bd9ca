#pragma once
// The figures of a run of the loop, and how `palpa tangible run --json` spells them.

#include <array>
#include <cstdint>

#include "files/json.h"
#include "tangible/loop.h"

namespace palpa::tangible {

inline constexpr std::size_t kTickFaults = 6;  // of TickFault

// Sums over ticks. Depends on the rows of input and the plant alone.
struct TickFigures {
    std::int64_t ticks = 0;
    std::int64_t pressed_ticks = 0;
    std::int64_t saturated_ticks = 0;
    std::int64_t rate_limited_ticks = 0;
    std::int64_t held_ticks = 0;
    std::int64_t relaxed_ticks = 0;
    std::int64_t compared_ticks = 0;  // pressed, and with a rendered force
    double greatest_wanted_N = 0.0;
    double squares_N2 = 0.0;                         // of rendered minus wanted
    std::array<std::int64_t, kTickFaults> faults{};  // how often each began
    TickFault last = TickFault::none;
};
// rendered_N: NaN where nobody knows.
void add(const TangibleCommand& tick, double rendered_N, TickFigures& figures);

// NaN without a rendered force, or where nothing was wanted.
double force_rms_percent(const TickFigures& figures);

// Depends on the wall clock. Times that nobody measured are NaN, and null in JSON.
struct ClockFigures {
    std::int64_t missed_ticks = 0;
    double period_p50_us = std::numeric_limits<double>::quiet_NaN();
    double period_p99_us = std::numeric_limits<double>::quiet_NaN();
    double period_worst_us = std::numeric_limits<double>::quiet_NaN();
    double tick_p50_us = std::numeric_limits<double>::quiet_NaN();
    double tick_p99_us = std::numeric_limits<double>::quiet_NaN();
};

// Keys: device, fidelity, command, rate_Hz, ticks, missed_ticks, period_us {p50, p99, worst}, tick_us {p50, p99}, force_rms_percent,
// saturated_share, rate_limited_share, held_ms, relaxed_ms, faults [{fault, times}], notes.
files::Json figures_json(const TangiblePlan& plan, const TickFigures& ticks, const ClockFigures& clock);

}  // namespace palpa::tangible
