#pragma once
// Cleans each place's force over depth: without outliers, from the contact on, along the surface's normal.

#include "stiffnessmaps/import/options.h"

namespace palpa::stiffnessmaps {

struct Probing;
struct ProbedPoint;

// Cleans in this order, and records all choices in `source`:
//   outliers  leaves out a force that lies farther outside the range of its two neighbours than this many robust
//             deviations of the recording's noise (robust.h): spikes go, slopes and kinks stay
//   contact   first_row: the robot had found the surface; depth and force count from the first row.
//             threshold: depth counts from where the force begins, force from that in the air (contact_height.h).
//             given: depths and forces count from the surface as they stand; rows that are not below it are left out.
//             Depths that begin far from 0 are refused unless the options choose one of the three. Throws InputError
//             for threshold where places have too few rows in the air
//   tilt      if depth comes from z: fits a plane through the contact heights (least squares) and takes depth and force
//             along its normal
// Places with fewer than two depths left are removed. Throws InputError.
void clean_curves(Probing& probing, const ImportOptions& options, const std::string& file, MapSource& source,
                  ImportReport& report);

// Returns the force at a depth, linear between the place's own steps; NaN beyond its greatest depth (by more than 5 %
// of `step_m`).
double force_at(const ProbedPoint& point, double depth_m, double step_m);

}  // namespace palpa::stiffnessmaps
