#pragma once
// Where pins on RC servos are by estimate: a servo reports nothing.
//
// A board takes new targets once per frame; a servo then follows like a first-order lag whose speed is limited:
//   dh/dt = (target - h) / tau,  |dh/dt| <= speed
// Frame and speed come from the device file; tau is assumed (12 ms, a usual RC servo without load).

#include <array>
#include <span>

#include "devices/pins.h"

namespace palpa::tactile {

inline constexpr double kAssumedServo_s = 12e-3;

struct PinDynamics {
    double frame_s = 20e-3;
    double lag_s = kAssumedServo_s;
    double speed_m_per_s = 0.03;
};

struct PinEstimate {
    std::array<double, devices::kMostPins> height_m{};
    std::array<double, devices::kMostPins> target_m{};  // of the present frame
    double time_s = 0.0;
    double frame_due_s = 0.0;
    bool begun = false;
};

// Goes to a time, with the heights that are commanded from then on. Starts at rest_m.
void estimate_pins(const PinDynamics& dynamics, double rest_m, double time_s, std::span<const double> commanded_m,
                   PinEstimate& estimate) noexcept;

}  // namespace palpa::tactile
