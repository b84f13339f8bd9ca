#pragma once
// What figures show of a map, as pictures of numbers.

#include "figures/map_script.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/import/detect.h"

namespace palpa::figures {

// The grid of the map's cells, without values.
Image image_of(const stiffnessmaps::Map& map);

Image stiffness_image(const stiffnessmaps::Map& map);

// Stiffness with the map's nodules and the regions found drawn over it.
Image nodules_image(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection, Script& script);

// How deep a force goes.
Image depth_image(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field, double force_N);

// Force along x through a row of cells, down to the deepest matrix.
Image section_image(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field, std::size_t row);

}  // namespace palpa::figures
