#pragma once
// Point-wise probing by a robot becomes a map: at each point of a grid a ball tip is pressed along the
// surface normal in depth steps, and the force is recorded at each.

#include <filesystem>

#include "stiffnessmaps/map.h"

namespace palpa {

struct ProbingReport {
    std::size_t rows = 0;
    std::size_t points = 0;
    std::size_t rejected_rows = 0;     // depth off its command by more than 1 mm: the arm had stopped
    std::size_t rejected_points = 0;   // fewer than two depths left
    std::size_t missing_cells = 0;     // of the grid
    double median_offset_N = 0.0;      // force at contact, subtracted point by point
    double median_residual_N = 0.0;    // |map - recording| at the recorded depths
    double worst_residual_N = 0.0;
};

// Reads columns point, ref_x_mm, ref_y_mm, depth_cmd_mm, depth_mm, fn_N (others are passed over). The grid
// comes from the commanded positions, which must lie on a regular grid along x and y; the depths are as many
// as the points' median number of steps, equally spaced up to the median greatest depth. Each point's curve,
// less its force at contact, is interpolated linearly between its own depths; beyond its greatest depth the
// cell is missing. Throws InputError.
Map import_probing(const std::filesystem::path& csv, double indenter_radius_m, ProbingReport& report);

}  // namespace palpa
