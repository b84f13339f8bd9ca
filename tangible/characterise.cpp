#include "tangible/characterise.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "files/clock.h"
#include "tangible/linearised.h"

namespace palpa::tangible {
namespace {

// The rendered force at a depth, linear between ticks of one way; NaN outside.
double rendered_at_N(const std::vector<PressTick>& ticks, std::size_t first, std::size_t last, double depth_m) {
    for (std::size_t i = first + 1; i < last; ++i) {
        const double a = ticks[i - 1].depth_m;
        const double b = ticks[i].depth_m;
        if (a == b || (depth_m - a) * (depth_m - b) > 0.0) continue;
        const double share = (depth_m - a) / (b - a);
        return ticks[i - 1].rendered_N + share * (ticks[i].rendered_N - ticks[i - 1].rendered_N);
    }
    return std::numeric_limits<double>::quiet_NaN();
}

double hysteresis_N(const std::vector<PressTick>& ticks) {
    const auto deepest = std::max_element(ticks.begin(), ticks.end(),
                                          [](const PressTick& a, const PressTick& b) { return a.depth_m < b.depth_m; });
    if (deepest == ticks.end()) return 0.0;
    const auto turn = static_cast<std::size_t>(deepest - ticks.begin());
    constexpr int kDepths = 40;
    double sum_N = 0.0;
    int n = 0;
    for (int k = 1; k < kDepths; ++k) {
        const double depth_m = deepest->depth_m * k / kDepths;
        const double apart_N =
            rendered_at_N(ticks, 0, turn + 1, depth_m) - rendered_at_N(ticks, turn, ticks.size(), depth_m);
        if (!std::isfinite(apart_N)) continue;
        sum_N += apart_N;
        ++n;
    }
    return n > 0 ? sum_N / n : 0.0;
}

// For each unknown whether the finger at this depth feels more force when it grows: dF/da at a held depth, summed over what is
// tied to it.
std::array<bool, kMostActuators> which_stiffen(const TangiblePlan& plan, double depth_m) {
    const DeviceModel& model = *plan.model;
    DeviceState state = plan.start;
    press_to_depth(model, state, plan.start.actuation, depth_m);
    std::array<bool, kMostActuators> out{};
    if (!factor_tangent(model, state)) return out;
    const Response response = respond(model, state);
    std::array<double, kMostActuators> sum{};
    for (std::size_t j = 0; j < model.actuators.size(); ++j)
        sum[static_cast<std::size_t>(model.driver[j])] -= response.compliance(0, static_cast<Eigen::Index>(1 + j));
    std::transform(sum.begin(), sum.end(), out.begin(), [](double slope) { return slope > 0.0; });
    return out;
}

}  // namespace

double press_time_s(const PressMotion& motion) { return 2.0 * motion.depth_m / motion.speed_m_per_s; }

double press_depth_m(const PressMotion& motion, double time_s) {
    const double way_s = 0.5 * press_time_s(motion);
    const double s = std::clamp(time_s <= way_s ? time_s / way_s : 2.0 - time_s / way_s, 0.0, 1.0);
    return motion.depth_m * s * s * s * (10.0 + s * (-15.0 + 6.0 * s));
}

PressFigures figures_of(std::vector<PressTick> ticks) {
    PressFigures out;
    out.ticks = std::move(ticks);
    double greatest_N = 0.0, sum_N2 = 0.0, worst_N = 0.0, depth2 = 0.0, wanted = 0.0, rendered = 0.0;
    for (const PressTick& tick : out.ticks) {
        const double off_N = tick.rendered_N - tick.wanted_N;
        greatest_N = std::max(greatest_N, tick.wanted_N);
        worst_N = std::max(worst_N, std::abs(off_N));
        sum_N2 += off_N * off_N;
        depth2 += tick.depth_m * tick.depth_m;
        wanted += tick.depth_m * tick.wanted_N;
        rendered += tick.depth_m * tick.rendered_N;
        out.saturated_share += tick.command.saturated ? 1.0 : 0.0;
        out.rate_limited_share += tick.command.rate_limited ? 1.0 : 0.0;
        out.failed_ticks += tick.command.fault != TickFault::none ? 1 : 0;
    }
    if (out.ticks.empty()) return out;
    const auto n = static_cast<double>(out.ticks.size());
    out.saturated_share /= n;
    out.rate_limited_share /= n;
    out.failed_share = out.failed_ticks / n;
    if (depth2 > 0.0) {
        out.wanted_N_per_m = wanted / depth2;
        out.rendered_N_per_m = rendered / depth2;
    }
    if (greatest_N > 0.0) {
        out.force_rms_percent = 100.0 * std::sqrt(sum_N2 / n) / greatest_N;
        out.force_worst_percent = 100.0 * worst_N / greatest_N;
    }
    out.hysteresis_N = hysteresis_N(out.ticks);
    return out;
}

PressFigures run_press(const TangiblePlan& plan, const Plant& plant, const PressMotion& motion, std::uint64_t seed,
                       const std::function<void(double share)>& progress) {
    TangibleState loop = make_tangible_state(plan);
    PlantState body = make_plant_state(plant, plan, seed);
    scene::TissueWork truth = scene::make_work(*plan.world.tissue);
    const double period_s = 1.0 / plan.loop.rate_Hz;
    const auto ticks = static_cast<int>(std::lround(press_time_s(motion) / period_s));
    std::vector<PressTick> rows;
    std::vector<double> tick_us;
    for (int k = 0; k <= ticks; ++k) {
        PressTick row;
        row.time_s = period_s * k;
        row.depth_m = press_depth_m(motion, row.time_s);
        place_finger(row.time_s, row.depth_m, body);
        TangibleInput in;
        in.time_s = row.time_s;
        in.feedback = read_plant_sensor(plant, row.time_s, body);
        const std::int64_t before_ns = files::steady_ns();
        row.command = tangible_tick(plan, in, loop);
        tick_us.push_back(1e-3 * static_cast<double>(files::steady_ns() - before_ns));
        row.wanted_N = world_force(plan.world, plan.place_m, row.depth_m, truth).force_N;
        const PlantAnswer answer = step_plant(plant, row.command, body);
        row.rendered_N = answer.force_N;
        if (answer.status != DeviceStatus::good && answer.status != DeviceStatus::unstable &&
            row.command.fault == TickFault::none)
            row.command.fault = TickFault::no_equilibrium;
        rows.push_back(row);
        if (progress) progress(static_cast<double>(k + 1) / (ticks + 1));
    }
    PressFigures out = figures_of(std::move(rows));
    out.tick_us = std::move(tick_us);
    return out;
}

Reach reach_at(const TangiblePlan& plan, double depth_m) {
    constexpr int kSteps = 8;  // on the way from the pretension to an end; the last equilibrium counts
    const DeviceModel& model = *plan.model;
    Reach reach{depth_m, std::numeric_limits<double>::infinity(), 0.0};
    const std::array<bool, kMostActuators> stiffens = which_stiffen(plan, depth_m);
    for (const bool stiff : {true, false}) {
        DeviceState state = plan.start;
        for (int step = 0; step <= kSteps; ++step) {
            Actuation actuation{};
            for (std::size_t j = 0; j < model.actuators.size(); ++j) {
                const bool up = stiffens[static_cast<std::size_t>(model.driver[j])] == stiff;
                const double end = up ? model.actuators[j].upper : model.actuators[j].lower;
                actuation[j] = plan.start.actuation[j] + step * (end - plan.start.actuation[j]) / kSteps;
            }
            const ForwardAnswer answer = press_to_depth(model, state, actuation, depth_m);
            if (answer.status != DeviceStatus::good && answer.status != DeviceStatus::unstable) break;
            const double stiffness = std::max(0.0, answer.force_N) / depth_m;
            reach.lowest_N_per_m = std::min(reach.lowest_N_per_m, stiffness);
            reach.highest_N_per_m = std::max(reach.highest_N_per_m, stiffness);
        }
    }
    if (!(reach.lowest_N_per_m <= reach.highest_N_per_m)) reach.lowest_N_per_m = reach.highest_N_per_m;
    return reach;
}

}  // namespace palpa::tangible
