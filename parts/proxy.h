#pragma once
// The proxy of a pen in a slice of a part: it follows the pen through air, and stays on the surface where the pen goes
// into the material.

#include <array>

#include "mechanics/voxels.h"

namespace palpa::parts {

// A plane of voxels through a part: u and v along two axes, at one voxel of the third.
struct Slice {
    std::array<int, 2> view{0, 2};
    int depth = 0;  // voxel along the third axis
};
bool filled_at(const mechanics::Voxels& voxels, const Slice& slice, int i, int j);

// Moves the proxy to the pen: straight, until a voxel is in the way; then along its face as far as the pen's motion goes, and
// so on. It passes no voxel, at any speed and through no corner, for it goes from voxel to voxel. Positions in the part's
// frame, metres along the two axes. The proxy must be in air; one that is not stays. Not finite: nothing changes. Allocates
// nothing and does not throw.
// Source: Zilles, Salisbury, "A constraint-based god-object method for haptic display", IROS 1995; on voxels: ours.
void follow_pen(const mechanics::Voxels& voxels, const Slice& slice, const std::array<double, 2>& pen_m,
                std::array<double, 2>& proxy_m);

// Says whether the proxy stands on a face that looks against `direction` (an axis of the slice, 0 or 1, and its sign).
bool rests_on(const mechanics::Voxels& voxels, const Slice& slice, int axis, int sign,
              const std::array<double, 2>& proxy_m);

}  // namespace palpa::parts
