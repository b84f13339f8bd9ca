#pragma once
// The inverse problem: which tensions and pressures bring the effector to the wanted depth (and tilt) while the finger
// presses with the wanted force?
//
// With W = J K^-1 H^T (J: gradient of what is observed, K: tangent stiffness, H: gradients of lengths and volumes) and d
// the gap that the linear model has with all actuators at zero, both from one factorisation,
//
//   minimise |W a + d|^2 + t sum_j |w_j|^2 a_j^2 + sum_j (r / range_j)^2 (a_j - a_before)^2,   lower <= a <= upper
//
// with t = SoftDevice::tikhonov (w_j: column of W) and r = SoftDevice::rate_term_m; slew limits narrow the bounds, ties
// of force make one unknown of several. The rate term is what keeps the pretension where W passes through 0.
// Source: equation (12) of "Soft tangible devices controlled by inverse FEM"; the terms besides the first are ours.

#include "tangible/device_model.h"

namespace palpa::tangible {

// step       one Newton step, as in the paper
// converged  Newton steps until nothing changes
// stale      one to three steps with a factor of an earlier tick, which is made anew when it no longer serves
// linear     the linear model of the device about the state of prepare_press()
enum class Fidelity { step, converged, stale, linear };
inline constexpr std::array<std::string_view, 4> kFidelityNames{"step", "converged", "stale", "linear"};
Fidelity fidelity_named(std::string_view name);  // one of kFidelityNames

struct Wanted {
    double depth_m = 0.0;          // of the effector, from its rest
    double force_N = 0.0;          // of the finger on the device, >= 0
    std::array<double, 2> tilt{};  // used where the device tilts
};

struct InverseOptions {
    Fidelity fidelity = Fidelity::step;
    double dt_s = 0.01;       // since the last step; for the slew limits alone
    bool slew = true;         // limit changes by rate_per_s
    double rate_share = 1.0;  // of rate_per_s
    bool rate_term = true;
};

struct InverseAnswer {
    DeviceStatus status = DeviceStatus::bad_input;
    Actuation actuation{};    // N, Pa: within the limits in every case
    Lengths command{};        // lengths of cables, volumes of cavities: the command by position
    double residual_m = 0.0;  // of the depth, as predicted: negative where the effector stays too high
    std::array<double, 2> tilt_residual{};
    int rank = 0;               // of W, with ties
    unsigned active = 0;        // bit j: actuator j is at a bound, or at a slew limit
    int limited_by = -1;        // the actuator whose limit keeps the target out of reach
    bool rate_limited = false;  // the target is not reached in this tick, as an actuator goes no faster
    int iterations = 0;         // Newton steps
    bool converged = false;     // the last step changed nothing (1e-9 of the body's size)
    int factorisations = 0;
    // the terms of the problem, for screens: rows depth, tilt, tilt; columns actuators
    Eigen::Matrix<double, 3, kMostActuators> W = Eigen::Matrix<double, 3, kMostActuators>::Zero();
    Eigen::Vector3d gap = Eigen::Vector3d::Zero();  // d, with the actuators at zero: m, 1, 1
};

// One tick. Nothing throws or allocates; where nothing can be found, the answer repeats the last actuation and says so.
InverseAnswer inverse_step(const DeviceModel& model, DeviceState& state, const Wanted& wanted,
                           const InverseOptions& options) noexcept;

}  // namespace palpa::tangible
