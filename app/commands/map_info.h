#pragma once
// What `palpa maps info --json` prints.

#include "files/json.h"
#include "stiffnessmaps/field.h"

namespace palpa::app {

// Returns map.json with shape, missing, force_range_N, noise and smoothing added.
files::Json map_info(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field);

}  // namespace palpa::app
