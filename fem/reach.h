#pragma once
// Contact is computed only on the plane that the tool comes down on; the tool must not reach tissue beside that plane.

#include "fem/case.h"

namespace palpa::fem {

// Throws InputError if the tool at this depth cuts into a part of the surface that faces upwards and lies below zmax,
// such as a step or the slope around a flat top. Tests the corners and the middle of each face.
void check_reach(const FemCase& model, double depth_m);

}  // namespace palpa::fem
