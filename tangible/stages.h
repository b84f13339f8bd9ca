#pragma once
// What the plan of a soft device says about itself.

#include <vector>

#include "scene/stage_text.h"
#include "tangible/plan.h"

namespace palpa::tangible {

// Medians, in microseconds on this machine.
struct TickCost {
    double tick_us = 0.0;   // a whole tick
    double world_us = 0.0;  // of it the tissue's force at the finger's depth
};

// Runs the loop through one press of the device to half the depth that the tissue is known for, at most 3 mm: what a tick
// costs depends on the meshes of the device and of the tissue.
TickCost tick_cost(const TangiblePlan& plan);

// The stages of the device's loop, in order, for `palpa explain`. All of the tick but the tissue's force stands with the
// inverse problem.
std::vector<scene::StageText> stages_of(const TangiblePlan& plan, const TickCost& cost);

}  // namespace palpa::tangible
