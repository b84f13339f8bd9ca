#pragma once
// Law D, delay: over a stiffer place the avatar is drawn where the pen was a time tau ago. Source: the tablet version
// of Li et al. ("Pseudo-haptics for rigid tool / soft object interaction"), eq. (6) of the time delay, t_d = m df with
// m = 500. The paper gives no unit for m; it is read as ms/N.
//
//     goal = min(cap, m max(df, 0));   dtau/dt = +rise while tau < goal, -fall while tau > goal
//     a(t) = p(t - tau(t)),  p linear in time between the samples
//
// Since rise < 1, t - tau never decreases: the avatar never runs back in time. The limited slew rates (rise, fall), the
// cap and the hold are ours. The paper instead adds t_d to the frame interval, which feeds back, as a longer interval
// makes the next df larger; here the frame loop is never blocked.

#include <vector>

#include "avatar/path.h"

namespace palpa::avatar {

struct Delay {
    double m_s_per_N = 3.0;  // m, delay per newton of rise
    double cap_s = 0.15;     // greatest delay
    double rise = 0.8;       // seconds of delay gained per second
    double fall = 1.0;       // seconds of delay given back per second
    double hold_s = 0.15;    // the goal falls to 0 after this long without a station
    PathParameters path;
};

Delay delay_paper();   // m = 500 ms/N: a delay of about one frame, which is not visible
Delay delay_clear();   // m = 3000 ms/N: the delay that the paper's blocked frame loop probably showed
Delay delay_strong();  // strength 4, so m = 12,000 ms/N, cap 400 ms: a delay that people see unasked

// Sets m = 3000 ms/N * strength; 1 is `clear`. `strength` must be > 0 (assert): a law of strength 0 is no law.
void set_strength(double strength, Delay& law);

struct DelayState {
    PathState path;
    double tau_s = 0.0;      // tau at the last station with ds > 0
    double station_s = 0.0;  // time of that station
    double goal_s = 0.0;     // the goal that it set
    // Ring of the samples since pen-down, for p(t - tau). At 1,000 Hz, 1,024 entries cover the default cap_s six times.
    std::vector<Touch> ring = std::vector<Touch>(1024);
    std::size_t count = 0;  // samples put in since pen-down
};

// Returns tau at time t_s, in seconds.
double delay_at(const Delay& law, const DelayState& state, double t_s);

// Returns the pen's position at time t_s: before pen-down the pen-down point, after the last sample the last sample's
// position. Needs at least one sample in the ring.
Eigen::Vector2d position_at(const DelayState& state, double t_s);

// Commits one station; a pull inside the dead band (ds = 0) changes nothing.
void apply_pull(const Delay& law, const Pull& pull, DelayState& state);

// Puts a sample into the ring; `started`: it is the first one since pen-down.
void remember(const Touch& pen, bool started, DelayState& state);

struct Delayed {
    Eigen::Vector2d lag_m = Eigen::Vector2d::Zero();  // pen - avatar
    double tau_s = 0.0;                               // the delay that causes the lag
};

// Returns lag and delay at a time after the last sample, so that the avatar moves between samples as well.
Delayed delayed_at(const Delay& law, const DelayState& state, double t_s);

// Goes to the sample and returns lag and delay there. `rise_N` as for pull_rope() (path.h). When the pen is lifted or
// jumps (is_teleport), both are 0 at once.
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
