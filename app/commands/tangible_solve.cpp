// palpa tangible solve: the inverse problem at one depth and force, term by term.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>
#include <stdexcept>

#include "app/commands/command_line.h"
#include "app/commands/option_checks.h"
#include "app/commands/tangible_loop.h"
#include "files/clock.h"
#include "files/input_error.h"
#include "files/printable.h"
#include "files/progress_line.h"
#include "files/text.h"
#include "tangible/inverse.h"

namespace palpa::app {
namespace {

struct TangibleSolveOptions {
    std::string device;
    double depth_mm = 0.0;
    double force_N = 0.0;
    std::string fidelity = "converged";
    bool json = false;
};

struct SolvedPress {
    tangible::InverseAnswer answer;
    int iterations = 0;
    double time_us = 0.0;
    bool given_up = false;  // no equilibrium in several ticks, one after the other
};

// Presses in 60 ticks from the pretension to the wanted depth and force, as a loop would come there, and then holds
// them until nothing changes.
SolvedPress solve_press(const tangible::DeviceModel& model, const TangibleSolveOptions& options) {
    const double depth_m = 1e-3 * options.depth_mm;
    tangible::InverseOptions inverse;
    inverse.fidelity = tangible::fidelity_named(options.fidelity);
    inverse.slew = false;
    tangible::DeviceState state = tangible::rest_state(model);
    const double floor_m = model.device.depth_floor_m;
    prepare_press(model, state, depth_m > 0.0 ? options.force_N * floor_m / depth_m : 0.0);
    SolvedPress out;
    constexpr int kTicks = 60;
    constexpr int kMostTicks = 400;
    constexpr int kPatience = 20;  // ticks without an equilibrium
    int vain = 0;
    files::ProgressLine line;
    for (int tick = 1; tick <= kMostTicks && !out.given_up; ++tick) {
        line.show("pressing on " + model.device.name, static_cast<double>(tick) / kMostTicks);
        const double share = std::min(1.0, static_cast<double>(tick) / kTicks);
        // what opposes itself would only creep to its place
        inverse.rate_term = tick <= kTicks || model.device.pretension.has_value();
        const tangible::Actuation before = state.actuation;
        const std::int64_t began_ns = files::steady_ns();
        out.answer = inverse_step(model, state, {share * depth_m, share * options.force_N, {}}, inverse);
        out.time_us = 1e-3 * static_cast<double>(files::steady_ns() - began_ns);
        out.iterations += out.answer.iterations;
        const bool found =
            out.answer.status == tangible::DeviceStatus::good || out.answer.status == tangible::DeviceStatus::unstable;
        vain = found ? 0 : vain + 1;
        out.given_up = vain >= kPatience;
        double change = 0.0;
        for (int j = 0; j < model.n_actuators(); ++j) {
            const auto at = static_cast<std::size_t>(j);
            const tangible::SoftActuator& actuator = model.actuators[at];
            change = std::max(change,
                              std::abs(state.actuation[at] - before[at]) / (actuator.upper - actuator.lower + 1e-300));
        }
        if (tick > kTicks && change < 1e-9 && (out.answer.converged || inverse.fidelity == tangible::Fidelity::linear))
            break;
    }
    return out;
}

bool reachable(const tangible::InverseAnswer& answer) {
    return answer.status == tangible::DeviceStatus::good && answer.limited_by < 0 && std::abs(answer.residual_m) < 1e-5;
}

files::Json solve_json(const tangible::DeviceModel& model, const SolvedPress& solved) {
    const tangible::InverseAnswer& answer = solved.answer;
    files::Json actuation = files::Json::array();
    files::Json active = files::Json::array();
    for (int j = 0; j < model.n_actuators(); ++j) {
        const auto at = static_cast<std::size_t>(j);
        const tangible::SoftActuator& actuator = model.actuators[at];
        const bool cable = actuator.kind == tangible::ActuatorKind::cable;
        actuation.push_back(
            {{"name", actuator.name}, {"value", answer.actuation[at]}, {"unit", unit_of(actuator.kind)}});
        actuation.back()[cable ? "length_mm" : "volume_cm3"] =
            cable ? 1e3 * answer.command[at] : -1e6 * answer.command[at];
        if ((answer.active >> j & 1U) != 0U) active.push_back(actuator.name);
    }
    files::Json limited = nullptr;
    if (answer.limited_by >= 0) limited = model.actuators[static_cast<std::size_t>(answer.limited_by)].name;
    return {{"actuation", actuation},
            {"residual_mm", 1e3 * answer.residual_m},
            {"rank", answer.rank},
            {"active", active},
            {"reachable", reachable(answer)},
            {"limited_by", limited},
            {"iterations", solved.iterations},
            {"converged", answer.converged},
            {"status", name_of(answer.status)},
            {"time_us", solved.time_us}};
}

void print_solve(const tangible::DeviceModel& model, const TangibleSolveOptions& options, const files::Json& json,
                 const SolvedPress& solved) {
    const tangible::InverseAnswer& answer = solved.answer;
    std::printf("%s, finger %s mm deep with %s N: find the a that minimise |W a + d|\n",
                files::printable(model.device.name).c_str(), files::short_number(options.depth_mm).c_str(),
                files::short_number(options.force_N).c_str());
    std::printf("d, the linearised gap of the depth with the actuators at zero: %s mm\n",
                files::short_number(1e3 * answer.gap(0)).c_str());
    for (std::size_t j = 0; j < model.actuators.size(); ++j) {
        const tangible::SoftActuator& actuator = model.actuators[j];
        const auto& row = json["actuation"][j];
        const bool cable = actuator.kind == tangible::ActuatorKind::cable;
        std::printf(
            "  %-8s %-10s a = %s %s, W = %s mm/%s, %s %s\n", name_of(actuator.kind),
            files::printable(actuator.name).c_str(), files::short_number(answer.actuation[j]).c_str(),
            unit_of(actuator.kind), files::short_number(1e3 * answer.W(0, static_cast<Eigen::Index>(j))).c_str(),
            unit_of(actuator.kind), cable ? "length" : "volume",
            (files::short_number(row[cable ? "length_mm" : "volume_cm3"].get<double>()) + (cable ? " mm" : " cm3"))
                .c_str());
    }
    std::printf("what is left, W a + d: %s mm; rank of W: %d\n", files::short_number(1e3 * answer.residual_m).c_str(),
                answer.rank);
    for (std::size_t j = 0; j < model.actuators.size(); ++j) {
        if ((answer.active >> j & 1U) == 0U) continue;
        const tangible::SoftActuator& actuator = model.actuators[j];
        const double near = 0.01 * (actuator.upper - actuator.lower);
        const bool at_limit =
            answer.actuation[j] < actuator.lower + near || answer.actuation[j] > actuator.upper - near;
        std::printf("%s: %s\n", at_limit ? "at its limit" : "held at its pretension, within its limits",
                    files::printable(actuator.name).c_str());
    }
    std::printf("%s, %s%s; %d Newton steps, the last tick took %s us\n", name_of(answer.status),
                reachable(answer) ? "reachable" : "NOT reachable",
                json["limited_by"].is_null()
                    ? ""
                    : (": limited by " + files::printable(json["limited_by"].get<std::string>())).c_str(),
                solved.iterations, files::short_number(solved.time_us).c_str());
}

void run_solve(const TangibleSolveOptions& options) {
    const tangible::DeviceModel model =
        tangible::make_device_model(tangible::read_soft_device(device_file(options.device)));
    check_depth("--depth-mm", "", 1e-3 * options.depth_mm, model);
    const SolvedPress solved = solve_press(model, options);
    const files::Json json = solve_json(model, solved);
    if (options.json)
        std::fputs(files::json_text(json).c_str(), stdout);
    else
        print_solve(model, options, json, solved);
    if (solved.answer.status == tangible::DeviceStatus::no_equilibrium || solved.given_up)
        throw std::runtime_error(
            model.device.name +
            ": no answer was found at this depth and force: the device has no equilibrium there, or "
            "cannot be made so stiff (`palpa tangible characterise` says how stiff)");
}

}  // namespace

void add_tangible_solve(CLI::App& tangible) {
    auto options = std::make_shared<TangibleSolveOptions>();
    CLI::App* solve = tangible.add_subcommand("solve", "Tensions and pressures for one depth and force of the finger");
    solve->add_option("DEVICE", options->device, "device file, or the name of one among the assets")->required();
    solve->add_option("--depth-mm", options->depth_mm, "how deep the finger holds the device")
        ->required()
        ->check(CLI::Range(0.0, 1000.0));
    solve->add_option("--force-N", options->force_N, "what the finger shall feel there")
        ->required()
        ->check(CLI::Range(0.0, 1000.0));
    solve->add_option("--fidelity", options->fidelity, "step, converged (default), stale or linear")
        ->check(one_of({"step", "converged", "stale", "linear"}));
    solve->add_flag("--json", options->json, "one JSON object on standard output");
    solve->callback([options] { run_solve(*options); });
}

}  // namespace palpa::app
