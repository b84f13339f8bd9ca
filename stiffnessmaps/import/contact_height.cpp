#include "stiffnessmaps/import/contact_height.h"

#include <algorithm>
#include <cmath>
#include <functional>
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

// The rows up to ten thresholds, those in the air too: to leave out the low ones would draw the contact into the air.
std::size_t rows_of_fit(const ProbedPoint& p, const Touch& touch, double threshold_N) {
    constexpr double kWindow = 10.0;
    constexpr std::size_t kFewestRows = 4;
    std::size_t end = touch.first;
    while (end < p.force_N.size() &&
           (end < touch.first + kFewestRows || p.force_N[end] - touch.air_N <= kWindow * threshold_N))
        ++end;
    return end;
}

// Least squares of a max(0, d - contact)^n: a follows from the contact.
ContactFit fit_at(const ProbedPoint& p, const Touch& touch, std::size_t end, double contact_m, double exponent) {
    double ww = 0.0, wf = 0.0, ff = 0.0;
    for (std::size_t i = 0; i < end; ++i) {
        const double force_N = p.force_N[i] - touch.air_N;
        const double wave = std::pow(std::max(0.0, p.depth_m[i] - contact_m), exponent);
        ww += wave * wave;
        wf += wave * force_N;
        ff += force_N * force_N;
    }
    if (!(ww > 0.0) || !(wf > 0.0)) return {contact_m, ff};
    return {contact_m, std::max(0.0, ff - wf * wf / ww)};
}

ContactFit contact_fit(const ProbedPoint& p, const Touch& touch, double threshold_N, double exponent) {
    const std::size_t end = rows_of_fit(p, touch, threshold_N);
    double low_m = p.depth_m.front(), high_m = p.depth_m[touch.first];
    ContactFit best{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::infinity()};
    constexpr int kSteps = 24;
    for (int round = 0; round < 3; ++round) {
        const double step_m = (high_m - low_m) / kSteps;
        for (int i = 0; i <= kSteps; ++i) {
            const ContactFit one = fit_at(p, touch, end, low_m + i * step_m, exponent);
            if (one.cost_N2 < best.cost_N2) best = one;
        }
        low_m = std::max(p.depth_m.front(), best.contact_m - step_m);
        high_m = std::min(p.depth_m[touch.first], best.contact_m + step_m);
    }
    return best;
}

// Returns the exponent from 1 to 2 of least cost, to 0.01.
double best_exponent(const std::function<double(double)>& cost_N2) {
    double best = 1.5, least_N2 = std::numeric_limits<double>::infinity();
    const auto look = [&](double from, double to, double step) {
        for (double exponent = std::max(1.0, from); exponent < std::min(2.0, to) + 0.5 * step; exponent += step) {
            const double one_N2 = cost_N2(exponent);
            if (!(one_N2 < least_N2)) continue;
            least_N2 = one_N2;
            best = exponent;
        }
    };
    look(1.0, 2.0, 0.25);
    for (const double step : {0.05, 0.01}) look(best - 5.0 * step, best + 5.0 * step, step);
    return std::min(best, 2.0);
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
    std::vector<double> touching;  // rows that tell the law
    for (std::size_t i = 0; i < points.size(); ++i) {
        if (tells(i))
            touching.push_back(static_cast<double>(rows_of_fit(points[i], touches[i], threshold_N) - touches[i].first));
    }
    constexpr double kFewestToTell = 4.0;
    const bool law = median(std::move(touching)) >= kFewestToTell;
    if (law) {
        out.exponent = best_exponent([&](double exponent) {
            double cost_N2 = 0.0;
            for (std::size_t i = 0; i < points.size(); ++i) {
                if (tells(i)) cost_N2 += contact_fit(points[i], touches[i], threshold_N, exponent).cost_N2;
            }
            return cost_N2;
        });
    }
    std::vector<double> in_air;
    for (const Touch& touch : touches) in_air.push_back(static_cast<double>(touch.first));
    out.rows_in_air = median(std::move(in_air));
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
