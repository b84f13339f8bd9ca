#include "stiffnessmaps/import/contact_height.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <numbers>

#include "stiffnessmaps/import/probing.h"
#include "stiffnessmaps/import/robust.h"

namespace palpa::stiffnessmaps {
namespace {

// Where a place touches for sure, and the force that its sensor shows in the air.
struct Touch {
    double air_N = 0.0;
    std::size_t first = 0;  // the first row above the threshold; the number of rows if there is none
};

double median_of_first(const ProbedPoint& p, std::size_t rows) {
    return median({p.force_N.begin(), p.force_N.begin() + static_cast<std::ptrdiff_t>(rows)});
}

Touch touch_of(const ProbedPoint& p, double threshold_N) {
    constexpr std::size_t kFewest = 3;
    const std::size_t n = p.force_N.size();
    Touch out{median_of_first(p, std::min(kFewest, n)), 0};
    const auto touches = [&](std::size_t i) { return p.force_N[i] - out.air_N >= threshold_N; };
    const auto first = [&] {
        std::size_t i = 0;
        while (i < n && !(touches(i) && (i + 1 == n || touches(i + 1)))) ++i;
        return i;
    };
    out.first = first();
    if (out.first < 2 * kFewest) return out;
    out.air_N = median_of_first(p, out.first / 2);  // the rows just before may touch already
    out.first = first();
    return out;
}

struct ContactFit {
    double contact_m = std::numeric_limits<double>::quiet_NaN();
    double cost_N2 = 0.0;  // sum of squared differences of the forces
};

// F^(1/n) is a line over depth; its weights are those of equal errors of F.
ContactFit contact_fit(const ProbedPoint& p, const Touch& touch, double threshold_N, double exponent) {
    constexpr double kWindow = 10.0;
    constexpr std::size_t kFewestRows = 4;
    double w = 0.0, wd = 0.0, wy = 0.0, wdd = 0.0, wdy = 0.0;
    std::vector<std::array<double, 2>> rows;  // depth from the first row, force
    for (std::size_t i = touch.first; i < p.force_N.size(); ++i) {
        const double force_N = p.force_N[i] - touch.air_N;
        if (force_N > kWindow * threshold_N && rows.size() >= kFewestRows) break;
        if (force_N < 0.5 * threshold_N) continue;
        const double d_m = p.depth_m[i] - p.depth_m[touch.first];
        const double y = std::pow(force_N, 1.0 / exponent);
        const double weight = std::pow(exponent * std::pow(force_N, 1.0 - 1.0 / exponent), 2);
        rows.push_back({d_m, force_N});
        w += weight;
        wd += weight * d_m;
        wy += weight * y;
        wdd += weight * d_m * d_m;
        wdy += weight * d_m * y;
    }
    ContactFit out;
    const double slope = (w * wdy - wd * wy) / (w * wdd - wd * wd);
    const double at_first = (wy - slope * wd) / w;
    if (!(slope > 0.0) || !std::isfinite(slope)) return out;
    const double contact_m = -at_first / slope;  // from the first row
    for (const auto& [d_m, force_N] : rows) {
        const double fitted_N = std::pow(std::max(0.0, slope * (d_m - contact_m)), exponent);
        out.cost_N2 += (fitted_N - force_N) * (fitted_N - force_N);
    }
    out.contact_m = std::clamp(p.depth_m[touch.first] + contact_m, p.depth_m.front(), p.depth_m[touch.first]);
    return out;
}

// Where the force crosses the threshold, for a place that tells no more.
double crossing_m(const ProbedPoint& p, const Touch& touch, double threshold_N) {
    const std::size_t i = touch.first;
    const double below_N = p.force_N[i - 1] - touch.air_N, above_N = p.force_N[i] - touch.air_N;
    const double share = std::clamp((threshold_N - below_N) / (above_N - below_N), 0.0, 1.0);
    return p.depth_m[i - 1] + share * (p.depth_m[i] - p.depth_m[i - 1]);
}

}  // namespace

double contact_threshold_N(const std::vector<ProbedPoint>& points) {
    std::vector<double> steps_N;
    std::vector<double> greatest_N;
    for (const ProbedPoint& p : points) {
        steps_N.push_back(p.force_N[1] - p.force_N[0]);  // of two rows: sqrt(2) times the noise of one
        greatest_N.push_back(p.force_N.back());
    }
    constexpr double kAboveNoise = 4.0;
    constexpr double kLeastShare = 0.01;
    return std::max(kAboveNoise * robust_deviation(std::move(steps_N)) / std::numbers::sqrt2,
                    kLeastShare * std::abs(median(std::move(greatest_N))));
}

ContactHeights find_contacts(const std::vector<ProbedPoint>& points, double threshold_N) {
    std::vector<Touch> touches;
    for (const ProbedPoint& p : points) touches.push_back(touch_of(p, threshold_N));
    const auto tells = [&](std::size_t i) {
        return touches[i].first > 0 && touches[i].first < points[i].force_N.size();
    };
    ContactHeights out;
    double least_N2 = std::numeric_limits<double>::infinity();
    for (const double exponent : {1.0, 1.25, 1.5, 1.75, 2.0}) {
        double cost_N2 = 0.0;
        for (std::size_t i = 0; i < points.size(); ++i) {
            if (tells(i)) cost_N2 += contact_fit(points[i], touches[i], threshold_N, exponent).cost_N2;
        }
        if (!(cost_N2 < least_N2)) continue;
        least_N2 = cost_N2;
        out.exponent = exponent;
    }
    for (std::size_t i = 0; i < points.size(); ++i) {
        out.air_N.push_back(touches[i].air_N);
        double contact_m = std::numeric_limits<double>::quiet_NaN();
        if (touches[i].first == 0) {
            contact_m = points[i].depth_m.front();  // it touches from the first row on
            out.air_N.back() = points[i].force_N.front();
        } else if (tells(i)) {
            contact_m = contact_fit(points[i], touches[i], threshold_N, out.exponent).contact_m;
            if (std::isnan(contact_m)) contact_m = crossing_m(points[i], touches[i], threshold_N);
        }
        out.contact_m.push_back(contact_m);
    }
    return out;
}

}  // namespace palpa::stiffnessmaps
