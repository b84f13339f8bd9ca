#include "tangible/run_figures.h"

#include <algorithm>
#include <cmath>

namespace palpa::tangible {

void add(const TangibleCommand& tick, double rendered_N, TickFigures& figures) {
    ++figures.ticks;
    figures.pressed_ticks += tick.pressed;
    figures.saturated_ticks += tick.saturated;
    figures.rate_limited_ticks += tick.rate_limited;
    figures.held_ticks += tick.held;
    figures.relaxed_ticks += tick.relaxed;
    if (tick.fault != figures.last && tick.fault != TickFault::none)
        ++figures.faults[static_cast<std::size_t>(tick.fault)];
    figures.last = tick.fault;
    figures.greatest_wanted_N = std::max(figures.greatest_wanted_N, tick.wanted_N);
    if (!std::isfinite(rendered_N) || !tick.pressed) return;  // else the figure would say how long nobody pressed
    ++figures.compared_ticks;
    figures.squares_N2 += (rendered_N - tick.wanted_N) * (rendered_N - tick.wanted_N);
}

double force_rms_percent(const TickFigures& figures) {
    if (figures.compared_ticks == 0 || !(figures.greatest_wanted_N > 0.0))
        return std::numeric_limits<double>::quiet_NaN();
    return 100.0 * std::sqrt(figures.squares_N2 / static_cast<double>(figures.compared_ticks)) /
           figures.greatest_wanted_N;
}

files::Json figures_json(const TangiblePlan& plan, const TickFigures& ticks, const ClockFigures& clock) {
    const double period_ms = 1e3 / plan.loop.rate_Hz;
    files::Json json;
    json["device"] = plan.model->device.name;
    json["fidelity"] = kFidelityNames[static_cast<std::size_t>(plan.loop.inverse.fidelity)];
    json["command"] = name_of(plan.loop.command);
    json["rate_Hz"] = plan.loop.rate_Hz;
    json["ticks"] = ticks.ticks;
    json["missed_ticks"] = clock.missed_ticks;
    json["period_us"] = {{"p50", files::number_or_null(clock.period_p50_us)},
                         {"p99", files::number_or_null(clock.period_p99_us)},
                         {"worst", files::number_or_null(clock.period_worst_us)}};
    json["tick_us"] = {{"p50", files::number_or_null(clock.tick_p50_us)},
                       {"p99", files::number_or_null(clock.tick_p99_us)}};
    json["force_rms_percent"] = files::number_or_null(force_rms_percent(ticks));
    const auto share = [&](std::int64_t some) {
        return static_cast<double>(some) / static_cast<double>(std::max<std::int64_t>(ticks.ticks, 1));
    };
    json["saturated_share"] = share(ticks.saturated_ticks);
    json["rate_limited_share"] = share(ticks.rate_limited_ticks);
    json["held_ms"] = period_ms * static_cast<double>(ticks.held_ticks);
    json["relaxed_ms"] = period_ms * static_cast<double>(ticks.relaxed_ticks);
    files::Json faults = files::Json::array();
    for (std::size_t i = 1; i < kTickFaults; ++i) {
        if (ticks.faults[i] > 0)
            faults.push_back({{"fault", text_of(static_cast<TickFault>(i))}, {"times", ticks.faults[i]}});
    }
    json["faults"] = faults;
    json["notes"] = plan.notes;
    return json;
}

}  // namespace palpa::tangible
