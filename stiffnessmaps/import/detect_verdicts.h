#pragma once
// Decides whether a candidate stands out further than areas of its size vary elsewhere on the map: steps 4 and 5 of
// detect.h. Only detect*.cpp use it.

#include "stiffnessmaps/import/detect_candidates.h"

namespace palpa::stiffnessmaps {

// Judges all candidates. Several nodules must not hide each other, and variation of one kind must not be sure candidate
// by candidate. Therefore a candidate that stands out twice as far as is needed, with all candidates left out of the
// rest, is no background for the others; nor is one that then turns out sure. Every other candidate counts as
// background. At the edge none is left out beforehand, since a rough edge is full of candidates.
void judge_all(const StiffnessGrid& grid, const Detection& d, std::vector<Candidate>& found);

}  // namespace palpa::stiffnessmaps
