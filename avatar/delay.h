#pragma once
// Law D: over a stiffer place the avatar is drawn where the pen was tau ago (tablet version of Li et al.,
// eq. 6, t_d = m df with m = 500, taken as ms/N).
//
//     goal = min(cap, m max(df, 0));   dtau/dt = +rise while tau < goal, -fall while tau > goal
//     a(t) = p(t - tau(t)),  p linear in time between the samples
//
// rise < 1, so t - tau never decreases: the avatar never runs back in time. Ours, not the paper's: slew, cap
// and hold; the paper adds t_d to the frame interval, which feeds back through the longer step. The frame
// loop is never blocked.

#include <vector>

#include "avatar/path.h"

namespace palpa::avatar {

struct Delay {
    double m_s_per_N = 3.0;
    double cap_s = 0.15;
    double rise = 0.8;     // seconds of delay gained per second
    double fall = 1.0;     // seconds of delay given back per second
    double hold_s = 0.15;  // the goal falls to 0 after this long without a station
    PathParameters path;
};

Delay delay_paper();  // m = 500 ms/N: about one frame, not visible
Delay delay_clear();  // m = 3000 ms/N: what the paper's blocked frame loop probably showed

struct DelayState {
    PathState path;
    double tau_s = 0.0;      // at the last station with ds > 0
    double station_s = 0.0;  // its time
    double goal_s = 0.0;
    // Ring of the samples since pen-down, for p(t - tau). 1,024 entries cover cap_s at 1,000 Hz six times.
    std::vector<Touch> ring = std::vector<Touch>(1024);
    std::size_t count = 0;  // samples put in since pen-down
};

double delay_at(const Delay& law, const DelayState& state, double t_s);

// The pen's position tau ago; before pen-down the pen-down point, after the last sample the last sample.
Eigen::Vector2d position_at(const DelayState& state, double t_s);

void apply_pull(const Delay& law, const Pull& pull, DelayState& state);
void remember(const Touch& pen, bool started, DelayState& state);

// What is shown: lag behind the pen (m) and the delay that caused it (s).
struct Delayed {
    Eigen::Vector2d lag_m = Eigen::Vector2d::Zero();
    double tau_s = 0.0;
};

// The same at a time after the last sample, between two of them; changes nothing.
Delayed delayed_at(const Delay& law, const DelayState& state, double t_s);

template <class Rise>
Delayed advance_lag(const Delay& law, const Touch& pen, const Rise& rise_N, DelayState& state,
                    const StationLimit& limit = {}) {
    const auto at_station = [&](const Pull& pull) { apply_pull(law, pull, state); };
    const PathEvent event = walk_to(law.path, limit, pen, rise_N, at_station, state.path);
    if (event == PathEvent::lifted || event == PathEvent::started) {
        state.tau_s = 0.0;
        state.goal_s = 0.0;
        state.station_s = pen.t_s;
        state.count = 0;
    }
    if (event == PathEvent::started || event == PathEvent::moved) remember(pen, event == PathEvent::started, state);
    return delayed_at(law, state, state.path.last.t_s);
}

}  // namespace palpa::avatar
