#pragma once
// Writes a map for other programs.

#include <filesystem>
#include <string>

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

// The ending of `file` decides the format:
//   .npy   one array, shape [n_depth, n_y, n_x], float32: the one that `array` names, such as normal_N
//   .csv   one row per place and depth: x_mm,y_mm,depth_mm,normal_N,tangential_x_N,tangential_y_N; n/a = not measured
//   .mat   MATLAB 5: normal_N, tangential_x_N, tangential_y_N [n_depth n_y n_x], x_mm, y_mm, depths_mm
//   none   a new folder with these arrays as .npy
// Forces are read back as the same floats. The output is written whole or not at all. Throws InputError for another
// ending, for a folder that exists, and for an array that the map does not have; std::runtime_error if it cannot be
// written.
void export_map(const Map& map, const std::string& array, const std::filesystem::path& file);

}  // namespace palpa::stiffnessmaps
