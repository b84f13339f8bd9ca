#pragma once
// How true a soft device is: presses of known laws on a plant, and what came of them.

#include <functional>
#include <vector>

#include "tangible/plant_model.h"

namespace palpa::tangible {

// A finger that goes down and comes back, each way by a minimum-jerk path (Flash & Hogan, J. Neuroscience 5, 1985, equation
// 2), with the mean speed given.
struct PressMotion {
    double depth_m = 6e-3;
    double speed_m_per_s = 5e-3;
};
double press_time_s(const PressMotion& motion);
double press_depth_m(const PressMotion& motion, double time_s);

// One tick of a press: what was wanted at the place where the finger really was, and what it felt.
struct PressTick {
    double time_s = 0.0;
    double depth_m = 0.0;
    double wanted_N = 0.0;
    double rendered_N = 0.0;
    TangibleCommand command;
};

struct PressFigures {
    double wanted_N_per_m = 0.0;       // least squares through the origin, over depth
    double rendered_N_per_m = 0.0;     // the same of what was rendered
    double force_rms_percent = 0.0;    // rendered minus wanted force, press and release, of the greatest wanted one
    double force_worst_percent = 0.0;  // the greatest of them
    double hysteresis_N = 0.0;         // mean of rendered force pressing minus releasing, at the same depths
    double saturated_share = 0.0;      // of the ticks
    double rate_limited_share = 0.0;   // of the ticks
    int failed_ticks = 0;              // held or relaxed, or without equilibrium of the plant
    double failed_share = 0.0;         // of the ticks
    std::vector<PressTick> ticks;
    std::vector<double> tick_us;  // times of the loop's ticks
};

// One press in virtual time. The world is that of the plan. `progress` is told the share done, after every tick.
PressFigures run_press(const TangiblePlan& plan, const Plant& plant, const PressMotion& motion, std::uint64_t seed,
                       const std::function<void(double share)>& progress = {});

PressFigures figures_of(std::vector<PressTick> ticks);

// The stiffnesses (force over depth) that the device can have at a depth: on the two ways from the pretension to the ends of the
// actuators' bounds where each makes the device stiffer, and softer, as far as there is equilibrium.
struct Reach {
    double depth_m = 0.0;
    double lowest_N_per_m = 0.0;
    double highest_N_per_m = 0.0;
};
Reach reach_at(const TangiblePlan& plan, double depth_m);

}  // namespace palpa::tangible
