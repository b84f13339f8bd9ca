#pragma once
// Pressure for devices without a sensor: a button, a key, a pen or a finger presses harder the longer it is held,
// or with a level that is set in notches.

#include <cstdint>

namespace palpa::platform {

inline constexpr double kHoldGrid_Hz = 240.0;  // rate of samples while a button or key is held
inline constexpr double kLevelStep = 0.05;     // pressure per notch

struct HeldPressure {
    double hold_s = 2.0;  // from no pressure to full
    bool down = false;
    double down_s = 0.0;    // when it went down
    bool by_level = false;  // a notch has set `level`; the time no longer counts
    double level = 0.0;     // 0..1
};

// Returns the share of the hold time that has passed, 0..1. A hold time of 0 or less gives full pressure at once.
double held_share(double held_s, double hold_s);

// Returns the pressure at `t_host_s`, 0..1; while nothing is held, the level that is set.
double pressure_at(const HeldPressure& held, double t_host_s);

// Turns the level by notches. A notch during a press starts from the pressure that holding has reached. Once the level
// is turned back to zero while nothing is held, the hold time counts again.
void turn_level(double t_host_s, double notches, HeldPressure& held);

// Point k of the grid is at the time k / kHoldGrid_Hz. last_grid_point() is the last point at or before `t_s`.
std::int64_t last_grid_point(double t_s);
double grid_time_s(std::int64_t point);

// Returns the first of the grid points up to `now` that have no sample yet, if `done` is the last point that has one.
// After a minute or more without a call (the computer slept), only the last minute is made up.
std::int64_t first_grid_point(std::int64_t done, std::int64_t now);

}  // namespace palpa::platform
