#pragma once
// What is to be simulated, as one JSON file asks for it; a scene is constant while it runs. Every effect is optional:
// an absent effect is not simulated.

#include <array>
#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "avatar/delay.h"
#include "avatar/display_ratio.h"
#include "mechanics/mesh.h"
#include "parts/stiffness.h"
#include "scene/cues.h"
#include "scene/force_curve.h"
#include "scene/mapping.h"
#include "scene/soft_block.h"
#include "scene/tactile_options.h"
#include "scene/tangible_options.h"
#include "stiffnessmaps/field.h"

namespace palpa::scene {

// The tissue that is asked for. scene/tissue.h lists what every tissue answers.
// `nodules`: false for tissue without them, to compare with: a map answers everywhere with the median of its cells.
struct MapOptions {
    std::filesystem::path folder;
    bool nodules = true;
};
struct LinearOptions {
    std::filesystem::path phantom;
    double spacing_m = 2e-3;         // of the surface nodes; memory grows with its power -4, preparation time faster
    std::optional<double> friction;  // coefficient, > 0; absent: frictionless
    bool nodules = true;
    // Finer around a place and towards the surface, so that `spacing_m` is only the mean; absent: even.
    std::optional<mechanics::Grading> grading{};
};
// One or two designs of a part. Press: the pen's newtons act where it presses, along the direction of the load. Pull: the
// drag moves the part, and its resistance enters the avatar's laws.
enum class PartGesture { press, pull };
struct PartOptions {
    std::vector<std::filesystem::path> designs;  // part files, one or two
    std::string load;                            // by its name in both; empty: the only one
    parts::Method method = parts::Method::voxels;
    std::optional<double> cell_m;  // of voxels; absent: the part's
    PartGesture gesture = PartGesture::press;
    std::array<int, 2> view{0, 2};  // axes of the picture, to the right and upwards
    bool both = false;              // both designs bear what the pen does to one
};
using TissueOptions = std::variant<MapOptions, LinearOptions, PartOptions, ForceCurveOptions, SoftBlockOptions>;

// How the avatar's laws take the tangential force from a map.
struct TangentialOptions {
    stiffnessmaps::TangentialForce force = stiffnessmaps::TangentialForce::energy;
    std::optional<double> smoothing_m;  // Gaussian sigma; absent: from the map's own noise (stiffnessmaps/noise.h)
    // Divides its rise by the normal force in newtons, so that a place lags alike however hard it is pressed. Otherwise
    // the lag grows faster than the force.
    bool per_newton = false;
};

// A finger hides the avatar. Under it the texture of the tissue takes over a share of the avatar's lag: it is dragged
// along with the finger by that share, and the avatar keeps the rest. What moves against what stays the same.
struct TextureDrag {
    double strength = 1.0;  // share, > 0 ... 1; at 1 the avatar stays at the finger
};

// What the tissue looks like, and what is pressed into it.
enum class SurfaceMaterial { skin, silicone };
enum class DrawnIndenter { ball, probe, fingertip };

struct SurfaceEffect {
    std::optional<double> indenter_radius_m;  // absent: that of the map or the phantom
    double thickness_m = 25e-3;               // of a map's tissue, bonded to its base
    SurfaceMaterial material = SurfaceMaterial::skin;
    std::optional<DrawnIndenter> indenter;  // absent: as that of the map or the phantom is
};

struct Scene {
    std::string name;
    std::filesystem::path file;  // the file it was read from; empty for scene_of_map()
    TissueOptions tissue;
    double stiffness_scale = 1.0;  // multiplies the tissue's forces, as so many times its Young's modulus would
    std::filesystem::path profile;
    Mapping mapping;
    double force_scale = 1.0;  // phantom force: multiplies the pen's newtons
    TangentialOptions tangential;
    std::optional<avatar::DisplayRatio> display_ratio;  // at most one of the two laws
    std::optional<avatar::Delay> delay;
    std::optional<TextureDrag> texture_drag;  // only beside a law
    std::optional<SurfaceEffect> surface;
    DrawnCues cues;  // of the surface
    std::optional<TactileOptions> tactile;
    std::optional<TangibleOptions> tangible;
    std::int64_t seed = 1;
};

// Whether an arm's motion is the input: the arm then presses, and what touches the screen only points.
inline bool arm_leads(const Scene& scene) noexcept {
    return scene.tactile && scene.tactile->arm && scene.tactile->leads == Leads::arm;
}

// Whether a finger on a real soft device is the input, at a place on the tissue that the scene names.
inline bool soft_device_leads(const Scene& scene) noexcept {
    return scene.tangible && scene.tangible->plant.empty() && scene.tangible->at_m;
}

// Whether a device's motion is the input, so that the screen takes no press.
inline bool device_leads(const Scene& scene) noexcept { return arm_leads(scene) || soft_device_leads(scene); }

// Returns the path parameters of the scene's law, or the defaults if it has none.
avatar::PathParameters path_of(const Scene& scene);

// Reads a scene. Paths in it are relative to the file; a name without a folder that is not beside the file is looked
// for among the assets (maps/, phantoms/, profiles/). Throws InputError.
Scene read_scene(const std::filesystem::path& file, const std::filesystem::path& assets);

// Returns a scene of a map with the defaults: display ratio `clear`, surface, direct mapping.
Scene scene_of_map(const std::filesystem::path& map, const std::filesystem::path& assets);

}  // namespace palpa::scene
