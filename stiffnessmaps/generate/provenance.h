#pragma once
// What a generated map says about itself.

#include <string>

#include "stiffnessmaps/generate/pieces.h"

namespace palpa::stiffnessmaps {

// `source.how`: method, meshes, what is assumed, from which depth the linear range is left.
std::string how_made(const MapTask& task);

}  // namespace palpa::stiffnessmaps
