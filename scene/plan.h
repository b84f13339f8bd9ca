#pragma once
// The ordered list of stages that a scene needs, with the data each one needs. What no effect asks for is not
// in it: it allocates nothing and is never called.

#include <array>
#include <string>
#include <variant>
#include <vector>

#include "avatar/surface.h"
#include "calibration/profile.h"
#include "scene/scene.h"
#include "scene/stages.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/map.h"

namespace palpa::scene {

// A recorded or generated map, prepared for look-up.
struct MapTissue {
    stiffnessmaps::Map map;
    stiffnessmaps::Field field;
    double noise_N = 0.0;      // of the map
    double smoothing_m = 0.0;  // of the tangential force
};

struct Plan {
    std::vector<Stage> sample_stages;
    std::vector<Stage> frame_stages;
    std::vector<std::string> notes;  // what a person should know about this scene
    calibration::Profile profile;
    std::variant<MapTissue, LinearTissue> tissue;
    std::string tissue_name;
    stiffnessmaps::SourceKind source = stiffnessmaps::SourceKind::recorded;
    std::vector<stiffnessmaps::Nodule> nodules;
    double greatest_force_N = 1.0;  // of the force bar
    double greatest_depth_m = 0.0;  // that the tissue is known for
    // Forces that reach a third and two thirds of it on plain tissue: light, medium and deep palpation.
    std::array<double, 2> zone_N{0.0, 0.0};
    TissueArea area;
    double indenter_radius_m = 4e-3;
};

// Reads the map and the profile, or computes the linear tissue, which takes seconds: `progress` tells and may stop
// it. Throws InputError, and mechanics' errors for a block that cannot be solved.
Plan make_plan(const Scene& scene, const mechanics::Progress& progress = {});

}  // namespace palpa::scene
