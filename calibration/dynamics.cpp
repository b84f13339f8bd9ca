#include "calibration/dynamics.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <map>

#include "calibration/fit.h"
#include "calibration/quality.h"
#include "files/quantile.h"

namespace palpa::calibration {
namespace {

// Rows [from, to), sampled without a gap.
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
        const bool gap =
            !end && !(rows.time_s[i] - rows.time_s[i - 1] < 5.0 * step_s && rows.time_s[i] > rows.time_s[i - 1]);
        if (!end && !gap) continue;
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

// Returns the forces averaged over five samples with the weights 1 2 3 2 1; over three, and one, at the ends of a run. The
// sensor's noise, interpolated between samples, is then much the same at every time, and no lag looks better for it.
std::vector<double> smoothed_N(const CalibrationRows& rows, const std::vector<Run>& runs) {
    std::vector<double> out = rows.force_N;
    for (const Run& run : runs) {
        for (std::size_t i = run.from; i < run.to; ++i) {
            const std::size_t reach = std::min<std::size_t>({2, i - run.from, run.to - 1 - i});
            double sum = 0.0, weights = 0.0;
            for (std::size_t k = i - reach; k <= i + reach; ++k) {
                const double weight = static_cast<double>(reach + 1 - (k > i ? k - i : i - k));
                sum += weight * rows.force_N[k];
                weights += weight;
            }
            out[i] = sum / weights;
        }
    }
    return out;
}

// Returns the runs without their falls, or rises, by more than half of the range from one sample to the next: points that
// were captured one by one, each time upwards, fall so between two repeats, and nobody recorded a release.
std::vector<Run> without_jumps(const CalibrationRows& rows, const std::vector<Run>& runs, double range_N) {
    std::vector<Run> out;
    for (const Run& run : runs) {
        std::size_t from = run.from;
        for (std::size_t i = run.from + 1; i <= run.to; ++i) {
            if (i < run.to && std::abs(rows.force_N[i] - rows.force_N[i - 1]) <= 0.5 * range_N) continue;
            if (i - from >= 2) out.push_back({from, i});
            from = i;
        }
    }
    return out;
}

// Returns +1 for pressing, -1 for releasing, 0 for neither: whether the force rises or falls by 0.5 % of its range, and more
// than its noise, from `reach` samples before to `reach` samples after.
std::vector<int> directions(const CalibrationRows& rows) {
    std::vector<int> direction(rows.level.size(), 0);
    if (!rows.phase.empty()) {
        for (std::size_t i = 0; i < direction.size(); ++i) direction[i] = rows.phase[i] == PressPhase::press ? 1 : -1;
        return direction;
    }
    if (rows.time_s.empty()) return direction;
    const auto [lowest, highest] = std::minmax_element(rows.force_N.begin(), rows.force_N.end());
    const double enough_N = std::max(0.005 * (*highest - *lowest), 2.0 * noise_N(rows.force_N));
    const std::vector<Run> runs = without_jumps(rows, runs_of(rows, median_step_s(rows)), *highest - *lowest);
    const std::vector<double> force_N = smoothed_N(rows, runs);
    for (const Run& run : runs) {
        const std::size_t reach = std::clamp<std::size_t>((run.to - run.from) / 60, 2, 50);
        for (std::size_t i = run.from + reach; i + reach < run.to; ++i) {
            const double rise_N = force_N[i + reach] - force_N[i - reach];
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

// Returns how long the presses of a run last, on average: sampled without a gap, it may hold several.
double press_s(const CalibrationRows& rows, const std::vector<int>& direction, const Run& run) {
    int before = 0, presses = 0;
    for (std::size_t i = run.from; i < run.to; ++i) {
        if (direction[i] == 0) continue;
        presses += direction[i] == 1 && before != 1;
        before = direction[i];
    }
    return (rows.time_s[run.to - 1] - rows.time_s[run.from]) / std::max(presses, 1);
}

// What a lag is looked for in: the rows, with the times at which each force is known at every lag that is tried.
struct LagSearch {
    const CalibrationRows& rows;
    std::vector<Run> runs;
    std::vector<double> log_force;  // ln F, smoothed; NaN where F is too small against the sensor's noise
    std::vector<double> direction;  // +1 pressing, -1 releasing
    LevelRange range;
    double noise_N = 0.0;  // of the sensor
    double most_s = 0.0;
};

LagSearch lag_search(const CalibrationRows& rows, const std::vector<int>& direction, std::vector<Run> runs,
                     LevelRange range) {
    constexpr double kMost_s = 0.5, kLeastOfFull = 0.02;
    LagSearch out{rows, std::move(runs), {}, {direction.begin(), direction.end()}, range, noise_N(rows.force_N)};
    const double least_N = kLeastOfFull * *std::max_element(rows.force_N.begin(), rows.force_N.end());
    for (const double force_N : smoothed_N(rows, out.runs))
        out.log_force.push_back(force_N > least_N ? std::log(force_N) : platform::kMissing);
    double longest_s = 0.0;
    for (const Run& run : out.runs) longest_s = std::max(longest_s, press_s(rows, direction, run));
    out.most_s = std::min(kMost_s, 0.2 * longest_s);
    return out;
}

// Returns how much of the variance of ln F is left by ln F(t - tau) = g(level(t)) + d s / 2, with g linear between knots, s the
// hysteresis' share of the force and d its direction then; NaN with too few rows. Rows count by what they are worth: a light
// force drowns in the sensor's noise.
double misfit_at(const LagSearch& search, double tau_s) {
    constexpr Eigen::Index kKnots = 24;
    constexpr double kRelativeNoise = 0.01;  // of pens
    const CalibrationRows& rows = search.rows;
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(kKnots + 1, kKnots + 1);
    Eigen::VectorXd b = Eigen::VectorXd::Zero(kKnots + 1);
    double n = 0.0, weights = 0.0, sum = 0.0, squares = 0.0;
    for (const Run& run : search.runs) {
        std::size_t at = run.from, at_direction = run.from;
        for (std::size_t i = run.from; i < run.to; ++i) {
            const double t_s = rows.time_s[i];
            if (t_s - search.most_s < rows.time_s[run.from] || t_s + search.most_s > rows.time_s[run.to - 1]) continue;
            if (rows.level[i] <= search.range.lowest || rows.level[i] >= search.range.highest) continue;
            const double y = force_at(rows, run, t_s - tau_s, at, search.log_force);
            const double d = force_at(rows, run, t_s - tau_s, at_direction, search.direction);
            if (std::isnan(y) || std::abs(d) < 1.0) continue;  // turns round, or rests
            const double place = (rows.level[i] - search.range.lowest) / (search.range.highest - search.range.lowest) *
                                 static_cast<double>(kKnots - 1);
            const auto k = std::min(static_cast<Eigen::Index>(place), kKnots - 2);
            const double share = place - static_cast<double>(k);
            const Eigen::Index index[3] = {k, k + 1, kKnots};
            const double basis[3] = {1.0 - share, share, 0.5 * d};
            const double noise = search.noise_N / std::exp(y);
            const double weight = 1.0 / (1.0 + noise * noise / (kRelativeNoise * kRelativeNoise));
            for (int p = 0; p < 3; ++p) {
                b(index[p]) += weight * basis[p] * y;
                for (int q = 0; q < 3; ++q) A(index[p], index[q]) += weight * basis[p] * basis[q];
            }
            n += 1.0;
            weights += weight;
            sum += weight * y;
            squares += weight * y * y;
        }
    }
    if (n < 40.0) return platform::kMissing;
    A.diagonal().array() += 1e-9 * weights;  // knots without rows
    const Eigen::VectorXd x = A.ldlt().solve(b);
    const double left = squares - 2.0 * x.dot(b) + x.dot(A * x), all = squares - sum * sum / weights;
    return all > 0.0 ? std::max(0.0, left) / all : platform::kMissing;
}

}  // namespace

std::optional<double> lag_s(const CalibrationRows& rows, LevelRange range) {
    if (rows.time_s.size() < 40) return std::nullopt;
    const auto direction = directions(rows);
    const auto releasing = std::count(direction.begin(), direction.end(), -1);
    const auto pressing = std::count(direction.begin(), direction.end(), 1);
    if (std::min(releasing, pressing) < 15) return std::nullopt;
    const double step_s = median_step_s(rows);
    if (step_s > 0.1) return std::nullopt;  // captured point by point
    const LagSearch search = lag_search(rows, direction, runs_of(rows, step_s), range);
    // Whole samples, so that none of the lags that are tried averages the sensor's noise; a parabola then refines the best.
    constexpr int kMostSteps = 100;  // to each side
    const double width_s = step_s * std::ceil(search.most_s / kMostSteps / step_s);
    const int half = static_cast<int>(search.most_s / width_s);
    int best = 0;
    std::vector<double> misfit;
    for (int i = -half; i <= half; ++i) {
        misfit.push_back(misfit_at(search, i * width_s));
        if (std::isnan(misfit.back())) return std::nullopt;
        if (misfit.back() < misfit[static_cast<std::size_t>(best)]) best = i + half;
    }
    constexpr double kMostLeft = 0.75;  // of the variance of ln F
    if (best < 2 || best > 2 * half - 2 || misfit[static_cast<std::size_t>(best)] > kMostLeft) return std::nullopt;
    const auto at = misfit.begin() + best;
    const double bend = at[-1] - 2.0 * at[0] + at[1];
    return width_s * (best - half + (bend > 0.0 ? 0.5 * (at[-1] - at[1]) / bend : 0.0));
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
    // of lighter forces the share is the sensor's noise
    const double least_N = 0.05 * (value_N(*press, to) + value_N(*release, to));
    std::vector<double> relative;
    constexpr int kPlaces = 40;
    for (int i = 0; i <= kPlaces; ++i) {
        const double level = from + (to - from) * i / kPlaces;
        const double up_N = value_N(*press, level);
        const double down_N = value_N(*release, level);
        const double mean_N = 0.5 * (up_N + down_N);
        if (mean_N >= least_N) relative.push_back((up_N - down_N) / mean_N);
        if (std::abs(up_N - down_N) <= std::abs(out.greatest_N)) continue;
        out.greatest_N = up_N - down_N;
        out.at_level = level;
    }
    out.median_relative = files::median(relative);
    return out;
}

std::optional<Drift> drift_of(const FitPoints& points, const Eigen::ArrayXd& expected_N, bool by_others) {
    std::map<int, std::vector<double>> offsets;
    for (std::size_t i = 0; i < points.repeat.size(); ++i) {
        const auto k = static_cast<Eigen::Index>(i);
        if (expected_N(k) > 0.0) offsets[points.repeat[i]].push_back(points.force_N(k) / expected_N(k) - 1.0);
    }
    if (offsets.size() < 2) return std::nullopt;
    Drift drift;
    const auto n = static_cast<double>(offsets.size());
    // the mean of the others is as far on the other side, divided by their number
    const double share = by_others ? (n - 1.0) / n : 1.0;
    for (auto& [repeat, values] : offsets) drift.repeat_offset.push_back(share * files::median(values));
    double sum = 0.0;
    for (std::size_t i = 0; i < drift.repeat_offset.size(); ++i)
        sum += (static_cast<double>(i) - 0.5 * (n - 1.0)) * drift.repeat_offset[i];
    drift.per_repeat = sum / (n * (n * n - 1.0) / 12.0);
    const auto [lowest, highest] = std::minmax_element(drift.repeat_offset.begin(), drift.repeat_offset.end());
    drift.spread = *highest - *lowest;
    return drift;
}

}  // namespace palpa::calibration
