#include "calibration/dynamics.h"

#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/fit.h"
#include "calibration/quality.h"
#include "files/quantile.h"

namespace palpa::calibration {
namespace {

// Rows [from, to) of one repeat, sampled without a gap.
struct Run {
    std::size_t from;
    std::size_t to;
};

double median_step_s(const CalibrationRows& rows) {
    std::vector<double> steps;
    for (std::size_t i = 1; i < rows.time_s.size(); ++i) {
        if (rows.time_s[i] > rows.time_s[i - 1]) steps.push_back(rows.time_s[i] - rows.time_s[i - 1]);
    }
    return files::median(steps);
}

std::vector<Run> runs_of(const CalibrationRows& rows, double step_s) {
    std::vector<Run> runs;
    std::size_t from = 0;
    for (std::size_t i = 1; i <= rows.time_s.size(); ++i) {
        const bool end = i == rows.time_s.size();
        const bool other = !end && !rows.repeat.empty() && rows.repeat[i] != rows.repeat[i - 1];
        const bool gap =
            !end && !(rows.time_s[i] - rows.time_s[i - 1] < 5.0 * step_s && rows.time_s[i] > rows.time_s[i - 1]);
        if (!end && !other && !gap) continue;
        if (i - from >= 2) runs.push_back({from, i});
        from = i;
    }
    return runs;
}

// Returns `value` at a time, linear between the samples of a run; NaN outside. `at` is kept between calls with rising
// times.
double force_at(const CalibrationRows& rows, const Run& run, double t_s, std::size_t& at,
                const std::vector<double>& value) {
    while (at > run.from && rows.time_s[at] > t_s) --at;
    while (at + 2 < run.to && rows.time_s[at + 1] < t_s) ++at;
    if (t_s < rows.time_s[at] || t_s > rows.time_s[at + 1]) return platform::kMissing;
    const double share = (t_s - rows.time_s[at]) / (rows.time_s[at + 1] - rows.time_s[at]);
    return value[at] + share * (value[at + 1] - value[at]);
}

// Returns the correlation at one lag, over the samples that have a partner at every lag that is tried; NaN if there are
// too few.
double correlation(const CalibrationRows& rows, const std::vector<Run>& runs, const std::vector<double>& expected_level,
                   double tau_s, double most_s) {
    double n = 0.0, x = 0.0, y = 0.0, xx = 0.0, yy = 0.0, xy = 0.0;
    for (const Run& run : runs) {
        std::size_t at = run.from;
        for (std::size_t i = run.from; i < run.to; ++i) {
            const double t_s = rows.time_s[i];
            if (t_s - most_s < rows.time_s[run.from] || t_s + most_s > rows.time_s[run.to - 1]) continue;
            const double other = force_at(rows, run, t_s - tau_s, at, expected_level);
            n += 1.0;
            x += rows.level[i];
            y += other;
            xx += rows.level[i] * rows.level[i];
            yy += other * other;
            xy += rows.level[i] * other;
        }
    }
    if (n < 20.0) return platform::kMissing;
    const double spread = (xx - x * x / n) * (yy - y * y / n);
    return spread > 0.0 ? (xy - x * y / n) / std::sqrt(spread) : platform::kMissing;
}

// Returns +1 for pressing, -1 for releasing, 0 for neither: whether the force rises or falls by 0.5 % of its range from
// `reach` samples before to `reach` samples after.
std::vector<int> directions(const CalibrationRows& rows) {
    std::vector<int> direction(rows.level.size(), 0);
    if (!rows.phase.empty()) {
        for (std::size_t i = 0; i < direction.size(); ++i) direction[i] = rows.phase[i] == PressPhase::press ? 1 : -1;
        return direction;
    }
    if (rows.time_s.empty()) return direction;
    const auto [lowest, highest] = std::minmax_element(rows.force_N.begin(), rows.force_N.end());
    const double enough_N = 0.005 * (*highest - *lowest);
    for (const Run& run : runs_of(rows, median_step_s(rows))) {
        const std::size_t reach = std::clamp<std::size_t>((run.to - run.from) / 60, 1, 50);
        for (std::size_t i = run.from + reach; i + reach < run.to; ++i) {
            const double rise_N = rows.force_N[i + reach] - rows.force_N[i - reach];
            direction[i] = rise_N > enough_N ? 1 : rise_N < -enough_N ? -1 : 0;
        }
    }
    return direction;
}

CalibrationRows only(const CalibrationRows& rows, const std::vector<int>& direction, int wanted) {
    CalibrationRows out;
    for (std::size_t i = 0; i < rows.level.size(); ++i) {
        if (direction[i] != wanted) continue;
        out.level.push_back(rows.level[i]);
        out.force_N.push_back(rows.force_N[i]);
        out.line.push_back(rows.line[i]);
    }
    return out;
}

}  // namespace

std::optional<double> lag_s(const CalibrationRows& rows, const Curve& curve, LevelRange range) {
    if (rows.time_s.size() < 40) return std::nullopt;
    const auto direction = directions(rows);
    const auto releasing = std::count(direction.begin(), direction.end(), -1);
    const auto pressing = std::count(direction.begin(), direction.end(), 1);
    if (std::min(releasing, pressing) < 15) return std::nullopt;
    const double step_s = median_step_s(rows);
    constexpr double kMost_s = 0.5;
    if (step_s > 0.1) return std::nullopt;  // captured point by point
    const auto runs = runs_of(rows, step_s);
    std::vector<double> expected(rows.level.size());
    for (std::size_t i = 0; i < expected.size(); ++i)
        expected[i] = std::clamp(level_at(curve, rows.force_N[i]), range.lowest, range.highest);

    constexpr int kHalf = 100;  // steps of 5 ms to each side; a parabola then refines the best
    double best_s = 0.0;
    double width_s = kMost_s / kHalf;
    double best = -2.0;
    for (int i = -kHalf; i <= kHalf; ++i) {
        const double r = correlation(rows, runs, expected, i * width_s, kMost_s);
        if (!(r > best)) continue;
        best = r;
        best_s = i * width_s;
    }
    if (best < 0.5 || std::abs(best_s) > kMost_s - 1.5 * width_s) return std::nullopt;
    const double left = correlation(rows, runs, expected, best_s - width_s, kMost_s);
    const double right = correlation(rows, runs, expected, best_s + width_s, kMost_s);
    const double bend = left - 2.0 * best + right;
    return bend < 0.0 ? best_s + 0.5 * width_s * (left - right) / bend : best_s;
}

CalibrationRows without_lag(const CalibrationRows& rows, double lag) {
    CalibrationRows out;
    out.file = rows.file;
    out.device = rows.device;
    out.notes = rows.notes;
    for (const Run& run : runs_of(rows, median_step_s(rows))) {
        std::size_t at = run.from;
        for (std::size_t i = run.from; i < run.to; ++i) {
            const double force_N = force_at(rows, run, rows.time_s[i] - lag, at, rows.force_N);
            if (std::isnan(force_N)) continue;
            out.line.push_back(rows.line[i]);
            out.level.push_back(rows.level[i]);
            out.force_N.push_back(force_N);
            out.time_s.push_back(rows.time_s[i]);
            if (!rows.repeat.empty()) out.repeat.push_back(rows.repeat[i]);
            if (!rows.phase.empty()) out.phase.push_back(rows.phase[i]);
        }
    }
    return out;
}

std::optional<Hysteresis> hysteresis_of(const CalibrationRows& rows, LevelRange range) {
    const auto direction = directions(rows);
    const auto fit = [&](int wanted) -> std::optional<Curve> {
        const CalibrationRows part = only(rows, direction, wanted);
        if (part.level.size() < 8) return std::nullopt;
        const FitPoints points = fit_points(part, range, ends_of(part, range));
        return fit_cubic(points, cubic_bins(points, 12));
    };
    const auto press = fit(1);
    const auto release = fit(-1);
    if (!press || !release) return std::nullopt;
    const double from = std::max(press->knot_level.front(), release->knot_level.front());
    const double to = std::min(press->knot_level.back(), release->knot_level.back());
    if (!(from < to)) return std::nullopt;
    Hysteresis out;
    std::vector<double> relative;
    constexpr int kPlaces = 40;
    for (int i = 0; i <= kPlaces; ++i) {
        const double level = from + (to - from) * i / kPlaces;
        const double up_N = value_N(*press, level);
        const double down_N = value_N(*release, level);
        relative.push_back((up_N - down_N) / (0.5 * (up_N + down_N)));
        if (std::abs(up_N - down_N) <= std::abs(out.greatest_N)) continue;
        out.greatest_N = up_N - down_N;
        out.at_level = level;
    }
    out.median_relative = files::median(relative);
    return out;
}

CalibrationRows without_loop(const CalibrationRows& rows, double relative) {
    CalibrationRows out = rows;
    const std::vector<int> direction = directions(rows);
    for (std::size_t i = 0; i < direction.size(); ++i) out.force_N[i] /= 1.0 + 0.5 * relative * direction[i];
    return out;
}

std::optional<Drift> drift_of(const FitPoints& points, const Curve& curve) {
    std::map<int, std::vector<double>> offsets;
    for (std::size_t i = 0; i < points.repeat.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        const double expected_N = value_N(curve, points.level(k));
        if (expected_N > 0.0) offsets[points.repeat[i]].push_back(points.force_N(k) / expected_N - 1.0);
    }
    if (offsets.size() < 2) return std::nullopt;
    Drift drift;
    for (auto& [repeat, values] : offsets) drift.repeat_offset.push_back(files::median(values));
    const auto n = static_cast<double>(drift.repeat_offset.size());
    double sum = 0.0;
    for (std::size_t i = 0; i < drift.repeat_offset.size(); ++i)
        sum += (static_cast<double>(i) - 0.5 * (n - 1.0)) * drift.repeat_offset[i];
    drift.per_repeat = sum / (n * (n * n - 1.0) / 12.0);
    const auto [lowest, highest] = std::minmax_element(drift.repeat_offset.begin(), drift.repeat_offset.end());
    drift.spread = *highest - *lowest;
    return drift;
}

}  // namespace palpa::calibration
