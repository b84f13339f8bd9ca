#pragma once
// The ordered list of stages that a scene needs, with the data each one needs. What no effect asks for is not
// in it: it allocates nothing and is never called.

#include <array>
#include <string>
#include <vector>

#include "calibration/profile.h"
#include "scene/scene.h"
#include "scene/tissue.h"
#include "stiffnessmaps/map.h"

namespace palpa::scene {

struct Plan {
    std::vector<Stage> sample_stages;
    std::vector<StageId> grid_stages;  // of these, what goes on between samples too, on the 240 Hz grid
    std::vector<Stage> frame_stages;
    std::vector<std::string> notes;  // what a person should know about this scene
    calibration::Profile profile;
    Tissue tissue;
    // What the tissue says of itself:
    std::string tissue_name;
    stiffnessmaps::SourceKind source = stiffnessmaps::SourceKind::recorded;
    std::vector<stiffnessmaps::Nodule> nodules;
    double greatest_force_N = 1.0;  // of the force bar
    double greatest_depth_m = 0.0;  // that the tissue is known for
    // Forces that reach a third and two thirds of it on plain tissue: light, medium and deep palpation.
    std::array<double, 2> zone_N{0.0, 0.0};
    TissueArea area;
    double indenter_radius_m = 4e-3;
    const char* tangential_source = "energy";  // or recorded: the laws use both then (stiffnessmaps/field.h)
    avatar::StationLimit stations;             // of the path that it can answer at
};

// Reads the profile and prepares the tissue, which may take seconds: `progress` tells and may stop it. Throws
// InputError, and mechanics' errors for a block that cannot be solved.
Plan make_plan(const Scene& scene, const mechanics::Progress& progress = {});

// Whether a plan that was made for one stiffness_scale is right for this scene, which is the same but for that. Forces
// are scaled where they are answered; only the smoothing of a recorded map, which follows from its noise, is fixed
// in the plan.
bool serves(const Plan& plan, const Scene& scene);

// plan.notes, and what the scene scales.
std::vector<std::string> notes_of(const Scene& scene, const Plan& plan);

}  // namespace palpa::scene
