#include "app/commands/tactile_rig.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <optional>
#include <unistd.h>

#include "app/assets.h"
#include "files/input_error.h"
#include "files/temporary_folder.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;
using devices::simulators::SimulatorProcess;

// A person follows this line; the simulated hand needs it not, but its owner sees how far it is.
std::function<void(double)> guide(const std::vector<devices::PressRow>& path, const std::string& what, bool person) {
    if (::isatty(STDERR_FILENO) == 0) return {};
    const double seconds = path.back().t_s;
    return [path, what, person, seconds, at = std::size_t{0}](double done_s) mutable {
        const double wanted_mm = 1e3 * devices::press_at(path, done_s, at).depth_m;
        if (person)
            std::fprintf(stderr, "\r\033[K%s: go to %6.1f mm   %.0f s left", what.c_str(), wanted_mm, seconds - done_s);
        else
            std::fprintf(stderr, "\r\033[K%s: %.0f s of %.0f", what.c_str(), done_s, seconds);
        std::fflush(stderr);
    };
}

void take_link(const tactile::ArmRig& rig, RigResult& result) {
    const devices::LinkHealth* link = rig.link();
    if (link == nullptr) return;
    result.round_trip_p50_s = link->round_trip.quantile_s(0.5);
    result.round_trip_p99_s = link->round_trip.quantile_s(0.99);
    result.lost = link->feedback.lost;
}

}  // namespace

void add_rig_options(CLI::App& command, RigOptions& options) {
    command.add_option("--device", options.device,
                       "device file of the arm (default: that of the scene, if one is given)");
    command.add_flag("--simulate", options.simulate, "start a simulated arm with hand and force sensor");
    command.add_flag("--virtual-time", options.virtual_time,
                     "with --simulate: in this process, without waiting, and so the same at every run");
    command
        .add_option("--seed", options.seed, "of the simulated arm's parameters; 0: as they stand in the documentation")
        ->capture_default_str();
}

devices::ArmDevice rig_device(const RigOptions& options, const fs::path& scene_device) {
    if (options.virtual_time && !options.simulate)
        throw files::bad_input("--virtual-time", "", "no --simulate", "both: a real arm keeps real time");
    if (!options.device.empty()) return devices::read_arm_device(options.device);
    if (!scene_device.empty()) return devices::read_arm_device(scene_device);
    if (!options.simulate)
        throw files::bad_input("--device", "", "nothing", "the device file of an arm, or --simulate");
    return devices::read_arm_device(assets_folder() / "devices/arm.json");
}

RigResult stroke_along(const RigOptions& options, const devices::ArmDevice& device,
                       const std::vector<devices::PressRow>& path, tactile::StrokeOptions stroke,
                       const std::string& what) {
    stroke.seconds = path.back().t_s + 0.2;
    stroke.progress = guide(path, what, !options.simulate);
    std::optional<files::TemporaryFolder> folder;  // where the simulator reads its hand's path
    std::unique_ptr<SimulatorProcess> simulator;
    std::unique_ptr<tactile::ArmRig> rig;
    if (options.virtual_time) {
        using namespace devices::simulators;
        rig = tactile::virtual_rig(make_arm_plant(arm_parameters(options.seed), path, options.seed));
    } else if (options.simulate) {
        const fs::path press = folder.emplace() / "press.tsv";
        devices::write_press(path, press);
        simulator = std::make_unique<SimulatorProcess>(
            devices::simulators::simulator_program("arm_simulator"),
            std::vector<std::string>{"--press", press.string(), "--seed", std::to_string(options.seed)});
        devices::ArmDevice local = device;
        local.host = "127.0.0.1";
        local.port = std::stoi(simulator->port());
        local.sensor = devices::NetFtOptions{};
        local.sensor->host = "127.0.0.1";
        local.sensor->port = std::stoi(simulator->line().substr(std::string("sensor ").size()));
        rig = tactile::open_rig(local);
    } else {
        if (!device.sensor)
            throw std::runtime_error(device.name +
                                     ": has no force sensor; without one nobody knows what the hand does");
        stroke.arm = device.name + " at " + device.host + ":" + std::to_string(device.port);
        rig = tactile::open_rig(device);
    }
    RigResult result;
    result.strokes = tactile::run_strokes(stroke, *rig);
    if (::isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "\r\033[K");
    result.ticks = result.strokes.rows.size();
    result.loop_delay_s = result.strokes.delay_s;
    take_link(*rig, result);
    return result;
}

files::Json link_json(const RigResult& result) {
    return {{"round_trip_ms",
             {{"p50", files::number_or_null(1e3 * result.round_trip_p50_s)},
              {"p99", files::number_or_null(1e3 * result.round_trip_p99_s)}}},
            {"lost", result.lost},
            {"late_ticks", result.strokes.late_ticks},
            {"ticks", result.ticks}};
}

}  // namespace palpa::app
