#pragma once
// The device linearised at its present shape, as an answer of its few channels (the finger, then the actuators) to their
// forces.
//
// Each channel k has a coordinate v_k (the depth; minus q of actuator k) and a force p_k that works on it, so that the
// nodes get B p with B = dv/du. From one factorisation, X = K^-1 B and G = B^T X:
//
//   du = x_r + X p,   dv = y_r + G p        x_r = K^-1 r, y_r = B^T x_r, r: what is out of balance without p
//
// K is not the device's tangent where actuators are tied in motion, but K + h B_t B_t^T: as if these cables were held by
// springs of stiffness h, which keeps the matrix positive where the tie does (a strip that only its two cables
// hold may slide to and fro). What the springs add is taken away exactly: with
// p' = p + h dv + T m, T the conditions of equal motion (T^T v = 0) and m their forces, dv solves
//
//   (1 - G h) dv - G T m = y_r + G p,   T^T dv = - T^T v
//
// Source: Woodbury's formula, as in Nocedal & Wright, Numerical Optimization (2006), appendix A; the use is ours.

#include "tangible/device_model.h"

namespace palpa::tangible {

inline constexpr double kMostMove = 0.08;  // of a node in one Newton step, over the body's size

inline int channels_of(const DeviceModel& model) { return 1 + model.n_actuators(); }

// Sums forces and tangent at state.u_m with the forces of state.actuation, and factors. False if the energy is infinite
// or nothing can be factored. state.repaired: whether the tangent had to be made positive.
bool factor_tangent(const DeviceModel& model, DeviceState& state) noexcept;
// Sums the forces alone, with a factor of earlier. False if the energy is infinite.
bool sum_forces(const DeviceModel& model, DeviceState& state) noexcept;

// The energy of body, bearings and weight at the present shape, J; infinite where a law is not defined.
double device_energy_J(const DeviceModel& model, const DeviceState& state) noexcept;

// Solves for what is out of balance (after either of the two above) and fills the response.
Response respond(const DeviceModel& model, DeviceState& state) noexcept;

// The displacement under channel forces p: writes it to the column that held x_r, and returns its greatest entry (m).
double solve_displacement(const DeviceModel& model, DeviceState& state, const Response& response,
                          const SmallColumn& p) noexcept;
// Adds share times that displacement, and sets the forces of the state to p.
void move(const DeviceModel& model, DeviceState& state, const Response& response, const SmallColumn& p,
          double share) noexcept;

// What each channel is led by: its force p, or its coordinate v.
struct Goal {
    SmallColumn value;
    std::array<bool, kMostChannels> by_position{};
};
// The same by as much of the step as lowers the energy, with a penalty for what is not yet where positions and ties of
// motion want it (an augmented Lagrangian function; Nocedal & Wright, section 17.3). Small steps are taken as they are.
// most_m: the greatest entry of the step.
void search(const DeviceModel& model, DeviceState& state, const Response& response, const Goal& goal,
            const SmallColumn& p, double most_m) noexcept;
// The forces of move() alone.
void set_forces(const DeviceModel& model, DeviceState& state, const Response& response, const SmallColumn& p) noexcept;

// Makes the linear model of the state about its present shape: one factorisation. False if nothing can be factored.
bool make_linear(const DeviceModel& model, DeviceState& state) noexcept;

// Moves the shifts of bearings that are constraints; returns the greatest change (m).
double move_all_shifts(const DeviceModel& model, DeviceState& state) noexcept;

// v of all channels at the present shape; the depth counts from the shape at rest.
SmallColumn coordinates(const DeviceModel& model, const DeviceState& state) noexcept;
std::array<double, 2> tilts(const DeviceModel& model, const DeviceState& state) noexcept;

}  // namespace palpa::tangible
