#pragma once
// Estimates what a phantom's map takes to compute, before anything of its size is allocated.

#include "stiffnessmaps/generate/pieces.h"

namespace palpa::stiffnessmaps {

// Throws InputError for a grid with too many forces and for a phantom whose meshes are out of reach
// (mechanics/rolling_cost.h). The message names the key and the smallest value that would do.
void check_cost(const MapTask& task, double coarseness, const std::string& file);

}  // namespace palpa::stiffnessmaps
