#pragma once
// What was asked for, from one JSON file; a scene is constant while it runs. Every effect is optional: an absent effect
// is not simulated.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>

#include "avatar/delay.h"
#include "avatar/display_ratio.h"
#include "scene/mapping.h"
#include "stiffnessmaps/field.h"

namespace palpa::scene {

// The tissue that was asked for. scene/tissue.h says what every tissue answers.
struct MapOptions {
    std::filesystem::path folder;
};
struct LinearOptions {
    std::filesystem::path phantom;
    double spacing_m = 2e-3;         // of the surface nodes; cost of the precomputation grows with its power -6
    std::optional<double> friction;  // coefficient, > 0; absent: frictionless
};
using TissueOptions = std::variant<MapOptions, LinearOptions>;

// How the avatar's laws read a map.
struct TangentialOptions {
    stiffnessmaps::TangentialForce force = stiffnessmaps::TangentialForce::energy;
    std::optional<double> smoothing_m;  // absent: from the map's own noise (stiffnessmaps/noise.h)
};

struct SurfaceEffect {
    std::optional<double> indenter_radius_m;  // absent: the map's indenter
    double thickness_m = 25e-3;               // of the tissue, bonded to its base
};

struct Scene {
    std::string name;
    std::filesystem::path file;  // where it was read; empty if made up from a map
    TissueOptions tissue;
    double stiffness_scale = 1.0;  // multiplies the tissue's forces: linear elastic tissue of so many times the modulus
    std::filesystem::path profile;
    Mapping mapping;
    double force_scale = 1.0;  // phantom force: multiplies the pen's newtons
    TangentialOptions tangential;
    std::optional<avatar::DisplayRatio> display_ratio;  // at most one of the two laws
    std::optional<avatar::Delay> delay;
    std::optional<SurfaceEffect> surface;
    std::int64_t seed = 1;
};

// The path parameters of the law in force, or the defaults.
avatar::PathParameters path_of(const Scene& scene);

// Throws InputError. Paths inside are relative to the scene's file; a name without a folder is also looked
// for among the assets (maps/, profiles/).
Scene read_scene(const std::filesystem::path& file, const std::filesystem::path& assets);

// A scene of a map with the defaults: display ratio `clear`, surface, direct mapping.
Scene scene_of_map(const std::filesystem::path& map, const std::filesystem::path& assets);

}  // namespace palpa::scene
