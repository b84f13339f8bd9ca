#pragma once
// What a plan's tissue is asked for besides its answers: whether it fits a scene, and what a person should know of
// both.

#include <string>
#include <vector>

#include "scene/plan.h"

namespace palpa::scene {

// Whether a plan that was made for one stiffness_scale is right for this scene, which is the same but for that. Forces
// are scaled where they are answered; only the smoothing of a recorded map, which follows from its noise, is fixed
// in the plan.
bool serves(const Plan& plan, const Scene& scene);

// plan.notes, and what the scene scales.
std::vector<std::string> notes_of(const Scene& scene, const Plan& plan);

}  // namespace palpa::scene
