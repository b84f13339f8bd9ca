#pragma once
// Makes a map of a tool that slides over the tissue, at constant depth or while its force rises and falls.

#include "files/table.h"
#include "stiffnessmaps/import/finish.h"
#include "stiffnessmaps/import/surface.h"

namespace palpa::stiffnessmaps {

struct Columns;

struct Sliding {
    SurfaceSamples samples;
    std::vector<double> time_s;
    std::vector<float> depth_m;   // recorded or stated; else empty
    std::vector<float> normal_N;  // recorded; else empty
};

// Appends the rows of a file; if `at_depth_m` > 0, all were recorded at this depth. Rows that are not numbers are left
// out (and counted). Throws InputError, also if time goes back.
void read_sliding(files::Table& table, const Columns& columns, const ImportOptions& options, double at_depth_m,
                  Sliding& sliding, ImportReport& report);

// The surface comes from recorded depths, from --surface-z-mm, or is estimated (surface.h); depth is then the distance
// of the tool below it along its normal. The tangential force is the one against the motion, from samples that move
// along a positive axis (within 37 degrees). Cells use the samples around them (gridding.h). Throws InputError.
Map map_of_sliding(Sliding& sliding, const ImportOptions& options, const std::string& file, ImportReport& report);

}  // namespace palpa::stiffnessmaps
