#pragma once
// The figures of a run of the loop, and how `palpa tactile run --json` spells them.

#include <cstdint>
#include <string>
#include <vector>

#include "devices/arm_link.h"
#include "devices/limits.h"
#include "files/json.h"
#include "tactile/loop.h"
#include "tactile/mismatch.h"

namespace palpa::tactile {

// Sums over steps. Depends on the rows of input alone.
struct StepFigures {
    std::int64_t steps = 0;
    std::int64_t pressed_steps = 0;
    std::int64_t held_steps = 0;
    std::int64_t relaxed_steps = 0;  // at which a fault kept all at rest: they count in no figure of what was rendered
    std::int64_t inexact_steps = 0;
    std::int64_t over_edge_steps = 0;
    double max_force_N = 0.0;
    double max_depth_m = 0.0;
    double linearity = 0.0;      // the greatest
    double clipped_share = 0.0;  // of the pins, summed over the pressed steps
    double least_scale = 1.0;
};
// `rendered`: false while a fault keeps all at rest.
void add(const LoopCommand& step, bool rendered, StepFigures& figures);

// Depends on devices and the wall clock. Times that nobody measured are NaN, and null in JSON.
struct DeviceFigures {
    std::int64_t late_steps = 0;  // begun more than 1 ms late
    double step_p50_us = std::numeric_limits<double>::quiet_NaN();
    double step_p99_us = std::numeric_limits<double>::quiet_NaN();
    bool real_time = false;  // the loop had the scheduler's real-time priority
    double round_trip_p50_s = std::numeric_limits<double>::quiet_NaN();
    double round_trip_p99_s = std::numeric_limits<double>::quiet_NaN();
    std::int64_t lost = 0;        // packets of the link
    std::int64_t arm_rested = 0;  // as in LinkHealth
    devices::Guard guard;
    const char* reached_by = "nothing";  // estimate, or simulator: the simulated pins' true heights
};

// Keys: pairing, schedule, leads, steps, late_steps, held_steps, relaxed_steps, max_force_N, mismatch_mm {rms, max},
// mismatch_ms, clipped_share, linear_range, step_us {p50, p99}, link {round_trip_ms {p50, p99}, lost}, faults [{fault, times}],
// warnings and more (docs/tactile.md). Parts that the scene does not have are null.
files::Json figures_json(const TactilePlan& plan, const StepFigures& steps, const MismatchMeter& mismatch,
                         const DeviceFigures& devices);

// Copies the link's counters.
void take_link(const devices::LinkHealth& link, DeviceFigures& figures);

}  // namespace palpa::tactile
