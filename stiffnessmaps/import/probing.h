#pragma once
// Point-wise probing becomes a map: at each of many places a tip is pressed in, and the force is recorded at
// several depths.

#include <filesystem>

#include "stiffnessmaps/import/options.h"

namespace palpa::files {
class Table;
}

namespace palpa::stiffnessmaps {

struct Columns;

// Depth and force of one place, ascending in depth, from the contact on.
struct ProbedPoint {
    double x_m = 0.0;
    double y_m = 0.0;
    double z_m = 0.0;  // at contact, where depth comes from z
    std::size_t line = 0;
    std::vector<double> depth_m;
    std::vector<double> force_N;       // normal
    std::vector<double> lateral_N[2];  // only where the tilt is to be removed
};

struct Probing {
    std::vector<ProbedPoint> points;
    bool depth_from_z = false;
};

// Rows of one place are told by the column `point`, or else by a position within 0.2 mm. Rows are passed over
// (and counted) that are not numbers, whose depth is not beyond the last one's, or that are off their command
// by more than 1 mm (the arm had stopped). Throws InputError.
Probing read_probing(files::Table& table, const Columns& columns, const ImportOptions& options, ImportReport& report);

// What `read_probing` returns, as a map: on the grid that the places lie on, or else scattered places brought
// onto one (gridding.h). Each place's curve, less its force at contact, is interpolated linearly between its
// own depths; beyond its greatest depth it is missing. Choices go to map.source. `probing` is used up. Throws
// InputError.
Map map_of_probing(Probing& probing, const ImportOptions& options, const std::string& file, ImportReport& report);

}  // namespace palpa::stiffnessmaps
