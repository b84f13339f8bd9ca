#pragma once
// What a phantom's map would take to compute, before anything of its size is allocated.

#include "stiffnessmaps/generate/pieces.h"

namespace palpa::stiffnessmaps {

// Throws InputError naming the key of a phantom whose meshes are out of reach (mechanics/rolling_cost.h), with the
// smallest value that would do, or of a grid with too many forces.
void check_cost(const MapTask& task, double coarseness, const std::string& file);

}  // namespace palpa::stiffnessmaps
