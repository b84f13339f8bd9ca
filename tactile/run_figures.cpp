#include "tactile/run_figures.h"

#include <algorithm>

#include "mechanics/linear_range.h"

namespace palpa::tactile {
namespace {

files::Json faults_json(const devices::Guard& guard) {
    files::Json out = files::Json::array();
    for (std::size_t i = 1; i < devices::kFaults; ++i) {
        if (guard.count[i] == 0) continue;
        out.push_back(
            {{"fault", std::string(devices::text(static_cast<devices::Fault>(i)))}, {"times", guard.count[i]}});
    }
    return out;
}

const char* range_text(double linearity) {
    switch (mechanics::linear_range(linearity)) {
        case mechanics::LinearRange::fine:
            return "fine";
        case mechanics::LinearRange::amber:
            return "amber";
        case mechanics::LinearRange::red:
            return "red";
    }
    return "";
}

files::Json warnings_json(const TactilePlan& plan, const DeviceFigures& devices) {
    files::Json out = files::Json::array();
    if (plan.arm) {
        const std::string delay =
            devices::delay_warning(plan.greatest_stiffness_N_per_m, kStep_s + devices.round_trip_p50_s);
        if (!delay.empty()) out.push_back(delay);
        if (devices.arm_rested > 0)
            out.push_back("the arm said " + std::to_string(devices.arm_rested) +
                          " times that it was at rest since no command came: it rendered nothing then");
    }
    return out;
}

}  // namespace

void add(const LoopCommand& step, bool rendered, StepFigures& figures) {
    ++figures.steps;
    figures.relaxed_steps += !rendered;
    if (!rendered) return;
    figures.held_steps += step.held;
    figures.inexact_steps += step.inexact;
    figures.over_edge_steps += step.over_edge;
    figures.max_force_N = std::max(figures.max_force_N, step.force_N);
    figures.max_depth_m = std::max(figures.max_depth_m, step.depth_m);
    figures.linearity = std::max(figures.linearity, step.linearity);
    figures.least_scale = std::min(figures.least_scale, step.shape_scale);
    if (!step.pressed) return;
    ++figures.pressed_steps;
    if (step.pins > 0) figures.clipped_share += static_cast<double>(step.clipped) / step.pins;
}

void take_link(const devices::LinkHealth& link, DeviceFigures& figures) {
    figures.round_trip_p50_s = link.round_trip.quantile_s(0.5);
    figures.round_trip_p99_s = link.round_trip.quantile_s(0.99);
    figures.lost = link.feedback.lost;
    figures.arm_rested = link.arm_rested;
}

files::Json figures_json(const TactilePlan& plan, const StepFigures& steps, const MismatchMeter& mismatch,
                         const DeviceFigures& devices) {
    const auto pressed = static_cast<double>(std::max<std::int64_t>(steps.pressed_steps, 1));
    files::Json json;
    json["pairing"] = pairing_text(plan.options);
    json["leads"] = plan.options.leads == scene::Leads::arm ? "arm" : "touch";
    json["schedule"] = plan.pins ? files::Json(name_of(plan.options.display->schedule)) : files::Json(nullptr);
    json["fidelity"] = table_of(plan) != nullptr ? "table" : "live";
    json["steps"] = steps.steps;
    json["late_steps"] = devices.late_steps;
    json["held_steps"] = steps.held_steps;
    json["relaxed_steps"] = steps.relaxed_steps;
    json["max_force_N"] = steps.max_force_N;
    json["max_depth_mm"] = 1e3 * steps.max_depth_m;
    json["reached_by"] = plan.pins ? devices.reached_by : "nothing";
    json["mismatch_mm"] = {{"rms", files::number_or_null(1e3 * rms_m(mismatch))},
                           {"max", mismatch.steps > 0 ? files::Json(1e3 * mismatch.max_m) : files::Json(nullptr)}};
    json["mismatch_ms"] = files::number_or_null(1e3 * lag_s(mismatch));
    json["clipped_share"] = plan.pins ? files::Json(steps.clipped_share / pressed) : files::Json(nullptr);
    json["least_shape_scale"] = steps.least_scale;
    const bool is_linear = plan.renderer.compliance != nullptr;  // other tissues have no such range to leave
    json["linear_range"] = is_linear ? files::Json(range_text(steps.linearity)) : files::Json(nullptr);
    json["linearity"] = is_linear ? files::Json(steps.linearity) : files::Json(nullptr);
    json["over_edge_steps"] = steps.over_edge_steps;
    json["inexact_steps"] = steps.inexact_steps;
    json["step_us"] = {{"p50", files::number_or_null(devices.step_p50_us)},
                       {"p99", files::number_or_null(devices.step_p99_us)}};
    json["real_time"] = devices.real_time;
    json["link"] = {{"round_trip_ms",
                     {{"p50", files::number_or_null(1e3 * devices.round_trip_p50_s)},
                      {"p99", files::number_or_null(1e3 * devices.round_trip_p99_s)}}},
                    {"lost", devices.lost}};
    json["limited_commands"] = devices.guard.limited;
    json["faults"] = faults_json(devices.guard);
    json["warnings"] = warnings_json(plan, devices);
    json["notes"] = plan.notes;
    return json;
}

}  // namespace palpa::tactile
