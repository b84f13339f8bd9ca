#pragma once
// The force that holds a sliding tool back.

#include "stiffnessmaps/import/gridding.h"
#include "stiffnessmaps/import/sliding.h"

namespace palpa::stiffnessmaps {

// Fills in the tangential forces of `pressed`, which has one sample for each of those of `sliding`: along x from
// samples that move along +x (within 37 degrees), along y likewise; along the surface, and positive where the force
// opposes the motion. Returns false if the recording has no lateral force or none is wanted, and, with a note, if the
// force pushes the tool along instead of holding it back.
bool take_tangential(const Sliding& sliding, const Surface& surface, const ImportOptions& options, Samples& pressed,
                     ImportReport& report);

}  // namespace palpa::stiffnessmaps
