#include "tactile/loop.h"

#include <algorithm>

namespace palpa::tactile {
namespace {

MotionSample sample_of(const TactilePlan& plan, const LoopInput& in) {
    if (plan.options.leads == scene::Leads::arm) {
        const devices::ArmFeedback& arm = in.feedback.arm;
        const double value = plan.input == InputKind::depth ? arm.depth_m : (arm.has_sensor > 0.5 ? arm.sensor_N : 0.0);
        return {in.time_s, arm.x_m, arm.y_m, value};
    }
    const TouchInput& touch = in.touch;
    const double value = plan.input == InputKind::depth ? touch.depth_m : touch.force_N;
    return {touch.time_s, touch.x_m, touch.y_m, touch.down ? value : 0.0};
}

// The renderer holds force and depth at the force limit.
Press press_at(const TactilePlan& plan, const MotionSample& at, bool by_table, RendererWork& work) {
    if (by_table && work.table == nullptr) {
        if (const Table* table = table_of(plan)) adopt(table, work);
    }
    const Eigen::Vector2d place_m(at.x_m, at.y_m);
    return plan.input == InputKind::depth ? press_to_depth(plan.renderer, place_m, at.value, work)
                                          : press_with_force(plan.renderer, place_m, at.value, work);
}

void heights_of(const TactilePlan& plan, const Press& press, RendererWork& work, LoopState& state,
                mechanics::PinReport& report) {
    shape_m(plan.renderer, work, state.sink_m);
    mechanics::pins_from_sinks_m(*plan.pins, press.depth_m, state.sink_m, state.height_m, report);
}

// Rounds state.height_m into the command. With dither that happens once per frame of the boards, since they take no more.
void round_heights(const TactilePlan& plan, double time_s, LoopState& state) {
    if (plan.options.display->dither) {
        if (state.rounded && time_s < state.rounded_due_s) return;
        state.rounded_due_s = time_s + plan.pin_dynamics.frame_s - 0.5 * kStep_s;
    }
    state.rounded = true;
    mechanics::round_to_steps_m(*plan.pins, state.carried_m, state.height_m);
    state.commanded_m = state.height_m;
}

void move_pins(const TactilePlan& plan, const LoopInput& in, const Press& now, LoopState& state, LoopCommand& out) {
    using scene::PinSchedule;
    const Eigen::Index n = state.height_m.size();
    const auto locked = plan.options.display->schedule == PinSchedule::locked;
    mechanics::PinReport report;
    out.pins = static_cast<std::int32_t>(n);
    if (locked)
        state.height_m.setConstant(plan.pins->grid.stroke_m);
    else
        heights_of(plan, now, state.now, state, report);
    std::copy_n(state.height_m.data(), n, out.wanted_m.begin());
    out.shape_scale = report.scale;
    out.clipped = report.clipped;
    if (plan.options.display->schedule == PinSchedule::lead && in.feedback.stopped < 0.5) {
        const MotionSample soon = ahead(state.motion, kLead_s);
        heights_of(plan, press_at(plan, soon, in.feedback.by_table > 0.5, state.later), state.later, state, report);
    }
    round_heights(plan, out.time_s, state);
    std::copy_n(state.commanded_m.data(), n, out.pins_m.begin());
    const auto count = static_cast<std::size_t>(n);
    estimate_pins(plan.pin_dynamics, plan.pin_rest_m, out.time_s, {out.pins_m.data(), count}, state.estimate);
    std::copy_n(state.estimate.height_m.begin(), count, out.reached_m.begin());
}

devices::ArmCommand arm_command(const TactilePlan& plan, const LoopInput& in, const LoopCommand& out,
                                FrictionDirection& direction) {
    devices::ArmCommand arm;
    if (in.feedback.stopped > 0.5) return arm;
    if (plan.options.arm->impedance == scene::ArmImpedance::high) {
        arm.mode = static_cast<double>(devices::ArmMode::position);
        arm.depth_m = out.depth_m;
        return arm;
    }
    arm.mode = static_cast<double>(devices::ArmMode::force);
    arm.force_N = out.force_N;
    if (plan.compensation)
        arm.feedforward_N =
            compensation_N(*plan.compensation, in.feedback.arm.depth_m, in.feedback.arm.velocity_m_per_s, direction);
    return arm;
}

}  // namespace

LoopState make_loop_state(const TactilePlan& plan) {
    LoopState state;
    state.now = make_work(plan.renderer);
    state.later = make_work(plan.renderer);
    if (!plan.pins) return state;
    const Eigen::Index n = plan.pins->pin_m.cols();
    state.sink_m.setZero(n);
    state.height_m.setZero(n);
    state.carried_m.setZero(n);
    state.commanded_m.setConstant(n, plan.pin_rest_m);
    return state;
}

LoopCommand loop_command(const TactilePlan& plan, const LoopInput& in, LoopState& state) noexcept {
    LoopCommand out;
    MotionSample at = sample_of(plan, in);
    const bool stopped = in.feedback.stopped > 0.5;
    if (stopped) at.value = 0.0;
    remember(at, state.motion);
    const Press now = press_at(plan, at, in.feedback.by_table > 0.5, state.now);
    out.time_s = in.time_s;
    out.x_m = at.x_m;
    out.y_m = at.y_m;
    out.pressed = at.value > 0.0;
    out.depth_m = now.depth_m;
    out.force_N = now.force_N;
    out.linearity = now.linearity;
    out.held = now.capped;
    out.over_edge = now.over_edge;
    out.inexact = now.inexact;
    if (plan.pins) move_pins(plan, in, now, state, out);
    if (plan.options.arm) out.arm = arm_command(plan, in, out, state.direction);
    return out;
}

}  // namespace palpa::tactile
