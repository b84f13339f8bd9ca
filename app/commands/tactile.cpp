// palpa tactile: shape display and force arm. `run` presses on a scene's tissue with what its key `tactile` names.

#include <CLI/CLI.hpp>
#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>
#include <optional>
#include <stdexcept>
#include <vector>

#include "app/commands/command_line.h"
#include "app/commands/interrupt.h"
#include "app/commands/option_checks.h"
#include "app/commands/press_rows.h"
#include "app/scene_choices.h"
#include "devices/press_file.h"
#include "files/cache.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/table.h"
#include "files/text.h"
#include "session/plan_in_progress.h"
#include "session/tactile_run.h"
#include "tactile/simulate.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

struct TactileOptions {
    std::string scene;
    std::string replay;
    std::string schedule;
    std::string log;
    std::string arm;                    // HOST:PORT
    std::string pins;                   // path of a serial port
    std::optional<std::uint64_t> seed;  // nothing: 1
    bool headless = false;
    bool simulate = false;
    bool virtual_time = false;
    bool json = false;
};

scene::PinSchedule schedule_of(const std::string& name) {
    for (const auto schedule : {scene::PinSchedule::free, scene::PinSchedule::lead}) {
        if (name == name_of(schedule)) return schedule;
    }
    return scene::PinSchedule::locked;
}

// A table whose first column is `row` holds recorded rows of a loop, any other a press.
bool holds_rows(const fs::path& file) { return files::read_tsv(file).columns().front() == "row"; }

bool is_simulated(const TactileOptions& options) { return options.simulate || options.virtual_time; }

void take_ports(const TactileOptions& options, tactile::TactilePlan& plan) {
    if (!options.pins.empty()) {
        if (!plan.pin_device)
            throw files::InputError("--pins-port: found with a scene whose display has no device, expected one");
        plan.pin_device->port = options.pins;
    }
    if (options.arm.empty()) return;
    if (!plan.arm) throw files::InputError("--arm-port: found with a scene whose arm has no device, expected one");
    const auto colon = options.arm.rfind(':');
    double port = 0.0;
    if (colon == std::string::npos || colon == 0 || !files::parse_number(options.arm.substr(colon + 1), port) ||
        port < 1.0 || port > 65535.0 || port != std::floor(port))
        throw files::InputError("--arm-port: found '" + options.arm + "', expected HOST:PORT");
    plan.arm->host = options.arm.substr(0, colon);
    plan.arm->port = static_cast<int>(port);
}

void check_tactile_run(const TactileOptions& options) {
    if (options.replay.empty())
        throw files::InputError(
            "found no --replay PRESS.tsv, expected a press or recorded rows (the "
            "app's screen of arm and pins, key T, is for presses by hand)");
    if (is_simulated(options) && holds_rows(options.replay))
        throw files::InputError(
            std::string(options.simulate ? "--simulate" : "--virtual-time") +
            ": found beside recorded rows, expected one of the two: rows are run without simulators");
    if (options.seed && !is_simulated(options))
        throw files::InputError("--seed: found without simulators, expected --simulate or --virtual-time, and a press");
    if (options.arm.empty() && options.pins.empty()) return;
    if (options.virtual_time)
        throw files::InputError(
            "--virtual-time: found with a port, expected none: both simulators run in this process");
    if (options.simulate)
        throw files::InputError("--simulate: found with a port, expected none: it starts the simulators itself");
    if (holds_rows(options.replay))
        throw files::InputError(options.replay +
                                ": found recorded rows beside a port, expected one of the two: rows drive no device");
}

// Recorded rows are only the input: the schedule of their run stands in the report beside them. A run that was killed, or
// one of the app, has none; those of the app have the scene's.
void take_recorded_schedule(TactileOptions& options) {
    if (!holds_rows(options.replay)) return;
    const fs::path report = fs::path(options.replay).parent_path() / "performance.json";
    std::error_code error;
    if (!fs::exists(report, error)) return;
    const files::Json root = files::read_json(report);
    files::JsonReader json(root, report.string());
    if (!json.has("schedule") || root.at("schedule").is_null()) return;  // without pins, or of another kind of run
    const scene::PinSchedule recorded =
        static_cast<scene::PinSchedule>(json.choice("schedule", {"free", "lead", "locked"}));
    if (options.schedule.empty()) options.schedule = name_of(recorded);
    if (options.schedule != name_of(recorded))
        std::fprintf(stderr, "palpa: warning: the run had --schedule %s; the pins are told other heights\n",
                     name_of(recorded));
}

// The plan's notes are about the schedule, so it must be known before.
void take_schedule(const TactileOptions& options, scene::Scene& scene) {
    if (options.schedule.empty()) return;
    if (!scene.tactile->display || scene.tactile->display->kind != scene::DisplayKind::shape)
        throw files::InputError("--schedule: found for a scene without a shape display, expected one");
    scene.tactile->display->schedule = schedule_of(options.schedule);
}

session::TactileResult run_as_asked(const TactileOptions& options, const scene::TissueArea& area,
                                    const std::shared_ptr<tactile::TactilePlan>& plan, files::Json& devices) {
    session::TactileRunOptions run;
    run.log = options.log;
    run.seed = options.seed.value_or(1);
    const bool rows = holds_rows(options.replay);
    if (!rows) {
        run.press = devices::read_press(options.replay);
        const std::string beside = rows_beside(run.press, area);
        if (!beside.empty()) std::fprintf(stderr, "palpa: warning: %s: %s\n", options.replay.c_str(), beside.c_str());
    }
    std::vector<session::DeviceRow> recorded;
    if (rows) recorded = session::read_device_rows(options.replay, session::field_names<tactile::LoopFeedback>());
    if (rows)
        session::choose_input(recorded, *plan);
    else
        session::choose_input(run.press, *plan);
    tactile::make_table_now(files::cache_folder(), {}, *plan);
    if (!options.log.empty()) fs::create_directories(options.log);
    std::unique_ptr<tactile::Simulators> simulators;
    if (options.simulate && !options.virtual_time)
        simulators = tactile::start_simulators(options.replay, run.seed, *plan);
    if (rows) return session::replay_rows(plan, recorded, run);  // no device takes part
    for (const session::TactileDevice& device : session::devices_of(*plan, is_simulated(options))) {
        devices.push_back({{"role", device.role},
                           {"name", device.name},
                           {"port", options.virtual_time ? "" : device.port},
                           {"simulated", device.simulated}});
    }
    const Interrupt interrupt;
    run.ends = [&] { return interrupt.came(); };
    if (options.virtual_time) return session::run_virtual(plan, run);
    return session::run_live_press(plan, run, simulators ? simulators->heights : fs::path());
}

void print_tactile(const files::Json& result) {
    std::printf("%s: %s\n", result["scene"].get<std::string>().c_str(), result["pairing"].get<std::string>().c_str());
    std::printf("  %s steps, %s late, %s held at the limit, greatest force %.3g N\n", result["steps"].dump().c_str(),
                result["late_steps"].dump().c_str(), result["held_steps"].dump().c_str(),
                result["max_force_N"].get<double>());
    if (!result["mismatch_mm"]["rms"].is_null())
        std::printf("  pins off the wanted shape by %.3g mm (rms), %.3g mm at most, by %s\n",
                    result["mismatch_mm"]["rms"].get<double>(), result["mismatch_mm"]["max"].get<double>(),
                    result["reached_by"].get<std::string>().c_str());
    if (const auto beyond = result["over_edge_steps"].get<std::int64_t>(); beyond > 0)
        std::printf("  the finger reached over the edge of the tissue in %s\n", files::counted(beyond, "step").c_str());
    if (!result["linear_range"].is_null())
        std::printf("  linear range: %s\n", result["linear_range"].get<std::string>().c_str());
    for (const auto& fault : result["faults"])
        std::printf("  fault: %s, %s times\n", fault["fault"].get<std::string>().c_str(),
                    fault["times"].dump().c_str());
    for (const char* key : {"warnings", "notes"}) {
        for (const auto& text : result[key]) std::printf("  note: %s\n", text.get<std::string>().c_str());
    }
}

void run_tactile(TactileOptions options) {
    check_tactile_run(options);
    take_recorded_schedule(options);
    scene::Scene scene = load_scene(options.scene);
    if (!options.log.empty()) {
        files::check_output_folder(options.log);
        for (const char* file : {"steps.tsv", "performance.json"}) files::check_new(fs::path(options.log) / file);
    }
    if (!scene.tactile)
        throw files::bad_input(options.scene, "tactile", "no such key", "one that says which arm or display there is");
    take_schedule(options, scene);
    const scene::Plan scene_plan = session::make_plan_here(scene);
    const auto plan = std::make_shared<tactile::TactilePlan>(tactile::make_tactile_plan(scene, scene_plan));
    take_ports(options, *plan);
    files::Json devices = files::Json::array();
    const session::TactileResult result = run_as_asked(options, scene_plan.area, plan, devices);
    files::Json json{{"scene", scene.name}, {"seed", nullptr}};
    if (is_simulated(options)) json["seed"] = options.seed.value_or(1);
    json.update(tactile::figures_json(*plan, result.steps, result.mismatch, result.devices));
    json["devices"] = devices;
    if (holds_rows(options.replay)) json["replay"] = options.replay;
    if (result.steps.relaxed_steps > 0) {
        const std::string relaxed = "a fault kept the devices at rest in " +
                                    std::to_string(result.steps.relaxed_steps) + " of " +
                                    std::to_string(result.steps.steps) + " steps; nothing was rendered then";
        std::fprintf(stderr, "palpa: warning: %s\n", relaxed.c_str());
        json["warnings"].push_back(relaxed);
    }
    if (result.cut) {
        std::fprintf(stderr, "palpa: warning: %s\n", kCut);
        json["warnings"].push_back(kCut);
    }
    if (!result.logged) throw std::runtime_error(options.log + ": the log could not be written to its end");
    if (!options.log.empty())
        files::write_text_atomically(fs::path(options.log) / "performance.json", files::json_text(json));
    if (options.json)
        std::fputs(files::json_text(json).c_str(), stdout);
    else
        print_tactile(json);
}

void add_tactile_run(CLI::App& tactile) {
    auto options = std::make_shared<TactileOptions>();
    CLI::App* command = tactile.add_subcommand("run", "Press on a scene's tissue with its arm and pins");
    command->add_option("SCENE", options->scene, "scene JSON with the key tactile, or the name of a shipped one")
        ->required();
    command->add_option("--replay", options->replay,
                        "PRESS.tsv (t_s, x_mm, y_mm, depth_mm or force_N), or the recorded rows of a run");
    command->add_flag("--headless", options->headless, "open no window (as now: this command has none)");
    command->add_flag("--simulate", options->simulate, "start the simulators and drive them instead of devices");
    command->add_flag("--virtual-time", options->virtual_time,
                      "the simulators in this process, without waiting (instead of --simulate)");
    command->add_option("--schedule", options->schedule, "instead of the scene's")
        ->check(one_of({"free", "lead", "locked"}));
    command->add_option("--log", options->log, "folder for the log (existing files are never overwritten)");
    command->add_option("--seed", options->seed, "of the simulators (default 1)");
    command->add_option("--arm-port", options->arm,
                        "HOST:PORT of the arm, instead of its device file's; its force sensor stays that of the file");
    command->add_option("--pins-port", options->pins, "serial port of the pins, instead of their device file's");
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { run_tactile(*options); });
}

}  // namespace

void add_tactile(CLI::App& app) {
    CLI::App* tactile = app.add_subcommand("tactile", "Shape display and force arm on finite element tissue");
    tactile->require_subcommand(1);
    add_tactile_run(*tactile);
    add_tactile_identify(*tactile);
    add_tactile_characterise(*tactile);
    add_tactile_pins(*tactile);
}

}  // namespace palpa::app
