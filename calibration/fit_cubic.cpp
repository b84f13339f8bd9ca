#include <algorithm>
#include <cmath>
#include <numeric>

#include "calibration/fit.h"

namespace palpa::calibration {
namespace {

struct Knot {
    double level;
    double force_N;
    double weight;
};

double count_of(const Eigen::ArrayXd& count, Eigen::Index i) { return count.size() > 0 ? count(i) : 1.0; }

// Returns the weighted median, with at(i) giving the points of the bin in order of `value`: the value with half of the
// weight below it, or the mean of two values if the half falls between them.
template <class At>
double median(const Eigen::ArrayXd& value, const Eigen::ArrayXd& count, Eigen::Index from, Eigen::Index to,
              double weight, const At& at) {
    double below = 0.0;
    for (Eigen::Index k = from; k < to; ++k) {
        const Eigen::Index i = at(k);
        below += count_of(count, i);
        if (below > 0.5 * weight) return value(i);
        if (below < 0.5 * weight || count_of(count, i) == 0.0) continue;
        for (Eigen::Index next = k + 1; next < to; ++next) {
            if (count_of(count, at(next)) > 0.0) return 0.5 * (value(i) + value(at(next)));
        }
    }
    return value(at(to - 1));
}

// Pool adjacent violators: neighbouring knots that do not rise are merged into their weighted mean.
void make_rise(std::vector<Knot>& knots) {
    std::vector<Knot> out;
    for (const Knot& knot : knots) {
        out.push_back(knot);
        while (out.size() > 1 && !(out.back().force_N > out[out.size() - 2].force_N * (1.0 + 1e-12))) {
            const Knot b = out.back();
            out.pop_back();
            Knot& a = out.back();
            const double total = a.weight + b.weight;
            a.level = (a.weight * a.level + b.weight * b.level) / total;
            a.force_N = (a.weight * a.force_N + b.weight * b.force_N) / total;
            a.weight = total;
        }
    }
    knots = std::move(out);
}

}  // namespace

CubicBins cubic_bins(const FitPoints& points, int knots) {
    const Eigen::Index n = points.level.size();
    CubicBins bins;
    for (Eigen::Index i = 0; i < n; ++i) {
        if (i > 0 && points.level(i) == points.level(i - 1)) continue;
        const double full = static_cast<double>(bins.starts.size()) * static_cast<double>(n) / knots;
        if (i == 0 || knots == 0 || static_cast<double>(i) >= full) bins.starts.push_back(i);
    }
    bins.starts.push_back(n);
    bins.by_force.resize(static_cast<std::size_t>(n));
    std::iota(bins.by_force.begin(), bins.by_force.end(), Eigen::Index{0});
    for (std::size_t bin = 0; bin + 1 < bins.starts.size(); ++bin) {
        std::sort(bins.by_force.begin() + bins.starts[bin], bins.by_force.begin() + bins.starts[bin + 1],
                  [&](Eigen::Index a, Eigen::Index b) { return points.force_N(a) < points.force_N(b); });
    }
    return bins;
}

std::optional<Curve> fit_cubic(const FitPoints& points, const CubicBins& bins, const Eigen::ArrayXd& count) {
    std::vector<Knot> knots;
    for (std::size_t bin = 0; bin + 1 < bins.starts.size(); ++bin) {
        const Eigen::Index from = bins.starts[bin];
        const Eigen::Index to = bins.starts[bin + 1];
        const double weight = count.size() > 0 ? count.segment(from, to - from).sum() : static_cast<double>(to - from);
        if (weight == 0.0) continue;
        const double force_N = median(points.force_N, count, from, to, weight,
                                      [&](Eigen::Index k) { return bins.by_force[static_cast<std::size_t>(k)]; });
        const double level = median(points.level, count, from, to, weight, [](Eigen::Index k) { return k; });
        if (force_N > 0.0) knots.push_back({level, force_N, weight});
    }
    make_rise(knots);
    if (knots.size() < 2) return std::nullopt;
    std::vector<double> level;
    std::vector<double> force_N;
    for (const Knot& knot : knots) {
        level.push_back(knot.level);
        force_N.push_back(knot.force_N);
    }
    return monotone_cubic(std::move(level), std::move(force_N));
}

}  // namespace palpa::calibration
