#pragma once
// What a sample changes: all that a replay must reproduce, and what is shown.

#include <array>
#include <optional>

#include "avatar/delay.h"
#include "avatar/display_ratio.h"
#include "platform/timeline.h"
#include "scene/meter.h"
#include "scene/plan.h"

namespace palpa::scene {

// The indenter's avatar as it is shown.
struct Avatar {
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    Eigen::Vector2d lag_m = Eigen::Vector2d::Zero();  // pen - avatar
    double delay_s = 0.0;                             // of the law `delay`
    // By which the texture of the tissue is dragged along with a finger (TextureDrag).
    Eigen::Vector2d texture_m = Eigen::Vector2d::Zero();
};

// Returns how far the avatar is seen to lag behind the pen over the tissue.
inline double seen_lag_m(const Avatar& avatar) { return (avatar.lag_m + avatar.texture_m).norm(); }

// Counted since start(); of samples unless a line says otherwise.
struct Counters {
    std::int64_t samples = 0;
    std::int64_t steps = 0;             // grid steps that were taken
    std::int64_t dropped_steps = 0;     // grid steps that were left out during a touch
    std::int64_t skipped_stations = 0;  // stations of the path that StationLimit left out
    std::int64_t skipped_slides = 0;    // friction steps that a jump of the pen left out
    std::int64_t levels_clamped = 0;    // levels outside the profile's range
    std::int64_t without_level = 0;     // touching, but the device reported no level
    std::int64_t distrusted = 0;        // first of a touch, with a level that no touch begins with
    std::int64_t palms = 0;             // touches of fingers that ended because a pen came down
    std::int64_t saturated = 0;         // Contact::saturated
    std::int64_t inexact = 0;           // Contact::inexact
    std::int64_t off_tissue = 0;        // touching beside the tissue
    std::int64_t not_numbers = 0;       // with a position that is not finite
    std::int64_t unmeasured = 0;        // not Contact::measured
};

static_assert(sizeof(Counters) == 14 * sizeof(std::int64_t));  // all are added
inline Counters& operator+=(Counters& sum, const Counters& other) {
    for (std::int64_t Counters::*one :
         {&Counters::samples, &Counters::steps, &Counters::dropped_steps, &Counters::skipped_stations,
          &Counters::skipped_slides, &Counters::levels_clamped, &Counters::without_level, &Counters::distrusted,
          &Counters::palms, &Counters::saturated, &Counters::inexact, &Counters::off_tissue, &Counters::not_numbers,
          &Counters::unmeasured})
        sum.*one += other.*one;
    return sum;
}

// Greatest values since start().
struct Extremes {
    double force_N = 0.0;
    double force_at_s = 0.0;  // when the force was greatest, on the timeline
    double depth_m = 0.0;
    double lag_m = 0.0;
    double lag_at_s = 0.0;  // when the lag was greatest, on the timeline
};

// Pointers of fingers that were on the screen while a pen pressed, and so may be of the hand that holds it. They do not
// press until they are lifted.
struct Palms {
    std::array<std::int64_t, 16> pointers{};
    std::size_t count = 0;
};

struct State {
    platform::Timeline timeline;
    View view;
    ScreenArea screen;
    std::optional<std::int64_t> pointer;  // the pointer that touches; the others are logged but do not press
    platform::Tool pointer_tool = platform::Tool::mouse;
    Palms palms;
    bool without_level = false;    // the last sample of the touch lacks the level that the profile reads
    bool answered = false;         // the stages ran for the last sample: it was that pointer's, or nothing touched
    avatar::Touch touch;           // the last calibrated sample; its t_s is not used, see timeline
    TissueWork tissue;             // of the plan's tissue
    const char* method = nullptr;  // that the last action `method` changed to; null if it changed nothing
    Contact contact;
    Avatar avatar;
    Eigen::Vector2d heading = Eigen::Vector2d::Zero();  // direction of motion, length 1; 0 before the first motion
    Eigen::Vector2d heading_rope_m = Eigen::Vector2d::Zero();  // end of a rope that the pen drags, against jitter
    std::optional<avatar::DisplayRatioState> display_ratio;
    std::optional<avatar::DelayState> delay;
    double grid_began_s = 0.0;   // time of the first sample
    std::int64_t grid_step = 0;  // index of the last grid step that was due
    Counters counters;
    Extremes extremes;
    // Cost of the stages, which a replay does not reproduce. Every `time_every`-th sample is timed; 0 for none.
    int time_every = 0;
    std::array<Meter, kStageCount> meters;
};

}  // namespace palpa::scene
