#include "calibration/bootstrap.h"

#include <algorithm>
#include <cmath>
#include <random>

#include "files/distributions.h"
#include "files/quantile.h"

namespace palpa::calibration {
namespace {

constexpr double kTail = 0.025;
constexpr double kLevel = 1.0 - 2.0 * kTail;

double widening(int repeats) {
    const double freedom = repeats - 1.0;
    return std::sqrt(repeats / freedom) * files::student_quantile(kLevel, freedom) / -files::normal_quantile(kTail);
}

int repeats_of(const FitPoints& points) {
    std::vector<int> seen = points.repeat;
    std::sort(seen.begin(), seen.end());
    return static_cast<int>(std::unique(seen.begin(), seen.end()) - seen.begin());
}

// Returns a whole number below n. The probabilities differ by a relative n / 2^32 at most.
Eigen::Index below(Eigen::Index n, std::uint32_t random) {
    return static_cast<Eigen::Index>((static_cast<std::uint64_t>(random) * static_cast<std::uint64_t>(n)) >> 32);
}

void draw(const FitPoints& points, bool over_repeats, std::mt19937_64& random, Eigen::ArrayXd& drawn,
          Eigen::ArrayXd& count) {
    const Eigen::Index units = drawn.size();
    drawn.setZero();
    for (Eigen::Index i = 0; i < units; i += 2) {
        const std::uint64_t bits = random();
        drawn(below(units, static_cast<std::uint32_t>(bits))) += 1.0;
        if (i + 1 < units) drawn(below(units, static_cast<std::uint32_t>(bits >> 32))) += 1.0;
    }
    if (!over_repeats) {
        count = drawn;
        return;
    }
    for (Eigen::Index i = 0; i < count.size(); ++i) count(i) = drawn(points.repeat[static_cast<std::size_t>(i)]);
}

CurveInterval interval_of(std::vector<double>& values, double estimate, double widened) {
    const double low = files::reordered_quantile(values, kTail, files::QuantileType::nearest);
    const double high = files::reordered_quantile(values, 1.0 - kTail, files::QuantileType::nearest);
    return {estimate + widened * (low - estimate), estimate + widened * (high - estimate)};
}

}  // namespace

Bootstrap bootstrap(const FitPoints& points, const FitOptions& options, const Curve& fitted,
                    const std::vector<double>& level, int fits, std::uint64_t seed) {
    Bootstrap out;
    const int repeats = repeats_of(points);
    out.over_repeats = repeats >= 3;
    const double widened = out.over_repeats ? widening(repeats) : 1.0;
    const bool cubic = options.model == CurveModel::monotone_cubic;
    FitWorkspace work;
    FitStart start;
    CubicBins bins;
    if (cubic) {
        bins = cubic_bins(points, options.knots);
    } else if (!start_fit(points, options, work, start)) {
        return out;
    }
    // `repeat` may have gaps where a press has no usable point, so every number up to the greatest counts as a unit
    const auto units = out.over_repeats
                           ? Eigen::Index{1} + *std::max_element(points.repeat.begin(), points.repeat.end())
                           : points.level.size();
    Eigen::ArrayXd drawn(units);
    Eigen::ArrayXd count(points.level.size());
    std::mt19937_64 random(seed);
    std::vector<std::vector<double>> force_N(level.size());
    std::vector<double> a_N, b, offset_N;
    for (int i = 0; i < fits; ++i) {
        draw(points, out.over_repeats, random, drawn, count);
        const auto curve = cubic ? fit_cubic(points, bins, count) : refit(points, options, count, start, work);
        if (!curve) continue;
        ++out.fits;
        a_N.push_back(curve->a_N);
        b.push_back(curve->b);
        offset_N.push_back(curve->offset_N);
        for (std::size_t k = 0; k < level.size(); ++k) force_N[k].push_back(value_N(*curve, level[k]));
    }
    if (out.fits == 0) return out;
    out.a_N = interval_of(a_N, fitted.a_N, widened);
    out.b = interval_of(b, fitted.b, widened);
    out.offset_N = interval_of(offset_N, fitted.offset_N, widened);
    out.level = level;
    for (std::size_t k = 0; k < level.size(); ++k) {
        const CurveInterval band = interval_of(force_N[k], value_N(fitted, level[k]), widened);
        out.low_N.push_back(std::max(0.0, band.low));
        out.high_N.push_back(band.high);
    }
    return out;
}

}  // namespace palpa::calibration
