#pragma once
// What a scene's key `tangible` asks for: a soft device that pushes back as the scene's tissue would. Plain data; the
// library `tangible` makes its own plan from it.

#include <Eigen/Core>
#include <filesystem>
#include <optional>
#include <string>

#include "files/json.h"

namespace palpa::scene {

struct TangibleOptions {
    std::filesystem::path device;
    std::optional<Eigen::Vector2d> at_m;  // place on the tissue that is felt; absent: that of the latest touch
    double force_scale = 1.0;             // the device's force over that of the tissue
    double depth_scale = 1.0;             // depth in the tissue over that of the device
    double rate_share = 1.0;              // of the actuators' rates, that the loop makes use of
    // Who stands in for hardware: nobody (empty), the device's own model ("exact"), or the file of a model that differs
    // from it (assets/plants).
    std::string plant;
    std::string fidelity =
        "step";  // of the inverse problem: "step", "converged", "stale" or "linear" (tangible/inverse.h)
    std::string command = "force";  // what the drives are told: "force" or "position"
};

// Reads the key `tangible` of a scene file. `assets`: where devices (devices/) and plants (plants/) are looked for if they
// are not beside the scene file. Throws InputError.
TangibleOptions read_tangible(files::JsonReader json, const std::filesystem::path& scene_file,
                              const std::filesystem::path& assets);

}  // namespace palpa::scene
