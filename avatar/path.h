#pragma once
// The pen's path with stations at equal distances, so that the avatar depends on the line that was drawn and not on how
// often it was sampled.
//
// Both laws of Li et al. ("Pseudo-haptics for rigid tool / soft object interaction") compare the tangential force now
// with that of the sample before, so that as printed their effect depends on the sampling rate. Here the difference is
// taken over a fixed distance, at stations every `station_m` of arc length. The stations, and the dead band ("rope")
// against jitter, are ours.

#include <Eigen/Core>
#include <algorithm>
#include <cmath>
#include <cstdint>
#include <limits>

namespace palpa::avatar {

struct PathParameters {
    double station_m = 5e-5;    // converged: with 0.01 mm instead of 0.05 mm the lag changes by less than 2e-4 mm
    double dead_band_m = 2e-4;  // absorbs 0.02 mm rms of jitter at 1,000 Hz
    double reference_m = 3e-4;  // s_ref: 30 mm/s at 100 Hz, as in the paper's recording
};

// A calibrated sample: time, position on the tissue, normal force.
struct Touch {
    double t_s = 0.0;
    Eigen::Vector2d p_m = Eigen::Vector2d::Zero();
    double force_N = 0.0;
    bool down = false;
};

// At how many stations one sample may ask the tissue, where an answer is expensive. Their number follows from the time
// since the sample before, so that a stroke slower than per_s * station_m loses none at any sampling rate from
// per_s / most upwards.
struct StationLimit {
    double per_s = std::numeric_limits<double>::infinity();
    int least = 4;                               // allowed in any case, since samples of a burst are close in time
    int most = std::numeric_limits<int>::max();  // allowed for one sample
};

// Returns how many of the `due` stations since the sample before, dt_s ago, are allowed.
inline std::int64_t allowed_stations(const StationLimit& limit, double dt_s, std::int64_t due) {
    if (due <= limit.least) return due;
    const double by_time = std::isinf(limit.per_s) ? limit.per_s : limit.per_s * dt_s;  // 0 * infinity is no number
    const double allowed = std::max(by_time, static_cast<double>(limit.least));
    return std::min({due, static_cast<std::int64_t>(std::min(allowed, 1e15)), static_cast<std::int64_t>(limit.most)});
}

struct PathState {
    Touch last{-std::numeric_limits<double>::infinity(), Eigen::Vector2d::Zero(), 0.0, false};
    double carry_m = 0.0;                              // arc length since the last station
    Eigen::Vector2d rope_m = Eigen::Vector2d::Zero();  // the end of the rope that is dragged along
    std::int64_t ignored = 0;                          // samples that were not finite, or went back in time
    std::int64_t skipped_stations = 0;                 // left out because of StationLimit
};

// What one piece of path does to the rope.
struct Pull {
    double t_s = 0.0;
    Eigen::Vector2d u = Eigen::Vector2d::Zero();  // direction of motion, length 1; 0 inside the dead band
    double ds_m = 0.0;                            // how far the end of the rope is dragged
    double df_N = 0.0;                            // rise of the resisting force along u over reference_m
};

enum class PathEvent { ignored, lifted, started, moved };

// Drags the rope to the pen. `rise_N(e, u, force_N, reference_m)` asks the tissue for the rise of its resisting
// tangential force along u, f(e, u, d) - f(e - reference_m u, u, d), in newtons; both forces are taken at the depth d
// to which `force_N` presses at e.
template <class Rise>
Pull pull_rope(const PathParameters& path, const Touch& pen, const Rise& rise_N, Eigen::Vector2d& rope_m) {
    Pull pull;
    pull.t_s = pen.t_s;
    const Eigen::Vector2d v = pen.p_m - rope_m;
    const double length_m = v.norm();
    if (length_m <= path.dead_band_m) return pull;
    pull.u = v / length_m;
    pull.ds_m = length_m - path.dead_band_m;
    const Eigen::Vector2d tip_m = rope_m + pull.u * (0.5 * pull.ds_m + path.dead_band_m);
    pull.df_N = rise_N(tip_m, pull.u, pen.force_N, path.reference_m);
    rope_m += pull.u * pull.ds_m;
    return pull;
}

inline bool is_finite(const Touch& touch) {
    return std::isfinite(touch.t_s) && touch.p_m.allFinite() && std::isfinite(touch.force_N);
}

// Returns whether the pen jumped farther than a hand can move it: the device lost the pen and found it elsewhere.
inline bool is_teleport(const Touch& from, const Touch& to) {
    constexpr double kJump_m = 5e-3;
    constexpr double kFastest_m_per_s = 3.0;
    return (to.p_m - from.p_m).norm() > kJump_m + kFastest_m_per_s * (to.t_s - from.t_s);
}

// Walks the path to `pen` and hands the Pull of every station to `at_station`. Beyond the limit the stations are
// thinned out evenly: the last one stays, and those left out are counted. A sample that is not finite or goes back in
// time only changes `ignored`.
template <class Rise, class AtStation>
PathEvent walk_to(const PathParameters& path, const StationLimit& limit, const Touch& pen, const Rise& rise_N,
                  const AtStation& at_station, PathState& state) {
    if (!is_finite(pen) || pen.t_s < state.last.t_s) {
        ++state.ignored;
        return PathEvent::ignored;
    }
    const Touch from = state.last;
    state.last = pen;
    if (!pen.down) return PathEvent::lifted;
    if (!from.down || is_teleport(from, pen)) {
        state.carry_m = 0.0;
        state.rope_m = pen.p_m;
        return PathEvent::started;
    }
    const double length_m = (pen.p_m - from.p_m).norm();
    const double first_m = path.station_m - state.carry_m;
    std::int64_t due = 0;
    double at_m = first_m;
    for (; at_m <= length_m; at_m += path.station_m) ++due;
    const std::int64_t allowed = allowed_stations(limit, pen.t_s - from.t_s, due);
    state.skipped_stations += due - allowed;
    state.carry_m = length_m - (at_m - path.station_m);
    at_m = first_m;
    for (std::int64_t k = 1, taken = 0; k <= due; ++k, at_m += path.station_m) {
        if (k * allowed / due == taken) continue;  // takes the last of every due / allowed stations
        ++taken;
        const double s = at_m / length_m;
        Touch station;
        station.t_s = from.t_s + s * (pen.t_s - from.t_s);
        station.p_m = from.p_m + s * (pen.p_m - from.p_m);
        station.force_N = from.force_N + s * (pen.force_N - from.force_N);
        at_station(pull_rope(path, station, rise_N, state.rope_m));
    }
    return PathEvent::moved;
}

}  // namespace palpa::avatar
