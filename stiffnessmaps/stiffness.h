#pragma once
// One number per cell: how stiff the place is.

#include <limits>
#include <vector>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

// Stiffness of every cell, N/m, [n_y][n_x]: the least-squares line through contact,
//   k = sum_i F_i d_i / sum_i d_i^2     over the measured depths d_i <= deepest_m,
// so that deep forces weigh most. NaN for a cell without any. A cell whose probing stopped early (a force limit) has
// what it has; where the force bends upwards that is a little too soft, never too stiff.
std::vector<double> stiffness_N_per_m(const Map& map, double deepest_m = std::numeric_limits<double>::infinity());

}  // namespace palpa::stiffnessmaps
