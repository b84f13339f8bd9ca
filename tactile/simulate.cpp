#include "tactile/simulate.h"

#include <stdexcept>

#include "files/table.h"

namespace palpa::tactile {
namespace {

using devices::simulators::simulator_program;
using devices::simulators::SimulatorProcess;

int number_after(const std::string& line, const std::string& word) {
    if (line.rfind(word + " ", 0) != 0) throw std::runtime_error("the simulator said: " + line);
    return std::stoi(line.substr(word.size() + 1));
}

void start_arm(const std::filesystem::path& press, std::uint64_t seed, devices::ArmDevice& arm, Simulators& out) {
    std::vector<std::string> arguments{"--seed", std::to_string(seed)};
    if (!press.empty()) arguments.insert(arguments.end(), {"--press", press.string()});
    if (arm.sensor) arguments.insert(arguments.end(), {"--counts-per-N", std::to_string(arm.sensor->counts_per_N)});
    out.arm = std::make_unique<SimulatorProcess>(simulator_program("arm_simulator"), arguments);
    arm.host = "127.0.0.1";
    arm.port = number_after("port " + out.arm->port(), "port");
    const int sensor = number_after(out.arm->line(), "sensor");
    if (!arm.sensor) return;
    arm.sensor->host = arm.host;
    arm.sensor->port = sensor;
}

void start_pins(const std::filesystem::path& device, std::uint64_t seed, devices::PinDevice& pins, Simulators& out) {
    out.heights = out.folder.emplace() / "heights.tsv";
    out.pins = std::make_unique<SimulatorProcess>(
        simulator_program("maestro_simulator"),
        std::vector<std::string>{device.string(), "--seed", std::to_string(seed), "--heights", out.heights.string()});
    pins.port = out.pins->port();
}

}  // namespace

std::unique_ptr<Simulators> start_simulators(const std::filesystem::path& press, std::uint64_t seed,
                                             TactilePlan& plan) {
    auto out = std::make_unique<Simulators>();
    if (plan.arm) start_arm(press, seed, *plan.arm, *out);
    if (plan.pin_device) start_pins(plan.options.display->device, seed, *plan.pin_device, *out);
    return out;
}

std::vector<TrueHeights> read_heights(const std::filesystem::path& file) {
    files::Table table = files::read_tsv(file);
    std::vector<TrueHeights> out;
    while (table.next()) {
        TrueHeights row;
        row.host_s = table.finite_number(0);
        for (std::size_t i = 1; i < table.columns().size(); ++i) row.height_m.push_back(1e-3 * table.finite_number(i));
        out.push_back(std::move(row));
    }
    return out;
}

}  // namespace palpa::tactile
