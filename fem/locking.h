#pragma once
// Locking: elements that cannot bend without changing their volume are too stiff in nearly incompressible tissue, and few of
// them across a bar or plate bend too little, or too much.

#include <string>

#include "fem/case.h"
#include "mechanics/statics.h"

namespace palpa::fem {

// Returns "" unless the element is tet4 or hex8 and a material's Poisson's ratio is 0.47 or more, or hex8i and 0.499. The warning names the
// greatest ratio, how many times too stiff the element is on the slab of docs/fem.md, and the element that does not
// lock.
std::string locking_warning(const mechanics::Problem& problem);

// Returns "" unless a box is at most a quarter as thick as it is long, has fewer than four cells across, nothing holds its two
// broad sides, and the element is not hex8i. The warning says what bars of so many cells do (docs/fem.md).
std::string bending_warning(const FemCase& model);

}  // namespace palpa::fem
