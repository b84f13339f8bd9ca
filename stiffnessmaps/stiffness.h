#pragma once
// One number per cell: how stiff the place is.

#include <limits>
#include <vector>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

// Returns the stiffness of every cell, N/m, [n_y][n_x]: the slope of the least-squares line through the contact,
//   k = sum_i F_i d_i / sum_i d_i^2     over the measured depths d_i <= deepest_m,
// so that forces at great depths weigh most. NaN for a cell without any. For a cell whose probing stopped early (a
// force limit) only its own depths count; where force rises more than linearly with depth, the result is a little too
// low, never too high.
std::vector<double> stiffness_N_per_m(const Map& map, double deepest_m = std::numeric_limits<double>::infinity());

}  // namespace palpa::stiffnessmaps
