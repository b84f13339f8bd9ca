#pragma once
// What a generated map says about itself.

#include <string>

#include "stiffnessmaps/generate/pieces.h"

namespace palpa::stiffnessmaps {

// Returns `source.how`: the method, the meshes, what is assumed, and the depth from which the linear range is left.
std::string how_made(const MapTask& task);

}  // namespace palpa::stiffnessmaps
