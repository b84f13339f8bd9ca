#pragma once
// The force that holds a sliding tool back.

#include "stiffnessmaps/import/gridding.h"
#include "stiffnessmaps/import/sliding.h"

namespace palpa::stiffnessmaps {

// Fills the tangential forces of `pressed`, which has one sample for each of `sliding`'s: along +x from those
// that move along +x (within 37 degrees), likewise y, along the surface, positive where it opposes the
// motion. False, with a note, where the recording has no lateral force, where it is not wanted, or where it
// pushes the tool along instead of holding it back.
bool take_tangential(const Sliding& sliding, const Surface& surface, const ImportOptions& options, Samples& pressed,
                     ImportReport& report);

}  // namespace palpa::stiffnessmaps
