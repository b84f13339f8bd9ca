#include "calibration/calibrate.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>

#include "files/input_error.h"
#include "files/quantile.h"
#include "files/text.h"

namespace palpa::calibration {
namespace {

// Returns Spearman's rank correlation of level and force.
double rank_correlation(const FitPoints& points) {
    const auto n = static_cast<std::size_t>(points.level.size());
    std::vector<std::size_t> order(n);
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) {
        return points.force_N(static_cast<Eigen::Index>(a)) < points.force_N(static_cast<Eigen::Index>(b));
    });
    // the points are in order of level, so their index is their rank by level
    double squares = 0.0;
    for (std::size_t rank = 0; rank < n; ++rank) {
        const double apart = static_cast<double>(rank) - static_cast<double>(order[rank]);
        squares += apart * apart;
    }
    const auto count = static_cast<double>(n);
    return 1.0 - 6.0 * squares / (count * (count * count - 1.0));
}

FitPoints rising_points(const CalibrationRows& rows, LevelRange range, const Ends& ends) {
    FitPoints points = fit_points(rows, range, ends);
    if (distinct_levels(points) < 3) {
        throw files::bad_input(rows.file, "level",
                               std::to_string(distinct_levels(points)) + " distinct levels below saturation",
                               "3 at least");
    }
    if (rank_correlation(points) < 0.3) {
        throw files::bad_input(rows.file, "force_N",
                               "forces that do not rise with the level (rank correlation " +
                                   files::short_number(rank_correlation(points)) + ")",
                               "a force that rises (columns exchanged, or sensor and pen not pressed together?)");
    }
    return points;
}

LevelsDelivered levels_of(const FitPoints& points, LevelRange range) {
    LevelsDelivered levels;
    levels.distinct = static_cast<std::size_t>(distinct_levels(points));
    for (Eigen::Index i = 1; i < points.level.size(); ++i) {
        const double step = points.level(i) - points.level(i - 1);
        if (step <= 0.0 || points.level(i) > range.highest) continue;
        if (!(step >= levels.smallest_step)) levels.smallest_step = step;
        constexpr double kEqual = 1e-6;  // of a step: levels are decimal numbers
        if (std::abs(step - levels.widest_gap) <= kEqual * step) ++levels.equal_gaps;
        if (step <= (1.0 + kEqual) * levels.widest_gap) continue;
        levels.equal_gaps = 1;
        levels.widest_gap = step;
        levels.gap_from = points.level(i - 1);
    }
    return levels;
}

Slips slips_in(const Calibration& calibration) {
    const bool log_error = calibration.chosen.error == ErrorModel::log;
    const auto distance = [&](double a_N, double b_N) { return std::abs(log_error ? std::log(a_N / b_N) : a_N - b_N); };
    struct Off {
        double predicted, followed, level;
    };
    std::vector<Off> all;
    std::vector<double> off;
    for (Eigen::Index i = 0; i < calibration.points.level.size(); ++i) {
        const double measured_N = calibration.points.force_N(i);
        const double predicted_N = calibration.chosen.predicted_N(i), fitted_N = calibration.fitted_N(i);
        if (log_error && !(measured_N > 0.0 && predicted_N > 0.0 && fitted_N > 0.0)) continue;
        off.push_back(distance(measured_N, predicted_N));
        all.push_back({off.back(), distance(fitted_N, predicted_N), calibration.points.level(i)});
    }
    const double scale = 1.4826 * files::median(off);
    const double least = log_error ? 0.05 : 0.01 * calibration.force_at_full_N;  // smaller residuals are no slips
    // 8 scales, since between sparse points a curve is off by 5 here and there without any slip
    Slips slips;
    for (const Off& one : all) {
        if (!(one.predicted > 8.0 * scale && one.predicted > least)) continue;
        ++slips.count;
        if (one.followed > least) slips.followed_levels.push_back(one.level);
    }
    return slips;
}

std::vector<double> band_levels(LevelRange range) {
    constexpr int kPlaces = 100;
    std::vector<double> levels;
    for (int i = 0; i <= kPlaces; ++i) levels.push_back(range.lowest + (range.highest - range.lowest) * i / kPlaces);
    return levels;
}

Curve fitted_curve(const FitPoints& points, const CalibrateOptions& options, LevelRange range, const std::string& file,
                   Candidate& chosen) {
    chosen =
        choose(points, candidates(points, options.model, options.error, options.robust, range.highest), options.error);
    std::optional<Curve> curve;
    if (chosen.predicted_N.size() > 0) curve = fit_curve(points, chosen.options);
    const bool usable = curve && value_N(*curve, range.highest) > std::max(0.0, value_N(*curve, range.lowest)) &&
                        value_N(*curve, range.highest) < 1000.0;
    if (usable) return *curve;
    const std::string model = options.model ? std::string(name_of(*options.model)) : "auto";
    throw files::bad_input(file, "model " + model,
                           "no rising curve below 1000 N through " + std::to_string(points.level.size()) + " points",
                           "points that determine it (more levels, or another model)");
}

// Repeats that hold different levels can be compared only through a curve that fits: the best one, whichever was asked for.
std::optional<Drift> drift_between_repeats(const Calibration& calibration, const CalibrateOptions& options,
                                           double highest_level) {
    const FitPoints& points = calibration.points;
    if (!calibration.by_repeats) return drift_of(points, calibration.fitted_N, false);
    if (!options.model) return drift_of(points, calibration.chosen.predicted_N, true);
    const Candidate best =
        choose(points, candidates(points, std::nullopt, options.error, options.robust, highest_level), options.error);
    return drift_of(points, best.predicted_N.size() > 0 ? best.predicted_N : calibration.chosen.predicted_N, true);
}

// A press that holds a reading or two is no repeat of the others: what differs between such presses is the level. Forgets
// repeats if half of them span less than a quarter of the levels.
void forget_short_repeats(CalibrationRows& rows) {
    std::map<int, std::pair<double, double>> ends;  // lowest and highest level of each repeat
    for (std::size_t i = 0; i < rows.repeat.size(); ++i) {
        const auto [it, first] = ends.try_emplace(rows.repeat[i], rows.level[i], rows.level[i]);
        it->second = {std::min(it->second.first, rows.level[i]), std::max(it->second.second, rows.level[i])};
    }
    std::vector<double> spans;
    for (const auto& [repeat, end] : ends) spans.push_back(end.second - end.first);
    const auto [lowest, highest] = std::minmax_element(rows.level.begin(), rows.level.end());
    if (spans.size() > 1 && files::median(spans) < 0.25 * (*highest - *lowest)) rows.repeat.clear();
}

}  // namespace

void check_level(LevelField level, const LevelRange& range, const std::string& file) {
    const std::string found =
        "levels from " + files::short_number(range.lowest) + " to " + files::short_number(range.highest);
    if (level == LevelField::pressure && range.highest > 1.0)
        throw files::bad_input(file, "level", found, "from 0 to 1, as `pressure` has it (counts are `pressure_raw`)");
    if (level == LevelField::contact_area && range.highest > 1.0)
        throw files::bad_input(file, "level", found,
                               "from 0 to 1, as `contact_area` has it (areas over that whose level is 1)");
    if (level == LevelField::pressure_raw && range.highest <= 1.0)
        throw files::bad_input(file, "level", found, "counts, as `pressure_raw` has it (from 0 to 1 is `pressure`)");
}

Calibration calibrate(const CalibrationRows& measured, const CalibrateOptions& options) {
    Calibration out;
    out.n_points = measured.level.size();
    if (out.n_points == 0) throw files::bad_input(measured.file, "", "no point", "points of a pen and a force sensor");
    const LevelRange range = options.range.value_or(level_range_of(measured.level));
    CalibrationRows rows = measured;
    forget_short_repeats(rows);
    if (options.remove_lag && !rows.time_s.empty()) {
        out.lag_s = lag_s(rows, range);
        if (out.lag_s) rows = without_lag(rows, *out.lag_s);
    }
    out.ends = ends_of(rows, range);
    out.points = rising_points(rows, range, out.ends);

    Profile& profile = out.profile;
    profile.curve = fitted_curve(out.points, options, range, rows.file, out.chosen);
    profile.device = rows.device;
    profile.level = options.level.value_or(range.highest > 1.0 ? LevelField::pressure_raw : LevelField::pressure);
    check_level(profile.level, range, rows.file);
    if (profile.level == LevelField::contact_area) profile.full_contact_area_px2 = options.full_contact_area_px2;
    profile.level_lowest = range.lowest;
    profile.level_highest = range.highest;
    const Eigen::Index n = out.points.level.size();
    profile.fitted_lowest = out.points.level(0);
    profile.fitted_highest = out.points.level(n - 1);
    for (Eigen::Index i = 0; i < n; ++i) profile.points.push_back({out.points.level(i), out.points.force_N(i)});

    out.fitted_N =
        Eigen::ArrayXd::NullaryExpr(n, [&](Eigen::Index i) { return value_N(profile.curve, out.points.level(i)); });
    out.quality = fit_quality(out.points.force_N, out.fitted_N);
    out.bands = error_bands(out.points.level, out.points.force_N, out.chosen.predicted_N, range);
    out.median_relative_error =
        median_relative_error(out.points.level, out.points.force_N, out.chosen.predicted_N, range);
    profile.median_relative_error = out.median_relative_error;
    out.force_at_full_N = value_N(profile.curve, range.highest);
    out.by_repeats = folds_of(out.points) == out.points.repeat;
    if (options.bootstrap_fits > 0) {
        out.bootstrap = bootstrap(out.points, out.chosen.options, profile.curve, band_levels(range),
                                  options.bootstrap_fits, options.seed);
    }
    out.hysteresis = hysteresis_of(rows, range);
    out.drift = drift_between_repeats(out, options, range.highest);
    out.levels = levels_of(out.points, range);
    out.slips = slips_in(out);
    out.warnings = warnings_of(out, rows.notes);
    return out;
}

}  // namespace palpa::calibration
