#pragma once
// Makes a map of point-wise probing: at each of many places a tip is pressed in, and the force is recorded at several
// depths.

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

#include "stiffnessmaps/import/options.h"

namespace palpa::files {
class Table;
}

namespace palpa::stiffnessmaps {

struct Columns;

// Depth and force at one place, ascending in depth. After clean_curves() the first row is the contact.
struct ProbedPoint {
    double x_m = 0.0;
    double y_m = 0.0;
    double z_m = 0.0;      // height of the contact, if depth comes from z
    std::size_t line = 0;  // of the place's first row in the file
    std::vector<double> depth_m;
    std::vector<double> force_N;                                   // normal
    std::vector<double> lateral_N[2];                              // along x and y, only if the tilt is to be removed
    double lifted_to_m = std::numeric_limits<double>::infinity();  // the least depth since the greatest
    double risen_m = 0.0;                                          // the greatest way back towards the greatest depth
};

struct Probing {
    std::vector<ProbedPoint> points;
    bool depth_from_z = false;
};

// Rows of one place have the same number in the column `point`, or else positions within 0.2 mm. Rows are left out (and
// counted) that are not numbers, that are not deeper than the row before, or that are off their command by 1 mm or more
// (the arm had stopped); so of a place that was pressed several times the first press counts, which the report notes.
// Throws InputError.
Probing read_probing(files::Table& table, const Columns& columns, const ImportOptions& options, ImportReport& report);

// Makes a map of what `read_probing` returns, on the grid that the places lie on, or else by bringing scattered places
// onto one (gridding.h). Each place's curve, less its force at contact, is interpolated linearly between its own
// depths; beyond its greatest depth it is missing. The choices go to map.source. `probing` is used up. Throws
// InputError.
Map map_of_probing(Probing& probing, const ImportOptions& options, const std::string& file, ImportReport& report);

}  // namespace palpa::stiffnessmaps
