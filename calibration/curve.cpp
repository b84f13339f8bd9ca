#include "calibration/curve.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace palpa::calibration {
namespace {

// Returns the slope at the first or the last knot, from the two chords next to it (h: their widths, d: their slopes).
double end_slope(double h0, double h1, double d0, double d1) {
    const double three_point = ((2.0 * h0 + h1) * d0 - h0 * d1) / (h0 + h1);
    return std::clamp(three_point, 0.1 * d0, 3.0 * d0);
}

std::size_t piece_of(const std::vector<double>& rising, double value) {
    const auto above = std::upper_bound(rising.begin() + 1, rising.end() - 1, value);
    return static_cast<std::size_t>(above - rising.begin()) - 1;
}

// One cubic piece on t = 0 ... 1, as a polynomial.
struct Piece {
    double c0, c1, c2, c3;
    double width;
    double value(double t) const { return c0 + t * (c1 + t * (c2 + t * c3)); }
    double slope(double t) const { return c1 + t * (2.0 * c2 + t * 3.0 * c3); }
};

Piece piece(const Curve& curve, std::size_t i) {
    const double h = curve.knot_level[i + 1] - curve.knot_level[i];
    const double rise = curve.knot_N[i + 1] - curve.knot_N[i];
    const double m0 = h * curve.knot_N_per_level[i];
    const double m1 = h * curve.knot_N_per_level[i + 1];
    return {curve.knot_N[i], m0, 3.0 * rise - 2.0 * m0 - m1, m0 + m1 - 2.0 * rise, h};
}

double cubic_value_N(const Curve& curve, double level) {
    const double first = curve.knot_level.front();
    const double last = curve.knot_level.back();
    if (level < first) {
        const double F = curve.knot_N.front();
        return F * std::exp(curve.knot_N_per_level.front() / F * (level - first));
    }
    if (level > last) return curve.knot_N.back() + curve.knot_N_per_level.back() * (level - last);
    const std::size_t i = piece_of(curve.knot_level, level);
    const Piece p = piece(curve, i);
    return p.value((level - curve.knot_level[i]) / p.width);
}

double cubic_slope(const Curve& curve, double level) {
    const double first = curve.knot_level.front();
    if (level < first) return cubic_value_N(curve, level) * curve.knot_N_per_level.front() / curve.knot_N.front();
    if (level > curve.knot_level.back()) return curve.knot_N_per_level.back();
    const std::size_t i = piece_of(curve.knot_level, level);
    const Piece p = piece(curve, i);
    return p.slope((level - curve.knot_level[i]) / p.width) / p.width;
}

double cubic_level(const Curve& curve, double force_N) {
    if (force_N < curve.knot_N.front()) {
        const double F = curve.knot_N.front();
        return curve.knot_level.front() + std::log(force_N / F) * F / curve.knot_N_per_level.front();
    }
    if (force_N > curve.knot_N.back()) {
        return curve.knot_level.back() + (force_N - curve.knot_N.back()) / curve.knot_N_per_level.back();
    }
    // Newton's method inside a shrinking bracket; the piece rises, so the root stays in it
    const std::size_t i = piece_of(curve.knot_N, force_N);
    const Piece p = piece(curve, i);
    double low = 0.0;
    double high = 1.0;
    double t = (force_N - curve.knot_N[i]) / (curve.knot_N[i + 1] - curve.knot_N[i]);
    for (int step = 0; step < 60; ++step) {
        const double over = p.value(t) - force_N;
        (over > 0.0 ? high : low) = t;
        double next = t - over / p.slope(t);
        if (!(next > low && next < high)) next = 0.5 * (low + high);
        if (std::abs(next - t) < 1e-15 || over == 0.0) break;
        t = next;
    }
    return curve.knot_level[i] + t * p.width;
}

}  // namespace

Curve monotone_cubic(std::vector<double> level, std::vector<double> force_N) {
    const std::size_t n = level.size();
    assert(n >= 2 && force_N.size() == n && force_N.front() > 0.0);
    std::vector<double> h(n - 1);
    std::vector<double> d(n - 1);
    for (std::size_t i = 0; i + 1 < n; ++i) {
        h[i] = level[i + 1] - level[i];
        d[i] = (force_N[i + 1] - force_N[i]) / h[i];
        assert(h[i] > 0.0 && d[i] > 0.0);
    }
    Curve curve;
    curve.model = CurveModel::monotone_cubic;
    curve.knot_N_per_level.assign(n, d.front());
    if (n > 2) {
        curve.knot_N_per_level.front() = end_slope(h[0], h[1], d[0], d[1]);
        curve.knot_N_per_level.back() = end_slope(h[n - 2], h[n - 3], d[n - 2], d[n - 3]);
    }
    for (std::size_t i = 1; i + 1 < n; ++i) {
        const double w0 = 2.0 * h[i] + h[i - 1];
        const double w1 = h[i] + 2.0 * h[i - 1];
        curve.knot_N_per_level[i] = (w0 + w1) / (w0 / d[i - 1] + w1 / d[i]);
    }
    curve.knot_level = std::move(level);
    curve.knot_N = std::move(force_N);
    return curve;
}

double value_N(const Curve& curve, double level) {
    switch (curve.model) {
        case CurveModel::exponential:
            return curve.a_N * std::exp(curve.b * level);
        case CurveModel::exponential_offset:
            return curve.offset_N + curve.a_N * std::exp(curve.b * level);
        case CurveModel::power:
            return level > 0.0 ? curve.a_N * std::pow(level, curve.b) : 0.0;
        case CurveModel::monotone_cubic:
            return cubic_value_N(curve, level);
    }
    return 0.0;
}

double slope_N_per_level(const Curve& curve, double level) {
    switch (curve.model) {
        case CurveModel::exponential:
        case CurveModel::exponential_offset:
            return curve.a_N * curve.b * std::exp(curve.b * level);
        case CurveModel::power:
            return level > 0.0 ? curve.a_N * curve.b * std::pow(level, curve.b - 1.0) : 0.0;
        case CurveModel::monotone_cubic:
            return cubic_slope(curve, level);
    }
    return 0.0;
}

double level_at(const Curve& curve, double force_N) {
    const double above_N = force_N - curve.offset_N;  // offset_N is 0 for the other models
    switch (curve.model) {
        case CurveModel::exponential:
            return force_N > 0.0 ? std::log(force_N / curve.a_N) / curve.b : -kInfinity;
        case CurveModel::exponential_offset:
            if (above_N / curve.a_N > 0.0) return std::log(above_N / curve.a_N) / curve.b;
            return curve.b > 0.0 ? -kInfinity : kInfinity;
        case CurveModel::power:
            return force_N > 0.0 ? std::pow(force_N / curve.a_N, 1.0 / curve.b) : 0.0;
        case CurveModel::monotone_cubic:
            return force_N > 0.0 ? cubic_level(curve, force_N) : -kInfinity;
    }
    return 0.0;
}

std::string_view name_of(CurveModel model) {
    switch (model) {
        case CurveModel::exponential:
            return "exponential";
        case CurveModel::exponential_offset:
            return "exponential_offset";
        case CurveModel::power:
            return "power";
        case CurveModel::monotone_cubic:
            return "monotone_cubic";
    }
    return "exponential";
}

}  // namespace palpa::calibration
