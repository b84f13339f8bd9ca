#pragma once
// How far a rigid tool reaches below the surface; inside of the contact solvers only.

#include "mechanics/contact.h"

namespace palpa::mechanics {

// Penetration of an undeformed point at (x, y) on the surface plane, and its slope when the tool moves along
// x or y:
//   delta = d - (R - sqrt(R^2 - r^2)),   d(delta)/dx = (x_i - x)/sqrt(R^2 - r^2)
// r^2 = dx^2 + dy^2 (sphere) or dx^2 (cylinder). Beside the tool (r >= R, or past a cylinder's end):
// -infinity.
struct Reach {
    double delta_m = -std::numeric_limits<double>::infinity();
    double slope_x = 0.0;
    double slope_y = 0.0;
};
Reach reach(const Tool& tool, double x_m, double y_m);

// Touch nodes that follow each other lie side by side in most meshes: runs of them are passed over at once.
inline constexpr int kRunLength = 16;

// A gap below this share of the greatest penetration counts as closed; the round-off of C p is 1e-13 of that penetration.
inline constexpr double kGapTolerance = 1e-10;

// Fills the candidate lists with the touch nodes whose delta exceeds -margin times their tool's depth.
void find_candidates(const Compliance& compliance, std::span<const Tool> tools, double margin, ContactWork& work);

// First use of `work`, or with another compliance: every list at its full size once.
void prepare(const Compliance& compliance, ContactWork& work);

// Marks the answer as held; it stays as it is, with an entry for each tool.
void hold(std::size_t n_tools, Contact& contact);

// Does the part of the tool under the surface plane leave the box (x_min, x_max, y_min, y_max)?
bool reaches_beyond(const Tool& tool, const std::array<double, 4>& box_m);

}  // namespace palpa::mechanics
