#include "calibration/choose.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <set>

namespace palpa::calibration {
namespace {

FitPoints part(const FitPoints& points, const std::vector<int>& fold, int left_out) {
    std::vector<Eigen::Index> kept;
    for (Eigen::Index i = 0; i < points.level.size(); ++i) {
        if (fold[static_cast<std::size_t>(i)] != left_out) kept.push_back(i);
    }
    FitPoints out;
    const auto n = static_cast<Eigen::Index>(kept.size());
    out.level.resize(n);
    out.force_N.resize(n);
    for (Eigen::Index k = 0; k < n; ++k) {
        out.level(k) = points.level(kept[static_cast<std::size_t>(k)]);
        out.force_N(k) = points.force_N(kept[static_cast<std::size_t>(k)]);
    }
    return out;
}

// Scores under the two error models; a floor keeps those of exact data finite.
double newton_score(const FitPoints& points, const Eigen::ArrayXd& predicted_N) {
    const double floor_N = 1e-12 * points.force_N.maxCoeff();
    return -std::log(2.0 * std::max((points.force_N - predicted_N).abs().mean(), floor_N)) - 1.0;
}

double log_score(const FitPoints& points, const Eigen::ArrayXd& predicted_N) {
    double sum = 0.0;
    double log_sum = 0.0;
    Eigen::Index n = 0;
    for (Eigen::Index i = 0; i < points.level.size(); ++i) {
        if (!(points.force_N(i) > 0.0)) continue;
        // a curve that is not above 0 where a force was measured counts as off by a factor e^10, not an infinite one
        const double off = predicted_N(i) > 0.0 ? std::abs(std::log(points.force_N(i) / predicted_N(i))) : 10.0;
        sum += std::min(off, 10.0);
        log_sum += std::log(points.force_N(i));
        ++n;
    }
    if (n == 0) return -std::numeric_limits<double>::infinity();
    return -std::log(2.0 * std::max(sum / static_cast<double>(n), 1e-12)) - 1.0 - log_sum / static_cast<double>(n);
}

// Leaving out a repeat must leave a curve: three levels.
bool repeats_serve(const FitPoints& points) {
    const std::set<int> repeats(points.repeat.begin(), points.repeat.end());
    return repeats.size() > 1 && std::all_of(repeats.begin(), repeats.end(), [&](int repeat) {
               return distinct_levels(part(points, points.repeat, repeat)) >= 3;
           });
}

}  // namespace

std::vector<int> folds_of(const FitPoints& points) {
    const auto n = static_cast<std::size_t>(points.level.size());
    if (!points.repeat.empty() && repeats_serve(points)) return points.repeat;
    const std::size_t folds = n < 10 ? n : 5;
    std::vector<int> fold(n);
    for (std::size_t i = 0; i < n; ++i) fold[i] = static_cast<int>(i % folds);
    return fold;
}

std::vector<FitOptions> candidates(const FitPoints& points, const std::optional<CurveModel>& model,
                                   const std::optional<ErrorModel>& error, Robust robust, double level_scale) {
    std::vector<FitOptions> all;
    const int distinct = distinct_levels(points);
    for (const CurveModel m : {CurveModel::exponential, CurveModel::power, CurveModel::exponential_offset}) {
        if ((model && *model != m) || parameter_count(m) > distinct - 1) continue;
        for (const ErrorModel e : {ErrorModel::newton, ErrorModel::log}) {
            if (error && *error != e) continue;
            all.push_back({m, e, robust, 0, 0.0, level_scale});
        }
    }
    if (model && *model != CurveModel::monotone_cubic) return all;
    const ErrorModel e = error.value_or(ErrorModel::newton);
    constexpr int kMostKnots = 64;
    for (const int knots : {6, 8, 12, 16, 24, 32, 48, kMostKnots}) {
        if (knots < distinct) all.push_back({CurveModel::monotone_cubic, e, robust, knots, 0.0, level_scale});
    }
    if (distinct <= kMostKnots) all.push_back({CurveModel::monotone_cubic, e, robust, 0, 0.0, level_scale});
    return all;
}

void cross_validate(const FitPoints& points, const std::vector<int>& fold, std::optional<ErrorModel> error,
                    Candidate& candidate) {
    const auto n = points.level.size();
    const int folds = 1 + *std::max_element(fold.begin(), fold.end());
    candidate.predicted_N.resize(n);
    for (int left_out = 0; left_out < folds; ++left_out) {
        if (std::find(fold.begin(), fold.end(), left_out) == fold.end()) continue;
        const std::optional<Curve> curve = fit_curve(part(points, fold, left_out), candidate.options);
        if (!curve) {
            candidate.predicted_N.resize(0);
            candidate.score = -std::numeric_limits<double>::infinity();
            return;
        }
        for (Eigen::Index i = 0; i < n; ++i) {
            if (fold[static_cast<std::size_t>(i)] == left_out)
                candidate.predicted_N(i) = value_N(*curve, points.level(i));
        }
    }
    const bool cubic = candidate.options.model == CurveModel::monotone_cubic;
    const double in_newtons = newton_score(points, candidate.predicted_N);
    const double in_log = log_score(points, candidate.predicted_N);
    candidate.error =
        cubic && !error ? (in_log > in_newtons ? ErrorModel::log : ErrorModel::newton) : candidate.options.error;
    candidate.score = candidate.error == ErrorModel::log ? in_log : in_newtons;
    candidate.options.error = candidate.error;
}

Candidate choose(const FitPoints& points, const std::vector<FitOptions>& options, std::optional<ErrorModel> error) {
    const std::vector<int> fold = folds_of(points);
    const double uncertain = 1.0 / std::sqrt(static_cast<double>(points.level.size()));
    Candidate best;
    double best_score = -std::numeric_limits<double>::infinity();
    for (const FitOptions& option : options) {
        Candidate candidate;
        candidate.options = option;
        cross_validate(points, fold, error, candidate);
        const bool closest = option.model == CurveModel::monotone_cubic && option.knots == 0;
        const double score = candidate.score + (closest ? uncertain : 0.0);
        // simpler models come first, so a later one must be better by more than rounding
        if (candidate.predicted_N.size() == 0 || !(score > best_score + 1e-6)) continue;
        best_score = score;
        best = std::move(candidate);
    }
    return best;
}

}  // namespace palpa::calibration
