#pragma once
// A simulated arm that is compensated as a real one would be: by slow strokes and a fit, never by its own parameters.

#include <cstdint>
#include <optional>

#include "scene/plan.h"
#include "tactile/arm_compensation.h"

namespace palpa::session {

// Slow strokes over the arm's whole range with a simulated hand and sensor, in virtual time, and the compensation fitted to
// them; of the arm that run_press() simulates with this seed. Nothing if the scene has no low-impedance arm with a device.
// Throws as make_tactile_plan() and fit_compensation() do. Takes a second or so.
std::optional<tactile::ArmCompensation> identify_simulated_arm(const scene::Scene& scene, const scene::Plan& plan,
                                                               std::uint64_t seed);

}  // namespace palpa::session
