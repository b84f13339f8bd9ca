#include "avatar/delay.h"

#include <algorithm>
#include <cassert>

namespace palpa::avatar {
namespace {

// Returns tau after dt with a constant goal; exact for any dt.
double slew(const Delay& law, double tau_s, double goal_s, double dt_s) {
    return std::min(std::max(goal_s, tau_s - law.fall * dt_s), tau_s + law.rise * dt_s);
}

}  // namespace

Delay delay_paper() {
    Delay law;
    law.m_s_per_N = 0.5;
    return law;
}

Delay delay_clear() { return Delay{}; }

Delay delay_strong() {
    Delay law;
    set_strength(4.0, law);
    law.cap_s = 0.4;
    return law;
}

void set_strength(double strength, Delay& law) {
    assert(strength > 0.0);
    law.m_s_per_N = strength * Delay{}.m_s_per_N;
}

double delay_at(const Delay& law, const DelayState& state, double t_s) {
    const double since_s = std::max(0.0, t_s - state.station_s);
    const double held_s = std::min(since_s, law.hold_s);
    const double tau_s = slew(law, state.tau_s, state.goal_s, held_s);
    return slew(law, tau_s, 0.0, since_s - held_s);
}

void apply_pull(const Delay& law, const Pull& pull, DelayState& state) {
    if (pull.ds_m <= 0.0) return;
    state.tau_s = delay_at(law, state, pull.t_s);
    state.station_s = pull.t_s;
    state.goal_s = std::min(law.cap_s, law.m_s_per_N * std::max(pull.df_N, 0.0));
}

void remember(const Touch& pen, bool started, DelayState& state) {
    if (started) state.count = 0;
    state.ring[state.count % state.ring.size()] = pen;
    ++state.count;
}

Eigen::Vector2d position_at(const DelayState& state, double t_s) {
    const auto entry = [&](std::size_t i) -> const Touch& { return state.ring[i % state.ring.size()]; };
    const std::size_t first = state.count > state.ring.size() ? state.count - state.ring.size() : 0;
    std::size_t newer = state.count - 1;
    if (t_s >= entry(newer).t_s) return entry(newer).p_m;
    while (newer > first && entry(newer - 1).t_s > t_s) --newer;
    if (newer == first) return entry(first).p_m;
    const Touch& a = entry(newer - 1);
    const Touch& b = entry(newer);
    return a.p_m + (t_s - a.t_s) / (b.t_s - a.t_s) * (b.p_m - a.p_m);
}

Delayed delayed_at(const Delay& law, const DelayState& state, double t_s) {
    Delayed out;
    if (!state.path.last.down || state.count == 0) return out;
    out.tau_s = delay_at(law, state, t_s);
    out.lag_m = state.path.last.p_m - position_at(state, t_s - out.tau_s);
    return out;
}

}  // namespace palpa::avatar
