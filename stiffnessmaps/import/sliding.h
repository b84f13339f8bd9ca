#pragma once
// A tool that slides over the tissue, at constant depth or while its force goes up and down, becomes a map.

#include "files/table.h"
#include "stiffnessmaps/import/finish.h"
#include "stiffnessmaps/import/surface.h"

namespace palpa::stiffnessmaps {

struct Columns;

struct Sliding {
    SurfaceSamples samples;
    std::vector<double> time_s;
    std::vector<float> depth_m;   // where the recording or the person says it; else empty
    std::vector<float> normal_N;  // recorded as such; else empty
};

// Appends a file's rows; `at_depth_m` > 0: all were recorded at this depth. Rows that are not numbers are
// passed over (and counted). Throws InputError, also where time goes back.
void read_sliding(files::Table& table, const Columns& columns, const ImportOptions& options, double at_depth_m,
                  Sliding& sliding, ImportReport& report);

// The surface is taken from the recording, from --surface-z-mm, or estimated (surface.h); depth is what the
// tool is below it along its normal. The tangential force is that against the motion of samples that move
// along + an axis (within 37 degrees). Cells draw from the samples around them (gridding.h). Throws
// InputError.
Map map_of_sliding(Sliding& sliding, const ImportOptions& options, const std::string& file, ImportReport& report);

}  // namespace palpa::stiffnessmaps
