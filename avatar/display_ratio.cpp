#include "avatar/display_ratio.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpa::avatar {
namespace {

// w of the header.
double resistance(const DisplayRatio& law, double df_N) {
    const double x = std::max(df_N, 0.0);
    return x / (law.f_0_N + x);
}

// Returns the share of the lag that is left after the pen has stood still for still_s.
double left_after(const DisplayRatio& law, double still_s) {
    return still_s > law.hold_s ? std::exp(-(still_s - law.hold_s) / law.pause_decay_s) : 1.0;
}

// Moves the lag towards cap * u, exactly for a constant w, and then releases.
void drag(const DisplayRatio& law, const Pull& pull, Eigen::Vector2d& lag_m) {
    const double w = resistance(law, pull.df_N);
    if (w > 0.0 && law.cap_m) {
        const Eigen::Vector2d full_m = *law.cap_m * pull.u;
        lag_m = full_m + (lag_m - full_m) * std::exp(-w * pull.ds_m / *law.cap_m);
    } else {
        lag_m += w * pull.ds_m * pull.u;
    }
    const double b = std::clamp(1.0 - pull.df_N / law.gate_N, 0.0, 1.0);
    const double length_m = lag_m.norm();
    if (b > 0.0 && length_m > 0.0) lag_m *= std::max(0.0, 1.0 - law.release * b * pull.ds_m / length_m);
}

}  // namespace

DisplayRatio display_ratio_paper() {
    DisplayRatio law;
    law.f_0_N = 1.0;
    law.cap_m.reset();
    return law;
}

DisplayRatio display_ratio_clear() { return DisplayRatio{}; }

DisplayRatio display_ratio_strong() {
    DisplayRatio law;
    set_strength(4.0, law);
    law.cap_m = 8e-3;
    return law;
}

void set_strength(double strength, DisplayRatio& law) {
    assert(strength > 0.0);
    law.f_0_N = DisplayRatio{}.f_0_N / strength;
    law.gate_N = DisplayRatio{}.gate_N / strength;
}

double display_gain(const DisplayRatio& law, double df_N) { return 1.0 - resistance(law, df_N); }

void apply_pull(const DisplayRatio& law, const Pull& pull, DisplayRatioState& state) {
    if (pull.ds_m <= 0.0) return;
    state.lag_m *= left_after(law, pull.t_s - state.moved_s);
    drag(law, pull, state.lag_m);
    state.moved_s = pull.t_s;
}

Eigen::Vector2d lag_at(const DisplayRatio& law, const DisplayRatioState& state, const Pull& partial, double t_s) {
    Eigen::Vector2d lag_m = state.lag_m;
    if (partial.ds_m > 0.0) drag(law, partial, lag_m);
    return lag_m * left_after(law, t_s - state.moved_s);
}

double pause_factor(const DisplayRatio& law, const DisplayRatioState& state, double from_s, double to_s) {
    const double before = left_after(law, from_s - state.moved_s);
    return before > 0.0 ? std::min(1.0, left_after(law, to_s - state.moved_s) / before) : 0.0;
}

}  // namespace palpa::avatar
