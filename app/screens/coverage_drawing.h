#pragma once

#include <imgui.h>

#include "render/tissue.h"
#include "study/coverage.h"

namespace palpa::app {

// Draws how deep each place of a tissue was pressed, over the tissue. Places that were never touched are hatched, so that
// "never touched" is not one more colour. `mm`: px per millimetre.
void draw_coverage(const render::TissueView& view, const study::Coverage& coverage, float mm, ImDrawList& draw);

}  // namespace palpa::app
