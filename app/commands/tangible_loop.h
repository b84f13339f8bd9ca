#pragma once
// What several subcommands of palpa tangible take from the command line.

#include <filesystem>
#include <string>

#include "files/json.h"
#include "tangible/device_model.h"

namespace CLI {
class App;
}

namespace palpa::app {

// The device file that a person names: a path, or the name of one among the assets.
std::filesystem::path device_file(const std::string& name);

// Refuses a depth that the device cannot have; an equilibrium there is looked for without end. where, key: as in
// files::bad_input().
void check_depth(const std::string& where, const std::string& key, double depth_m, const tangible::DeviceModel& model);

// The key `fit` of a device file.
files::Json fit_json(const tangible::DeviceFit& fit);

// --fidelity, --command, --rate-Hz; without the first two, those of the scene if `of_scene`, else step and force.
void add_loop_options(CLI::App& command, bool of_scene, std::string& fidelity, std::string& kind, double& rate_Hz);

}  // namespace palpa::app
