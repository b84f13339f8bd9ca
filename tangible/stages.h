#pragma once
// What the plan of a soft device says about itself.

#include <vector>

#include "scene/stage_text.h"
#include "tangible/plan.h"

namespace palpa::tangible {

// The stages of the device's loop, in order, for `palpa explain`. What a tick costs depends on the device's mesh, so it is
// measured (median_tick_us()) and stands with the inverse problem, which takes nearly all of it.
std::vector<scene::StageText> stages_of(const TangiblePlan& plan, double tick_us);

// Runs the loop through one press of the device to half the depth that the tissue is known for, at most 3 mm, and returns the
// median time of a tick: microseconds on this machine.
double median_tick_us(const TangiblePlan& plan);

}  // namespace palpa::tangible
