#pragma once
// Test tissues and pen strokes shared by the tests of both laws.

#include <Eigen/Core>
#include <cmath>
#include <vector>

#include "avatar/path.h"

namespace palpa::test {

inline constexpr double kSpeed_m_per_s = 0.03;

// T: f = max(0, 0.3 N (1 - |x| / 5 mm)) in every direction, at every depth.
inline double tent_N(const Eigen::Vector2d& p, const Eigen::Vector2d&) {
    return std::max(0.0, 0.3 * (1.0 - std::abs(p.x()) / 5e-3));
}

// B: energy E0 exp(-r^2 / (2 w^2)), w = 2.5 mm; its slope peaks at 0.3 N; f = max(u . grad E, 0).
inline double bump_N(const Eigen::Vector2d& p, const Eigen::Vector2d& u) {
    constexpr double w = 2.5e-3;
    const double energy_J = 0.3 * w * std::sqrt(std::exp(1.0)) * std::exp(-p.squaredNorm() / (2.0 * w * w));
    return std::max(0.0, -energy_J / (w * w) * u.dot(p));
}

template <class Force>
auto rise_of(Force force_N) {
    return [force_N](const Eigen::Vector2d& e, const Eigen::Vector2d& u, double, double reference_m) {
        return force_N(e, u) - force_N(e - reference_m * u, u);
    };
}

inline avatar::Touch touch_at(double t_s, double x_m, double y_m = 0.0) { return {t_s, {x_m, y_m}, 1.0, true}; }

// Pen down at x = -15 mm, along +x at 30 mm/s with a sample every 1/rate and one exactly at `to_m`.
inline std::vector<avatar::Touch> stroke(double rate_Hz, double to_m, double speed_m_per_s = kSpeed_m_per_s) {
    const double from_m = -15e-3;
    std::vector<avatar::Touch> out;
    const double end_s = (to_m - from_m) / speed_m_per_s;
    for (int i = 0; i / rate_Hz < end_s; ++i) {
        out.push_back(touch_at(i / rate_Hz, from_m + speed_m_per_s * i / rate_Hz));
    }
    out.push_back(touch_at(end_s, to_m));
    return out;
}

}  // namespace palpa::test
