#pragma once
// Whether a candidate stands out further than areas of its size vary elsewhere on the map: steps 4 and 5 of detect.h. Only
// detect.cpp uses it.

#include "stiffnessmaps/import/detect_candidates.h"

namespace palpa::stiffnessmaps {

// Several nodules must not hide each other, and lumps of one kind of tissue must not lend each other credit: what stands
// out twice as far as is needed, with all candidates left out of the rest, is no background for the others; every other
// candidate is. At the edge none is left out beforehand: a rough rim is candidates all along.
void judge_all(const StiffnessGrid& grid, const Detection& d, std::vector<Candidate>& found);

}  // namespace palpa::stiffnessmaps
