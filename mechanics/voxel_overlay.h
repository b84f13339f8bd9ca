#pragma once
// Runs of several materials laid over a part at once, as one edit.

#include <vector>

#include "mechanics/voxels.h"

namespace palpa::mechanics {

struct PlacedRun {
    int z = 0;
    int y = 0;
    Run run;
};

// Gives the voxels of the runs their materials, notes what was replaced, and forgets what was undone. `runs` are sorted by
// z, then y, then x0. Returns how many voxels changed. Throws MeshError, naming the place in the list, before anything is
// changed: for runs that overlap, that are not sorted, that are empty, or that leave the voxels.
std::int64_t overlay(const std::vector<PlacedRun>& runs, Voxels& voxels, EditHistory& history);

// All runs of a part in that order.
std::vector<PlacedRun> placed_runs(const Voxels& voxels);

}  // namespace palpa::mechanics
