#pragma once
// Elements that cannot keep their volume and bend at once are too stiff in nearly incompressible tissue.

#include <string>

#include "mechanics/statics.h"

namespace palpa::fem {

// Empty unless tet4 or hex8 is asked to carry a material from poisson 0.47 on. Names the greatest Poisson's
// ratio, what it cost on the slab of docs/fem.md, and the element that does not lock.
std::string locking_warning(const mechanics::Problem& problem);

}  // namespace palpa::fem
