#pragma once
// The simulators as programs of their own, in the place of a plan's devices.

#include <cstdint>
#include <filesystem>
#include <memory>
#include <optional>
#include <vector>

#include "devices/simulators/process.h"
#include "files/temporary_folder.h"
#include "tactile/plan.h"

namespace palpa::tactile {

// They end with this.
struct Simulators {
    std::optional<files::TemporaryFolder> folder;  // before the processes, which write into it
    std::unique_ptr<devices::simulators::SimulatorProcess> arm;
    std::unique_ptr<devices::simulators::SimulatorProcess> pins;
    std::filesystem::path heights;  // where the pins' true heights are written; empty without pins
};

// Starts what the plan has devices for, and lets the plan's devices name the simulators' ports. `press`: PRESS.tsv that the
// simulated hand on the arm follows; empty: no hand. Throws std::runtime_error for a simulator that does not start.
std::unique_ptr<Simulators> start_simulators(const std::filesystem::path& press, std::uint64_t seed, TactilePlan& plan);

// One row of the heights file.
struct TrueHeights {
    double host_s = 0.0;  // steady clock
    std::vector<double> height_m;
};
std::vector<TrueHeights> read_heights(const std::filesystem::path& file);

}  // namespace palpa::tactile
