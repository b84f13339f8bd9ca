#include "tangible/stages.h"

#include <algorithm>

#include "files/clock.h"
#include "files/quantile.h"
#include "files/text.h"
#include "tangible/characterise.h"
#include "tangible/loop.h"

namespace palpa::tangible {
namespace {

using files::short_number;

const char* steps_of(Fidelity fidelity) {
    switch (fidelity) {
        case Fidelity::step:
            return "one Newton step a tick";
        case Fidelity::converged:
            return "Newton steps until nothing changes";
        case Fidelity::stale:
            return "corrections with the factor of an earlier tick";
        case Fidelity::linear:
            return "the linear model about the pretension";
    }
    return "";
}

// Rendered force of the shipped strip and accordion, in per cent of the greatest wanted one (docs/performance.md).
const char* error_of(Fidelity fidelity) {
    switch (fidelity) {
        case Fidelity::step:
            return "0.0003 % (strip), 0.0015 % (accordion) of the force against 'converged'";
        case Fidelity::converged:
            return "that of the device's mesh, and of what its file does not know (palpa tangible characterise)";
        case Fidelity::stale:
            return "0.05 % (strip), 0.13 % (accordion) of the force against 'converged'";
        case Fidelity::linear:
            return "2.9 % (strip), 6.8 % (accordion) of the force against 'converged'";
    }
    return "";
}

scene::StageText world_stage(const TangiblePlan& plan, double world_us) {
    std::string fidelity = "the tissue's force at the finger's depth";
    if (plan.world.depth_scale != 1.0) fidelity += " times " + short_number(plan.world.depth_scale);
    if (plan.world.force_N_per_N != 1.0) fidelity += ", times " + short_number(plan.world.force_N_per_N);
    fidelity += plan.place_follows ? "; where the pen touches" : "; at one place";
    return {"world", "tick", fidelity, "that of the tissue's depth", world_us};
}

scene::StageText inverse_stage(const TangiblePlan& plan, double inverse_us) {
    const Fidelity fidelity = plan.loop.inverse.fidelity;
    const std::string text = std::string(kFidelityNames[static_cast<std::size_t>(fidelity)]) + ": " +
                             steps_of(fidelity) + ", " + std::to_string(plan.model->equations()) +
                             " equations; commanded by " + std::string(name_of(plan.loop.command)) + ", " +
                             short_number(plan.loop.rate_Hz) + " Hz";
    return {"inverse", "tick", text, error_of(fidelity), inverse_us};
}

}  // namespace

std::vector<scene::StageText> stages_of(const TangiblePlan& plan, const TickCost& cost) {
    std::vector<scene::StageText> out{world_stage(plan, cost.world_us),
                                      inverse_stage(plan, cost.tick_us - cost.world_us)};
    const DeviceFit& fit = plan.model->device.fit;
    if (plan.loop.compensate_friction && fit.friction_share > 0.0)
        out.push_back({"friction", "tick",
                       short_number(100.0 * fit.friction_share) + " % of a cable's tension, undone by its motion",
                       "that of the fit", 0.0});
    if (plan.loop.compensate_lag && fit.lag_s > 0.0)
        out.push_back({"lag", "tick", "drives that lag by " + short_number(1e3 * fit.lag_s) + " ms, undone",
                       "exact for a first-order lag, within bounds and rates", 0.0});
    out.push_back({"guard", "tick", "limits, slew, silence, stop: between the loop and the wire", "exact", 0.1});
    return out;
}

TickCost tick_cost(const TangiblePlan& plan) {
    PressMotion motion;
    motion.depth_m = plan.greatest_m > 0.0 ? std::min(3e-3, 0.5 * plan.greatest_m) : 3e-3;
    TangibleState state = make_tangible_state(plan);
    scene::TissueWork work = scene::make_work(*plan.world.tissue);
    std::vector<double> tick_us, world_us;
    const int ticks = static_cast<int>(press_time_s(motion) * plan.loop.rate_Hz);
    for (int tick = 0; tick < ticks; ++tick) {
        TangibleInput in;
        in.time_s = tick / plan.loop.rate_Hz;
        const double depth_m = press_depth_m(motion, in.time_s);
        in.feedback.sensor_m = depth_m + plan.model->device.fit.zero_m;
        in.feedback.sensor_s = in.time_s;
        in.feedback.has_sensor = 1.0;
        const std::int64_t began_ns = files::steady_ns();
        tangible_tick(plan, in, state);
        const std::int64_t between_ns = files::steady_ns();
        world_force(plan.world, plan.place_m, depth_m, work);
        tick_us.push_back(1e-3 * static_cast<double>(between_ns - began_ns));
        world_us.push_back(1e-3 * static_cast<double>(files::steady_ns() - between_ns));
    }
    if (tick_us.empty()) return {};
    constexpr auto kMedian = files::QuantileType::reached;
    return {files::quantile(tick_us, 0.5, kMedian), files::quantile(world_us, 0.5, kMedian)};
}

}  // namespace palpa::tangible
