#pragma once
// What `palpa tactile identify` finds, for `characterise` too.

#include "app/commands/tactile_rig.h"

namespace palpa::app {

// Slow strokes over the arm's range, and the fit.
tactile::CompensationFit identify(const RigOptions& options, const devices::ArmDevice& device, RigResult& result);
files::Json identified_json(const tactile::CompensationFit& fit);
// The name that the compensation file gives, marked if the arm is simulated: the file may be read for a real one.
std::string arm_name(const devices::ArmDevice& device, const RigOptions& options);

}  // namespace palpa::app
