#pragma once
// What is said of the rows of a recorded press.

#include <string>
#include <vector>

#include "devices/press_file.h"
#include "scene/mapping.h"

namespace palpa::app {

// Returns how many rows are beside the tissue, where nothing pushes back, and where the tissue is; "" if none is.
std::string rows_beside(const std::vector<devices::PressRow>& press, const scene::TissueArea& area);

}  // namespace palpa::app
