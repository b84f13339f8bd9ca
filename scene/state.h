#pragma once
// What a sample changes: all that a replay must restore, and what is shown.

#include <array>
#include <optional>

#include "avatar/delay.h"
#include "avatar/display_ratio.h"
#include "platform/timeline.h"
#include "scene/meter.h"
#include "scene/plan.h"

namespace palpa::scene {

// What is shown of the indenter. lag = pen - avatar.
struct Avatar {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d lag_m = Eigen::Vector2d::Zero();
    double delay_s = 0.0;
};

struct Counters {
    std::int64_t samples = 0;
    std::int64_t steps = 0;  // of the 240 Hz grid
    std::int64_t dropped_steps = 0;
    std::int64_t skipped_stations = 0;  // of the path, where the pen was too fast for the tissue's cost
    std::int64_t skipped_slides = 0;    // of friction, where it leapt
    std::int64_t levels_clamped = 0;    // outside the profile's range
    std::int64_t without_level = 0;     // touching, but the device reported no level
    std::int64_t distrusted = 0;        // first samples of a press with a level that no touch begins with
    std::int64_t palms = 0;             // fingers' touches that ended because a pen came
    std::int64_t saturated = 0;
    std::int64_t off_tissue = 0;   // touching beside the tissue
    std::int64_t not_numbers = 0;  // a position that is not finite
    std::int64_t unmeasured = 0;   // touches on cells that were not measured
};

struct Extremes {
    double force_N = 0.0;
    double force_at_s = 0.0;  // when the force was greatest
    double depth_m = 0.0;
    double lag_m = 0.0;
    double lag_at_s = 0.0;  // when the lag was greatest
};

// Fingers that rested on the screen while a pen pressed: hands. None of them presses until it is lifted.
struct Palms {
    std::array<std::int64_t, 16> pointers{};
    std::size_t count = 0;
};

struct State {
    platform::Timeline timeline;
    View view;
    ScreenArea screen;
    std::optional<std::int64_t> pointer;  // the one that touches; others are logged, and press nothing
    platform::Tool pointer_tool = platform::Tool::mouse;
    Palms palms;
    bool without_level = false;  // the device of this touch does not report what the profile reads
    bool answered = false;       // the last sample belonged to it (or nothing touches)
    avatar::Touch touch;
    TissueWork tissue;  // of the plan's tissue
    Contact contact;
    Avatar avatar;
    Eigen::Vector2d heading = Eigen::Vector2d::Zero();  // direction of motion, length 1 once moving
    Eigen::Vector2d heading_rope_m = Eigen::Vector2d::Zero();
    std::optional<avatar::DisplayRatioState> display_ratio;
    std::optional<avatar::DelayState> delay;
    double grid_began_s = 0.0;   // with the first sample
    std::int64_t grid_step = 0;  // index of the last grid point
    Counters counters;
    Extremes extremes;
    // Measurements mean nothing to a replay: every `time_every`-th sample is timed, 0 for none.
    int time_every = 0;
    std::array<Meter, kStageCount> meters;
};

}  // namespace palpa::scene
