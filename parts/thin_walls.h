#pragma once
// Thin walls of a part, and thin layers in it, which few cells resolve.

#include "mechanics/voxels.h"

namespace palpa::parts {

// Returns the share of the voxels, 0 to 1, whose material ends on both sides within fewer than `least` voxels along x, y or
// z. Of a large part some 20,000 voxels are looked at.
double share_of_thin_walls(const mechanics::Voxels& voxels, int least);

}  // namespace palpa::parts
