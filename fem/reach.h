#pragma once
// What a tool must not meet: tissue beside the plane that it comes down on, where no contact is computed.

#include "fem/case.h"

namespace palpa::fem {

// Throws InputError where the tool at this depth is inside a part of the surface that looks upwards and is
// lower than zmax: a step, or the slope around a flat top.
void check_reach(const FemCase& model, double depth_m);

}  // namespace palpa::fem
