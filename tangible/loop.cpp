#include "tangible/loop.h"

#include <algorithm>
#include <cmath>

namespace palpa::tangible {
namespace {

constexpr double kLongestPrediction_s = 0.05;

// Takes over a reading that is new.
void take_reading(const TangibleFeedback& feedback, SensorTrack& track) {
    if (track.n > 0 && feedback.sensor_s <= track.time_s[1]) return;
    track.time_s[0] = track.time_s[1];
    track.depth_m[0] = track.depth_m[1];
    track.time_s[1] = feedback.sensor_s;
    track.depth_m[1] = feedback.sensor_m;
    track.n = std::min(track.n + 1, 2);
}

// The finger now: on a straight line through the last two readings, where the sensor is slower than the loop.
double finger_depth_m(const TangiblePlan& plan, double now_s, const SensorTrack& track) {
    const double period_s = 1.0 / plan.loop.rate_Hz;
    const double apart_s = track.time_s[1] - track.time_s[0];
    if (!plan.loop.predict || track.n < 2 || apart_s < 1.2 * period_s || apart_s > 0.5) return track.depth_m[1];
    const double ahead_s = std::clamp(now_s - track.time_s[1], 0.0, std::min(apart_s, kLongestPrediction_s));
    return track.depth_m[1] + ahead_s * (track.depth_m[1] - track.depth_m[0]) / apart_s;
}

double longest_silence_s(const TangiblePlan& plan) {
    return std::max(plan.loop.silence_s, 3.0 / plan.model->device.sensor.rate_Hz);
}

TickFault fault_of(DeviceStatus status) {
    switch (status) {
        case DeviceStatus::good:
        case DeviceStatus::unstable:
            return TickFault::none;
        case DeviceStatus::slow:
            return TickFault::slow;
        case DeviceStatus::no_equilibrium:
            return TickFault::no_equilibrium;
        case DeviceStatus::bad_input:
            return TickFault::bad_input;
    }
    return TickFault::bad_input;
}

// What is wrong with the input of this tick.
TickFault fault_of(const TangiblePlan& plan, const TangibleInput& in) {
    if (in.feedback.stopped > 0.5) return TickFault::stopped;
    if (!(in.feedback.has_sensor > 0.5)) return TickFault::no_sensor;
    if (!std::isfinite(in.time_s) || !std::isfinite(in.feedback.sensor_m) || !std::isfinite(in.feedback.sensor_s) ||
        (in.has_place && !in.place_m.allFinite()))
        return TickFault::bad_input;
    return in.time_s - in.feedback.sensor_s > longest_silence_s(plan) ? TickFault::no_sensor : TickFault::none;
}

void copy_terms(const InverseAnswer& answer, TangibleCommand& out) {
    for (std::size_t j = 0; j < static_cast<std::size_t>(out.actuators); ++j)
        out.compliance[j] = answer.W(0, static_cast<Eigen::Index>(j));
    out.gap_m = answer.gap(0);
    out.residual_m = answer.residual_m;
    out.rank = answer.rank;
    out.active = answer.active;
    out.limited_by = answer.limited_by;
    out.iterations = answer.iterations;
    out.converged = answer.converged;
    out.saturated = out.saturated || answer.limited_by >= 0;
    out.rate_limited = answer.rate_limited;
}

// Holds the last valid command for a while, and then relaxes the device until the finger is lifted.
void fail(const TangiblePlan& plan, TickFault fault, TangibleState& state, TangibleCommand& out) {
    out.fault = fault;
    if (state.failing_since_s < 0.0) state.failing_since_s = out.time_s;
    constexpr double kRounding_s = 1e-6;
    const bool held_long = out.time_s - state.failing_since_s > plan.loop.hold_s - kRounding_s;
    if (fault == TickFault::stopped || held_long) state.relaxed = true;
    if (!state.relaxed) {
        out.held = true;
        out.actuation = state.actuation;
        out.length = state.length;
        return;
    }
    out.relaxed = true;
    out.actuation = plan.relaxed;
    out.length = plan.relaxed_length;
    out.wanted_N = 0.0;
}

// Tells the drives so much more, or less, that after a period they give what is wanted: the exact inverse of a first-order lag,
// as far as the actuators' bounds and rates allow. A command that is held or relaxed is told as it is.
void undo_lag(const TangiblePlan& plan, TangibleState& state, TangibleCommand& out) {
    const double lag_s = plan.model->device.fit.lag_s;
    if (!plan.loop.compensate_lag || !(lag_s > 0.0)) return;
    const double left = std::exp(-1.0 / (plan.loop.rate_Hz * lag_s));
    const bool leads = out.fault == TickFault::none;
    for (std::size_t j = 0; j < static_cast<std::size_t>(out.actuators); ++j) {
        const SoftActuator& actuator = plan.model->actuators[j];
        double& told = out.actuation[j];
        const double most = leads && actuator.rate_per_s > 0.0 ? actuator.rate_per_s / plan.loop.rate_Hz : HUGE_VAL;
        if (leads) told = std::clamp((told - left * state.drive[j]) / (1.0 - left), actuator.lower, actuator.upper);
        told = std::clamp(told, state.told[j] - most, state.told[j] + most);
        state.told[j] = told;
        state.drive[j] = told + left * (state.drive[j] - told);
        double& told_m = out.length[j];
        if (leads) told_m = (told_m - left * state.drive_length[j]) / (1.0 - left);
        state.drive_length[j] = told_m + left * (state.drive_length[j] - told_m);
    }
}

// Ends the rest after a fault once the finger is off the device.
bool may_go_on(const TangiblePlan& plan, double depth_m, TangibleState& state) {
    if (!state.relaxed) return true;
    if (depth_m > plan.model->device.depth_floor_m) return false;
    state.device = plan.start;
    state.relaxed = false;
    return true;
}

// A drive has to pull more than the body gets while its cable is wound in, and less while it is paid out.
void undo_friction(const TangiblePlan& plan, const Lengths& before, TangibleCommand& out) {
    const double share = plan.model->device.fit.friction_share;
    if (!plan.loop.compensate_friction || !(share > 0.0)) return;
    const double dt_s = 1.0 / plan.loop.rate_Hz;
    for (std::size_t j = 0; j < static_cast<std::size_t>(out.actuators); ++j) {
        const SoftActuator& actuator = plan.model->actuators[j];
        if (actuator.kind != ActuatorKind::cable) continue;
        const double wound = friction_sense((before[j] - out.length[j]) / dt_s);
        out.actuation[j] = std::clamp(out.actuation[j] / (1.0 - share * wound), actuator.lower, actuator.upper);
    }
}

// What the body is to get. Into `out`, but for the time and the kind of command.
void want(const TangiblePlan& plan, const TangibleInput& in, TangibleState& state, TangibleCommand& out) {
    if (const TickFault fault = fault_of(plan, in); fault != TickFault::none) return fail(plan, fault, state, out);
    take_reading(in.feedback, state.track);
    out.depth_m = finger_depth_m(plan, in.time_s, state.track) - plan.model->device.fit.zero_m;
    const Eigen::Vector2d place_m = plan.place_follows && in.has_place ? in.place_m : plan.place_m;
    const WorldForce world = world_force(plan.world, place_m, out.depth_m, state.world);
    out.world_depth_m = world.depth_m;
    out.proxy_m = world.proxy_m;
    out.wanted_N = world.force_N;
    out.slope_N_per_m = world.slope_N_per_m;
    out.pressed = out.depth_m > 0.0;
    out.saturated = world.saturated;
    if (!may_go_on(plan, out.depth_m, state)) return fail(plan, TickFault::no_equilibrium, state, out);
    const InverseAnswer answer =
        inverse_step(*plan.model, state.device, {std::max(0.0, out.depth_m), out.wanted_N, {}}, plan.loop.inverse);
    copy_terms(answer, out);
    if (const TickFault fault = fault_of(answer.status); fault != TickFault::none) return fail(plan, fault, state, out);
    state.failing_since_s = -1.0;
    out.actuation = answer.actuation;
    out.length = answer.command;
    undo_friction(plan, state.length, out);
    state.actuation = out.actuation;
    state.length = out.length;
}

}  // namespace

const char* text_of(TickFault fault) {
    switch (fault) {
        case TickFault::none:
            return "";
        case TickFault::stopped:
            return "stopped";
        case TickFault::no_sensor:
            return "no reading from the displacement sensor";
        case TickFault::bad_input:
            return "a reading is not a number";
        case TickFault::no_equilibrium:
            return "no equilibrium of the device was found under this force";
        case TickFault::slow:
            return "the device's equilibrium was not found in time";
    }
    return "";
}

double friction_sense(double wound_m_per_s) noexcept {
    constexpr double kFull_m_per_s = 0.5e-3;
    return std::clamp(wound_m_per_s / kFull_m_per_s, -1.0, 1.0);
}

TangibleState make_tangible_state(const TangiblePlan& plan) {
    TangibleState state;
    state.device = plan.start;
    state.world = scene::make_work(*plan.world.tissue);
    state.actuation = plan.start.pretension;
    state.length = lengths(*plan.model, plan.start.u_m);
    state.told = state.drive = state.actuation;
    state.drive_length = state.length;
    return state;
}

TangibleCommand tangible_tick(const TangiblePlan& plan, const TangibleInput& in, TangibleState& state) noexcept {
    TangibleCommand out;
    out.time_s = std::isfinite(in.time_s) ? in.time_s : 0.0;
    out.actuators = plan.model->n_actuators();
    want(plan, in, state, out);
    undo_lag(plan, state, out);
    return out;
}

}  // namespace palpa::tangible
