#pragma once
// What `palpa maps info --json` prints.

#include "files/json.h"
#include "stiffnessmaps/field.h"

namespace palpa {

// map.json with shape, missing, force_range_N, noise and smoothing added.
Json map_info(const Map& map, const Field& field);

}  // namespace palpa
