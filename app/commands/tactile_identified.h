#pragma once
// What `palpa tactile identify` finds, for `characterise` too.

#include "app/commands/tactile_rig.h"

namespace palpa::app {

// Slow strokes over the arm's range, and the fit.
tactile::CompensationFit identify(const RigOptions& options, const devices::ArmDevice& device, RigResult& result);
files::Json identified_json(const tactile::CompensationFit& fit);

}  // namespace palpa::app
