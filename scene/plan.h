#pragma once
// The ordered list of the stages that a scene asks for, with their data. A stage that no effect asks for is not in the
// plan: it allocates nothing and is never called.

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
    std::vector<StageId> grid_stages;  // those of sample_stages that also run between samples, on the 240 Hz grid
    std::vector<Stage> frame_stages;
    std::vector<std::string> notes;  // what a person should know about this scene
    calibration::Profile profile;
    Tissue tissue;
    // The rest is filled by describe() of the tissue.
    std::string tissue_name;
    stiffnessmaps::SourceKind source = stiffnessmaps::SourceKind::recorded;
    std::vector<stiffnessmaps::Nodule> nodules;
    bool nodules_known = true;      // false: a recorded map that says nothing of them; marks are then not scored
    double greatest_force_N = 1.0;  // full scale of the force bar
    double greatest_depth_m = 0.0;  // the greatest depth that the tissue is known for
    // Forces that reach a third and two thirds of greatest_depth_m on plain tissue: they part light, medium and deep
    // palpation.
    std::array<double, 2> zone_N{0.0, 0.0};
    double known_N = 1.0;  // force that reaches greatest_depth_m there: what lies above is beyond the known depth
    TissueArea area;
    double indenter_radius_m = 4e-3;
    DrawnIndenter indenter = DrawnIndenter::ball;
    // "recorded" if the map holds a recorded tangential force, else "energy"; how the laws use either is described in
    // stiffnessmaps/field.h.
    const char* tangential_source = "energy";
    avatar::StationLimit stations;  // at how many stations of the path the tissue can answer
};

// Reads the profile and prepares the tissue, which may take seconds to minutes: `progress` reports and may cancel.
// Throws InputError, mechanics' errors for a block that cannot be solved, and mechanics::Cancelled.
Plan make_plan(const Scene& scene, const mechanics::Progress& progress = {});

// Returns whether a plan can be used for a scene that differs from the plan's only in stiffness_scale. Forces are
// scaled when the tissue answers; only the smoothing of a recorded map, which follows from its noise, is fixed in the
// plan.
bool serves(const Plan& plan, const Scene& scene);

// Returns plan.notes, and a note for each scale of the scene that is not 1.
std::vector<std::string> notes_of(const Scene& scene, const Plan& plan);

}  // namespace palpa::scene
