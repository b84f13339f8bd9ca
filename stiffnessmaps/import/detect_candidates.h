#pragma once
// The cells that stand out of the background and hang together: step 3 of detect.h. Only detect*.cpp use it.

#include "stiffnessmaps/import/detect_ground.h"

namespace palpa::stiffnessmaps {

struct Candidate {
    cv::Mat1b mask;
    cv::Mat1b slopes;
    StiffRegion region;
};

// Excess from which a cell counts.
double threshold_at(const StiffnessGrid& grid, const Detection& d, int j, int i);

// Without a verdict yet.
std::vector<Candidate> candidates(const StiffnessGrid& grid, const Map& map, const Detection& d);

}  // namespace palpa::stiffnessmaps
