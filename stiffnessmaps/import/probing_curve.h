#pragma once
// One place's force over depth, cleaned: outliers out, from the contact on, along the surface's normal.

#include "stiffnessmaps/import/options.h"

namespace palpa::stiffnessmaps {

struct Probing;
struct ProbedPoint;

// In this order, all choices noted in `source`:
//   outliers  a force is left out that lies farther outside the range of the two beside it than so many
//   robust deviations of
//             the recording's noise (robust.h): spikes go, slopes and kinks stay
//   contact   first_row: the robot had found the surface, depth and force count from the first row.
//             threshold: depth counts from where the force, less its median over the first rows, crosses the
//             threshold; rows before are left out
//   tilt      where depth comes from z: the plane through the contact heights (least squares); depth and
//   force are
//             taken along its normal
// Places with fewer than two depths left are removed.
void clean_curves(Probing& probing, const ImportOptions& options, MapSource& source, ImportReport& report);

// Force at a depth, linear between the place's own steps; NaN beyond its greatest depth (5 % of `step_m` is
// let pass).
double force_at(const ProbedPoint& point, double depth_m, double step_m);

}  // namespace palpa::stiffnessmaps
