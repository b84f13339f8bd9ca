#include "session/tactile_run_identify.h"

#include "devices/simulators/arm_plant.h"
#include "tactile/arm_strokes.h"
#include "tactile/plan.h"

namespace palpa::session {

std::optional<tactile::ArmCompensation> identify_simulated_arm(const scene::Scene& scene, const scene::Plan& plan,
                                                               std::uint64_t seed) {
    const tactile::TactilePlan tactile = tactile::make_tactile_plan(scene, plan);
    if (!tactile.arm || tactile.options.arm->impedance != scene::ArmImpedance::low) return std::nullopt;
    const devices::ArmDevice& arm = *tactile.arm;
    const auto press = tactile::slow_strokes(arm.lowest_m, arm.deepest_m);
    const auto rig = tactile::virtual_rig(
        devices::simulators::make_arm_plant(devices::simulators::arm_parameters(seed), press, seed));
    tactile::StrokeOptions options;
    options.seconds = press.back().t_s;
    options.law = [](double) { return 0.0; };
    options.limits = devices::limits_of(&arm, nullptr, arm.force_N);
    return tactile::fit_compensation(tactile::run_strokes(options, *rig).rows).compensation;
}

}  // namespace palpa::session
