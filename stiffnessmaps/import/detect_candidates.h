#pragma once
// Connected cells that stand out from the background: step 3 of detect.h. Only detect*.cpp use it.

#include "stiffnessmaps/import/detect_ground.h"

namespace palpa::stiffnessmaps {

struct Candidate {
    cv::Mat1b mask;
    cv::Mat1b slopes;  // the mask and the cells around it that it raises
    StiffRegion region;
};

// Returns the excess from which a cell counts, N/m.
double threshold_at(const StiffnessGrid& grid, const Detection& d, int j, int i);

// Returns the candidates of one look, not judged yet.
std::vector<Candidate> candidates(const StiffnessGrid& grid, const Map& map, const Detection& d);

}  // namespace palpa::stiffnessmaps
