#pragma once
// The pictures of numbers that figures show of a map.

#include "figures/map_script.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/import/detect.h"

namespace palpa::figures {

// Returns a picture with the grid of the map's cells, without values.
Image image_of(const stiffnessmaps::Map& map);

Image stiffness_image(const stiffnessmaps::Map& map);

// Returns the stiffness, with the map's nodules and the found regions drawn over it.
Image nodules_image(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection, Script& script);

// Returns the depth that a force reaches in each cell; the title says so where it is not reached.
Image depth_image(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field, double force_N);

// Returns the force along x through a row of cells, down to the deepest layer.
Image section_image(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field, std::size_t row);

}  // namespace palpa::figures
