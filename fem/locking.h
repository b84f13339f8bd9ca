#pragma once
// Locking: elements that cannot bend without changing their volume are too stiff in nearly incompressible tissue.

#include <string>

#include "mechanics/statics.h"

namespace palpa::fem {

// Returns "" unless the element is tet4 or hex8 and a material's Poisson's ratio is 0.47 or more, or hex8i and 0.499. The warning names the
// greatest ratio, how many times too stiff the element is on the slab of docs/fem.md, and the element that does not
// lock.
std::string locking_warning(const mechanics::Problem& problem);

}  // namespace palpa::fem
