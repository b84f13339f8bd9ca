#pragma once
// How far a rigid tool reaches below the surface. Only the contact solvers include this.

#include "mechanics/contact.h"

namespace palpa::mechanics {

// The penetration delta of an undeformed point at (x_i, y_i) on the surface plane, and its slope when the tool, whose
// lowest point is at (x, y) and at depth d, moves along x or y:
//   delta = d - (R - sqrt(R^2 - r^2)),   d(delta)/dx = (x_i - x)/sqrt(R^2 - r^2)
// r is the distance of the point from (x, y) for a sphere, and along x for a cylinder. Beside the tool (r >= R, or past
// a cylinder's end) delta is -infinity.
struct Reach {
    double delta_m = -std::numeric_limits<double>::infinity();
    double slope_x = 0.0;
    double slope_y = 0.0;
};
Reach reach(const Tool& tool, double x_m, double y_m);

// Touch nodes with consecutive numbers lie side by side in most meshes, so that whole runs of them can be skipped.
inline constexpr int kRunLength = 16;

// A gap below this share of the greatest penetration counts as closed; the round-off of C p is 1e-13 of that penetration.
inline constexpr double kGapTolerance = 1e-10;

// Fills the candidate lists with the touch nodes whose delta exceeds -margin times their tool's depth.
void find_candidates(const Compliance& compliance, std::span<const Tool> tools, double margin, ContactWork& work);

// Reserves every list of `work` at its full size and forgets the last contact, unless `work` was prepared for this
// compliance already.
void prepare(const Compliance& compliance, ContactWork& work);

// Marks the answer as held; otherwise it stays as it is, with an entry for each tool.
void hold(std::size_t n_tools, Contact& contact);

// Returns whether the part of the tool under the surface plane leaves the box (x_min, x_max, y_min, y_max).
bool reaches_beyond(const Tool& tool, const std::array<double, 4>& box_m);

}  // namespace palpa::mechanics
