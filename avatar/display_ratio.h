#pragma once
// Law R, display ratio: over a stiffer place the avatar moves less than the pen. Source: the touchpad version of Li et
// al. ("Pseudo-haptics for rigid tool / soft object interaction"), eq. (4).
//
// Per metre of path, with x = max(df, 0) and u the direction of motion, the lag l = pen - avatar obeys
//     dl/ds = w (u - l/cap) - c b(df) l/|l|,    w = x / (f_0 + x),    b = clamp(1 - df/df_on, 0, 1)
// so that, far below the cap, the avatar's gain is g = 1/(1 + x/f_0) = 1 - w while the force rises, as in the paper.
// The cap, the release (in the paper the avatar snaps back in one step), the gate and the decay in a pause are ours.
// The printed eq. (4) reads R_o/(f_i + 1) with the raw level f_i; it is read here as the force difference in newtons
// over f_0 = 1 N.

#include <optional>

#include "avatar/path.h"

namespace palpa::avatar {

struct DisplayRatio {
    double f_0_N = 0.02;
    std::optional<double> cap_m = 3e-3;  // absent: the lag is not bounded
    double release = 1.0;                // c, metres of lag given back per metre of path
    double gate_N = 2e-3;                // df_on: from this rise on nothing is released
    double hold_s = 0.15;                // T_hold: a resting pen keeps its lag for so long, then it decays
    double pause_decay_s = 0.1;          // tau_p, time constant of that decay
    PathParameters path;
};

DisplayRatio display_ratio_paper();   // f_0 = 1 N, no cap: a lag of at most one pixel on common screens
DisplayRatio display_ratio_clear();   // f_0 = 0.02 N, cap 3 mm: a visible lag
DisplayRatio display_ratio_strong();  // strength 4, cap 8 mm: a lag that people see unasked

// Makes the law answer as if every force were `strength` times as large: f_0 = 0.02 N / strength, and the gate, 2 mN /
// strength, follows, since otherwise all that a small rise adds would be released at once. 1 is `clear`. `strength` must
// be > 0 (assert): a law of strength 0 is no law.
void set_strength(double strength, DisplayRatio& law);

struct DisplayRatioState {
    PathState path;
    Eigen::Vector2d lag_m = Eigen::Vector2d::Zero();  // committed at stations only
    double moved_s = 0.0;                             // time of the last station with ds > 0
};

// Returns the avatar's gain along the motion without a cap, 1 - w, for a rise of df_N. Source: eq. (4) as read above.
double display_gain(const DisplayRatio& law, double df_N);

// Commits one station; a pull inside the dead band (ds = 0) changes nothing.
void apply_pull(const DisplayRatio& law, const Pull& pull, DisplayRatioState& state);

// Returns the lag at time t_s, in metres: that of the last station, and on top of it the pull of the piece of path from
// there to the pen, which is not committed.
Eigen::Vector2d lag_at(const DisplayRatio& law, const DisplayRatioState& state, const Pull& partial, double t_s);

// Returns the share, 0 ... 1, that is left at `to_s` of the lag shown at `from_s`, if the pen has not moved in between.
double pause_factor(const DisplayRatio& law, const DisplayRatioState& state, double from_s, double to_s);

// Goes to the sample and returns the lag there, in metres. `rise_N` as for pull_rope() (path.h). When the pen is lifted
// or jumps (is_teleport), the lag is 0 at once.
template <class Rise>
Eigen::Vector2d advance_lag(const DisplayRatio& law, const Touch& pen, const Rise& rise_N, DisplayRatioState& state,
                            const StationLimit& limit = {}) {
    const auto at_station = [&](const Pull& pull) { apply_pull(law, pull, state); };
    const PathEvent event = walk_to(law.path, limit, pen, rise_N, at_station, state.path);
    if (event == PathEvent::lifted || event == PathEvent::started) {
        state.lag_m.setZero();
        state.moved_s = pen.t_s;
        return state.lag_m;
    }
    const Touch& last = state.path.last;
    if (!last.down) return state.lag_m;
    Eigen::Vector2d rope_m = state.path.rope_m;
    const Pull partial = pull_rope(law.path, last, rise_N, rope_m);
    return lag_at(law, state, partial, last.t_s);
}

}  // namespace palpa::avatar
