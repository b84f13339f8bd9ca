// palpa tangible run: a soft device pushes back as a scene's tissue would.

#include "session/tangible_run.h"

#include <CLI/CLI.hpp>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <utility>
#include <vector>

#include "app/assets.h"
#include "app/commands/command_line.h"
#include "app/commands/interrupt.h"
#include "app/commands/option_checks.h"
#include "app/commands/press_rows.h"
#include "app/commands/tangible_loop.h"
#include "app/scene_choices.h"
#include "devices/press_file.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/table.h"
#include "files/text.h"
#include "scene/find_file.h"
#include "session/device_rows.h"
#include "session/plan_in_progress.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

constexpr files::Bounds kRates_Hz{10.0, 2000.0};

struct TangibleRunArguments {
    std::string scene;
    std::string plant;
    std::vector<std::string> ports;
    std::string press;
    std::string replay;
    std::string log;
    std::string fidelity;  // empty: the scene's
    std::string command;
    double rate_Hz = 0.0;  // 0: 100, or that of the run that is replayed
    double seconds = 0.0;
    std::optional<std::uint64_t> seed;  // of a plant; nothing: 1
    bool headless = false;
    bool json = false;
};

tangible::LoopOptions loop_options_of(const TangibleRunArguments& arguments, const scene::TangibleOptions& scene) {
    tangible::LoopOptions options = tangible::loop_options(scene);
    if (arguments.rate_Hz > 0.0) options.rate_Hz = arguments.rate_Hz;
    if (!arguments.fidelity.empty()) options.inverse.fidelity = tangible::fidelity_named(arguments.fidelity);
    if (!arguments.command.empty()) options.command = tangible::command_named(arguments.command);
    return options;
}

// Recorded rows hold all that the loop took in: there is neither a plant nor a finger.
void check_replay(const TangibleRunArguments& arguments) {
    if (arguments.replay.empty()) return;
    for (const auto& [option, given] :
         {std::pair{"--plant", !arguments.plant.empty()}, std::pair{"--port", !arguments.ports.empty()},
          std::pair{"--press", !arguments.press.empty()}, std::pair{"--seconds", arguments.seconds > 0.0},
          std::pair{"--seed", arguments.seed.has_value()}, std::pair{"--headless", arguments.headless}}) {
        if (given)
            throw files::InputError(std::string(option) +
                                    ": found beside --replay, expected one of the two: recorded rows are run as they "
                                    "are");
    }
}

// The rows are only the input. What the run was told beside them, and that gives the same commands, stands in the report
// beside the rows; a run that was killed has none.
void take_recorded_options(TangibleRunArguments& arguments) {
    if (arguments.replay.empty()) return;
    const fs::path report = fs::path(arguments.replay).parent_path() / "performance.json";
    std::error_code error;
    if (!fs::exists(report, error)) return;
    const files::Json root = files::read_json(report);
    files::JsonReader json(root, report.string());
    if (!json.has("fidelity")) return;  // of another kind of run
    const std::string fidelity(
        tangible::kFidelityNames.at(json.choice("fidelity", {"step", "converged", "stale", "linear"})));
    const double rate_Hz = json.number("rate_Hz", kRates_Hz, tangible::LoopOptions{}.rate_Hz);
    if (arguments.fidelity.empty()) arguments.fidelity = fidelity;
    if (arguments.rate_Hz == 0.0) arguments.rate_Hz = rate_Hz;
    if (arguments.fidelity != fidelity || arguments.rate_Hz != rate_Hz)
        std::fprintf(stderr, "palpa: warning: the run had --fidelity %s --rate-Hz %s; the commands are others\n",
                     fidelity.c_str(), files::short_number(rate_Hz).c_str());
}

std::string plant_of(const TangibleRunArguments& arguments, const scene::Scene& scene) {
    if (!arguments.replay.empty()) return "";
    if (!arguments.ports.empty() && !arguments.plant.empty())
        throw files::InputError("--port: found beside --plant " + arguments.plant + ", expected one of the two");
    // ports on the command line count more than the scene's plant
    const std::string of_scene = arguments.ports.empty() ? scene.tangible->plant : "";
    const std::string plant = arguments.plant.empty() ? of_scene : arguments.plant;
    if (plant.empty() && arguments.headless)
        throw files::InputError(
            "--headless: found without a plant, expected --plant exact or a file: real devices need real time");
    if (plant.empty() && arguments.seed)
        throw files::InputError(
            "--seed: found without a plant, expected --plant exact or a file: it is of the plant's noise");
    if (plant.empty() && !arguments.press.empty())
        throw files::InputError(
            "--press: found without a plant, expected --plant exact or a file: on a real device a finger presses");
    return plant;
}

// The finger on a plant: a press, or the built-in motion to three quarters of the depth that the tissue is known for.
session::Finger finger_of(const TangibleRunArguments& arguments, std::vector<devices::PressRow> press,
                          const tangible::TangiblePlan& plan) {
    session::Finger finger;
    finger.seconds = arguments.seconds;
    finger.press = std::move(press);
    finger.motion.depth_m = std::min(finger.motion.depth_m, 0.75 * plan.greatest_m);
    return finger;
}

session::TangibleResult run_as_asked(const TangibleRunArguments& arguments, const std::string& plant_name,
                                     std::vector<devices::PressRow> press,
                                     const std::shared_ptr<const tangible::TangiblePlan>& plan) {
    session::TangibleRunOptions run;
    run.log = arguments.log;
    run.seed = arguments.seed.value_or(1);
    if (!arguments.replay.empty()) {
        const auto rows =
            session::read_device_rows(arguments.replay, session::field_names<tangible::TangibleFeedback>());
        if (!arguments.log.empty()) fs::create_directories(arguments.log);
        return session::replay_tangible_rows(plan, rows, run);
    }
    run.finger = finger_of(arguments, std::move(press), *plan);
    std::optional<tangible::Plant> plant;
    if (!plant_name.empty()) plant = make_plant(plan->model, tangible::read_plant(plant_name), plan->loop);
    if (!arguments.log.empty()) fs::create_directories(arguments.log);
    const Interrupt interrupt;
    run.ends = [&] { return interrupt.came(); };
    if (arguments.headless) return session::run_tangible_virtual(plan, *plant, run);
    return session::run_tangible_live(plan, plant, arguments.ports, run);
}

void print_run(const files::Json& result) {
    std::printf("%s on %s: %s ticks", result["scene"].get<std::string>().c_str(),
                result["device"].get<std::string>().c_str(), result["ticks"].dump().c_str());
    if (!result["missed_ticks"].is_null()) std::printf(", %s missed", result["missed_ticks"].dump().c_str());
    std::printf("\n");
    if (!result["force_rms_percent"].is_null())
        std::printf("  rendered force off the wanted one by %.3g %% (rms, of the greatest wanted force)\n",
                    result["force_rms_percent"].get<double>());
    std::printf(
        "  saturated in %.3g %% of the ticks, as fast as the drives go in %.3g %%, last command held for %.3g ms, "
        "relaxed for %.3g ms\n",
        100.0 * result["saturated_share"].get<double>(), 100.0 * result["rate_limited_share"].get<double>(),
        result["held_ms"].get<double>(), result["relaxed_ms"].get<double>());
    for (const auto& fault : result["faults"])
        std::printf("  fault: %s, %s times\n", fault["fault"].get<std::string>().c_str(),
                    fault["times"].dump().c_str());
    for (const auto& note : result["notes"]) std::printf("  note: %s\n", note.get<std::string>().c_str());
}

// The parts of the device, each with the port that it was really opened at.
files::Json devices_json(const tangible::TangiblePlan& plan, bool real, const std::vector<std::string>& ports) {
    files::Json devices = files::Json::array();
    for (const session::TactileDevice& device : session::devices_of(plan, !real)) {
        std::string port = device.port;
        for (const std::string& given : ports) {
            if (given.rfind(device.role + "=", 0) == 0) port = given.substr(device.role.size() + 1);
        }
        devices.push_back(
            {{"role", device.role}, {"name", device.name}, {"port", port}, {"simulated", device.simulated}});
    }
    return devices;
}

// Nobody can stop this run but the guard: the fault "stopped" is the guard's doing, and is named once, by its cause.
void name_guard(const std::string& why, files::Json& json) {
    files::Json faults = files::Json::array();
    for (const files::Json& fault : json["faults"]) {
        if (fault["fault"] != text_of(tangible::TickFault::stopped)) faults.push_back(fault);
    }
    faults.push_back({{"fault", "the guard: " + why}, {"times", 1}});
    json["faults"] = faults;
    std::fprintf(stderr, "palpa: warning: the guard relaxed the device (%s); nothing was rendered after that\n",
                 why.c_str());
}

// What a careful range or rate of `wires` takes away from a drive is in no other figure, nor in ticks.tsv.
void name_limits(const session::GuardFigures& guard, files::Json& json) {
    json["guard"] = {{"commands", guard.commands},
                     {"limited_values", guard.limited},
                     {"slewed_values", guard.slewed},
                     {"scaled_commands", guard.scaled}};
    constexpr std::int64_t kFew = 20;  // the first commands rise from rest as fast as they may
    if (guard.limited == 0 && guard.scaled == 0 && guard.slewed * kFew <= guard.commands) return;
    const std::string note =
        "the drives got less than ticks.tsv says: of " + std::to_string(guard.commands) + " commands the guard held " +
        std::to_string(guard.limited) + " values in the ranges of `wires`, slowed " + std::to_string(guard.slewed) +
        " down to the rates, and scaled " + std::to_string(guard.scaled) + " commands down to the total force";
    json["notes"].push_back(note);
    std::fprintf(stderr, "palpa: warning: %s\n", note.c_str());
}

// Ticks that come too late make a coarser loop, whose force lags behind the finger.
void note_missed(const tangible::LoopOptions& loop, files::Json& json) {
    constexpr std::int64_t kFew = 50;  // a busy machine now and then misses one
    const auto ticks = json["ticks"].get<std::int64_t>();
    const auto missed = json["missed_ticks"].get<std::int64_t>();
    if (missed * kFew <= ticks + missed) return;
    const std::string less = loop.inverse.fidelity == tangible::Fidelity::linear  ? ""
                             : loop.inverse.fidelity == tangible::Fidelity::stale ? "--fidelity linear or "
                                                                                  : "--fidelity stale or linear, or ";
    const std::string note = std::to_string(missed) + " of " + std::to_string(ticks + missed) +
                             " ticks were missed: a tick takes " +
                             files::short_number(1e-3 * json["tick_us"]["p50"].get<double>()) +
                             " ms here (median of all, with those at rest; " +
                             files::short_number(1e-3 * json["tick_us"]["p99"].get<double>()) +
                             " ms in one of a hundred), and the period is " + files::short_number(1e3 / loop.rate_Hz) +
                             " ms; " + less + "a lower --rate-Hz takes less";
    json["notes"].push_back(note);
    std::fprintf(stderr, "palpa: warning: %s\n", note.c_str());
}

void note_beyond(double deepest_m, const tangible::TangiblePlan& plan, files::Json& json) {
    if (deepest_m <= plan.greatest_m) return;
    const std::string note = "the press goes " + files::short_number(1e3 * deepest_m) +
                             " mm deep, and the tissue is known for " + files::short_number(1e3 * plan.greatest_m) +
                             " mm: further down the wanted force stays what it is there";
    json["notes"].push_back(note);
    std::fprintf(stderr, "palpa: warning: %s\n", note.c_str());
}

// A device whose place is not fixed renders what the tissue answers under the press.
void note_beside(const std::string& file, const std::string& beside, files::Json& json) {
    if (beside.empty()) return;
    json["notes"].push_back(beside);
    std::fprintf(stderr, "palpa: warning: %s: %s\n", file.c_str(), beside.c_str());
}

void note_less_depth(const session::Finger& finger, files::Json& json) {
    const double usual_m = tangible::PressMotion{}.depth_m;
    if (finger.motion.depth_m >= usual_m) return;
    json["notes"].push_back("the built-in motion presses " + files::short_number(1e3 * finger.motion.depth_m) +
                            " mm and not " + files::short_number(1e3 * usual_m) +
                            " mm: three quarters of the depth that the tissue is known for");
}

// A motion that leads the finger by its depth moves the hand too.
void note_idle_hand(const std::string& plant_name, bool by_force, files::Json& json) {
    if (plant_name.empty() || by_force || !(tangible::read_plant(plant_name).hand.mass_kg > 0.0)) return;
    json["notes"].push_back(
        "the hand of " + plant_name +
        " has no effect: the finger follows a motion here; --press with force_N lets the hand push");
}

void run_tangible(TangibleRunArguments arguments) {
    const scene::Scene scene = load_scene(arguments.scene);
    if (!scene.tangible) throw files::bad_input(arguments.scene, "tangible", "no such key", "one that names a device");
    if (!arguments.log.empty()) {
        files::check_output_folder(arguments.log);
        for (const char* file : {"ticks.tsv", "performance.json"}) files::check_new(fs::path(arguments.log) / file);
    }
    check_replay(arguments);
    take_recorded_options(arguments);
    const std::string plant_name = plant_of(arguments, scene);
    const bool real = plant_name.empty() && arguments.replay.empty();
    std::vector<devices::PressRow> press;  // read before the tissue is prepared, which takes seconds
    if (!arguments.press.empty()) press = devices::read_press(arguments.press);
    const scene::Plan scene_plan = session::make_plan_here(scene);
    auto made = tangible::make_tangible_plan(scene, scene_plan, loop_options_of(arguments, *scene.tangible));
    if (real) tangible::command_as_wired(!arguments.command.empty(), made);
    const auto plan = std::make_shared<const tangible::TangiblePlan>(std::move(made));
    double deepest_m = 0.0;
    for (const devices::PressRow& row : press) {
        check_depth(arguments.press, "depth_mm", row.depth_m, *plan->model);
        if (row.depth_m > deepest_m) deepest_m = row.depth_m;  // NaN: a press by force
    }
    // a tissue that is one curve is the same everywhere
    const bool has_places = plan->place_follows && !scene::is_curve(scene.tissue);
    const std::string beside = has_places ? rows_beside(press, scene_plan.area) : "";
    const bool by_force = !press.empty() && std::isfinite(press.front().force_N);
    const session::TangibleResult result = run_as_asked(arguments, plant_name, std::move(press), plan);
    files::Json json{{"scene", scene.name}, {"seed", nullptr}, {"plant", nullptr}};
    if (!plant_name.empty()) {
        json["seed"] = arguments.seed.value_or(1);
        json["plant"] = plant_name;
    }
    json.update(tangible::figures_json(*plan, result.ticks, result.clock));
    if (!plant_name.empty() && arguments.press.empty()) note_less_depth(finger_of(arguments, {}, *plan), json);
    json["devices"] = files::Json::array();
    if (arguments.replay.empty()) {
        json["devices"] = devices_json(*plan, real, arguments.ports);
        note_missed(plan->loop, json);
    } else {  // no device takes part; rows know neither what the drives were told nor which ticks were missed
        json["replay"] = arguments.replay;
        json["command"] = nullptr;
        json["missed_ticks"] = nullptr;
    }
    if (real) name_limits(result.guarded, json);
    note_beyond(deepest_m, *plan, json);
    note_beside(arguments.press, beside, json);
    note_idle_hand(plant_name, by_force, json);
    if (result.guard != devices::Fault::none) name_guard(std::string(text(result.guard)), json);
    if (result.cut) {
        std::fprintf(stderr, "palpa: warning: %s\n", kCut);
        json["notes"].push_back(kCut);
    }
    if (!result.logged) throw std::runtime_error(arguments.log + ": the log could not be written to its end");
    if (!arguments.log.empty())
        files::write_text_atomically(fs::path(arguments.log) / "performance.json", files::json_text(json));
    if (arguments.json)
        std::fputs(files::json_text(json).c_str(), stdout);
    else
        print_run(json);
}

}  // namespace

files::Json fit_json(const tangible::DeviceFit& fit) {
    return {{"modulus_factor", fit.modulus_factor},
            {"friction_share", fit.friction_share},
            {"zero_mm", 1e3 * fit.zero_m},
            {"lag_ms", 1e3 * fit.lag_s}};
}

fs::path device_file(const std::string& name) {
    const bool bare = !name.empty() && !fs::path(name).has_parent_path() && !fs::path(name).has_extension();
    return scene::find_file(bare && !fs::exists(name) ? name + ".json" : name, fs::current_path() / "device",
                            assets_folder() / "devices");
}

void check_depth(const std::string& where, const std::string& key, double depth_m, const tangible::DeviceModel& model) {
    if (depth_m > model.size_m)
        throw files::bad_input(where, key, files::short_number(1e3 * depth_m),
                               "at most the device's size, " + files::short_number(1e3 * model.size_m));
}

void add_loop_options(CLI::App& command, bool of_scene, std::string& fidelity, std::string& kind, double& rate_Hz) {
    const std::string scenes = of_scene ? "default: the scene's, or " : "default: ";
    command.add_option("--fidelity", fidelity, "of the inverse problem (" + scenes + "step, one Newton step per tick)")
        ->check(one_of({"step", "converged", "stale", "linear"}));
    command
        .add_option("--command", kind, "what the drives are told: forces, or the cables' lengths (" + scenes + "force)")
        ->check(one_of({"force", "position"}));
    command.add_option("--rate-Hz", rate_Hz, "ticks of the loop (default 100)")
        ->check(CLI::Range(kRates_Hz.lowest, kRates_Hz.highest));
}

void add_tangible_run(CLI::App& tangible) {
    auto arguments = std::make_shared<TangibleRunArguments>();
    CLI::App* command = tangible.add_subcommand("run", "Let a scene's soft device push back as its tissue would");
    command->add_option("SCENE", arguments->scene, "scene JSON with the key tangible, or the name of a shipped one")
        ->required();
    command->add_option("--plant", arguments->plant,
                        "a model in the place of the device: exact, or a plant file (default: the scene's)");
    command->add_option("--port", arguments->ports, "NAME=PATH of a port, instead of the device file's");
    command->add_option("--press", arguments->press,
                        "PRESS.tsv (t_s, x_mm, y_mm, depth_mm, at most the device's size, or force_N) of the finger on "
                        "a plant (default: there and back, 6 mm at 5 mm/s, or 3/4 of the depth that the tissue is "
                        "known for where that is less)");
    command->add_option("--replay", arguments->replay,
                        "PRESS.tangible.tsv of an earlier --log: what the loop took in then, run again without a "
                        "device; the same commands");
    command
        ->add_option("--seconds", arguments->seconds, "how long (default: the press once; a real device until stopped)")
        ->check(CLI::Range(0.01, 1e6));
    command->add_flag("--headless", arguments->headless,
                      "on a plant: virtual time, as fast as it goes, the same log every time");
    command->add_option("--log", arguments->log, "folder for the log (existing files are never overwritten)");
    command->add_option("--seed", arguments->seed, "of the plant's noise (default 1)");
    add_loop_options(*command, true, arguments->fidelity, arguments->command, arguments->rate_Hz);
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([arguments] { run_tangible(*arguments); });
}

}  // namespace palpa::app
