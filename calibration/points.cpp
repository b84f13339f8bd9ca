#include "calibration/points.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>
#include <set>

#include "calibration/curve.h"
#include "files/input_error.h"
#include "files/quantile.h"
#include "files/text.h"

namespace palpa::calibration {
namespace {

std::string line_of(const CalibrationRows& rows, std::size_t i) { return "line " + std::to_string(rows.line[i]); }

std::vector<std::size_t> by_level(const std::vector<double>& level) {
    std::vector<std::size_t> order(level.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t a, std::size_t b) { return level[a] < level[b]; });
    return order;
}

// By how much each force is off the middle of those beside it; three at least.
std::vector<double> bends_of(const std::vector<double>& force_N) {
    std::vector<double> bends;
    for (std::size_t i = 1; i + 1 < force_N.size(); ++i)
        bends.push_back(std::abs(force_N[i] - 0.5 * (force_N[i - 1] + force_N[i + 1])));
    return bends;
}

void check_enough(const CalibrationRows& rows) {
    const std::set<double> levels(rows.level.begin(), rows.level.end());
    if (levels.size() < 3) {
        throw files::bad_input(
            rows.file, "level",
            std::to_string(levels.size()) + " distinct levels in " + std::to_string(rows.level.size()) + " rows",
            "3 at least");
    }
    const auto [lowest, highest] = std::minmax_element(rows.force_N.begin(), rows.force_N.end());
    if (*lowest == *highest) {
        throw files::bad_input(rows.file, rows.force_column,
                               "the same force, " + files::short_number(*lowest) + " N, in every row",
                               "forces that rise with the level (is the sensor connected?)");
    }
}

// Throws InputError for forces in a wrong unit. A pen's full scale is 1 to 10 N, 100 to 1,000 gf.
void check_unit(const CalibrationRows& rows) {
    const double highest_N = *std::max_element(rows.force_N.begin(), rows.force_N.end());
    const bool gf = rows.force_column == "force_gf";
    if (highest_N > kMostForce_N) {
        throw files::bad_input(
            rows.file, rows.force_column, "forces up to " + files::short_number(highest_N) + " N",
            "less than " + files::short_number(kMostForce_N) + " N under a pen or finger (" +
                std::string(gf ? "is the column in gram-force?" : "gram-force? name the column force_gf;") +
                " --any-force if it is right)");
    }
    if (highest_N < 0.15) {
        throw files::bad_input(rows.file, rows.force_column,
                               "no force above " + files::short_number(highest_N) + " N (" +
                                   files::short_number(highest_N / 9.80665e-3) + " gf)",
                               "more than 0.15 N at the highest level (" +
                                   std::string(gf ? "newtons? name the column force_N;" : "is the column in newtons?") +
                                   " --any-force if it is right)");
    }
    // rows in another unit than their neighbours in level are off by a factor of 102, and by more than the sensor's noise
    const auto order = by_level(rows.level);
    std::vector<double> ordered_N;
    for (const std::size_t i : order) ordered_N.push_back(rows.force_N[i]);
    constexpr double kQuartile = 0.3186;  // of the size of standard normal numbers: three rows of four may be mixed up
    const double least_N = 6.0 * files::quantile(bends_of(ordered_N), 0.25) / (kQuartile * std::sqrt(1.5));
    for (std::size_t i = 0; i < order.size(); ++i) {
        constexpr std::size_t kNear = 3;
        std::vector<double> near;
        for (std::size_t j = i > kNear ? i - kNear : 0; j < std::min(order.size(), i + kNear + 1); ++j) {
            if (j != i) near.push_back(rows.force_N[order[j]]);
        }
        const double near_N = files::median(near), factor = ordered_N[i] / near_N;
        if (std::abs(ordered_N[i] - near_N) < least_N) continue;
        const bool gf_here = factor > 50.0 && factor < 200.0;
        const bool N_here = factor < 1.0 / 50.0 && factor > 1.0 / 200.0;
        if (rows.level[order[i]] > 0.0 && (gf_here || N_here)) {
            throw files::bad_input(
                rows.file, line_of(rows, order[i]) + ", force", files::short_number(ordered_N[i]) + " N",
                "about " + files::short_number(near_N) +
                    " N as at levels beside it (gram-force and newtons mixed up? --any-force if it is right)");
        }
    }
}

void check_times(const CalibrationRows& rows) {
    for (std::size_t i = 1; i < rows.time_s.size(); ++i) {
        if (rows.time_s[i] > rows.time_s[i - 1]) continue;
        // the clock may begin anew with each repeat
        if (!rows.repeat.empty() && rows.repeat[i] != rows.repeat[i - 1]) continue;
        throw files::bad_input(rows.file, line_of(rows, i) + ", time_s",
                               files::number_text(rows.time_s[i]) + " after " + files::number_text(rows.time_s[i - 1]),
                               "times that rise (sorted, none twice)");
    }
}

// Throws InputError if the force stays the same while the level changes: the sensor stopped, or its cable was cut.
void check_running(const CalibrationRows& rows) {
    if (rows.time_s.empty()) return;
    const auto [lowest, highest] = std::minmax_element(rows.level.begin(), rows.level.end());
    constexpr std::size_t kLong = 10;
    for (std::size_t from = 0; from < rows.level.size();) {
        std::size_t to = from;
        double low = rows.level[from];
        double high = low;
        while (to + 1 < rows.level.size() && rows.force_N[to + 1] == rows.force_N[from]) {
            ++to;
            low = std::min(low, rows.level[to]);
            high = std::max(high, rows.level[to]);
        }
        if (to - from + 1 >= kLong && high - low > 0.2 * (*highest - *lowest)) {
            throw files::bad_input(
                rows.file,
                "lines " + std::to_string(rows.line[from]) + " to " + std::to_string(rows.line[to]) + ", force",
                files::short_number(rows.force_N[from]) + " N all the time while the level goes from " +
                    files::short_number(low) + " to " + files::short_number(high),
                "a force that follows (the sensor stopped?)");
        }
        from = to + 1;
    }
}

// Returns the greatest force that the rows below full level, given in order of level, can lead to at full level: by one and a
// half times the slope of ln F over the last tenth of the range; three times the scatter, and 2 %. Infinite with too few rows.
double most_at_full_N(const CalibrationRows& rows, const std::vector<std::size_t>& below, LevelRange range) {
    constexpr double kFewest = 5.0, kLeastSpan = 0.05;  // presses of one level tell no slope
    if (static_cast<double>(below.size()) < kFewest) return kInfinity;
    const double from = range.highest - 0.1 * (range.highest - range.lowest);
    double lowest = rows.level[below.back()];
    double n = 0.0, sl = 0.0, sf = 0.0, sll = 0.0, slf = 0.0, sff = 0.0;
    for (auto it = below.rbegin(); it != below.rend(); ++it) {
        const double level = rows.level[*it], force_N = rows.force_N[*it];
        const bool spread_out = rows.level[below.back()] - lowest >= kLeastSpan * (range.highest - range.lowest);
        if (!(force_N > 0.0) || (level < from && n >= kFewest && spread_out)) break;
        lowest = level;
        const double ln_F = std::log(force_N);
        n += 1.0;
        sl += level;
        sf += ln_F;
        sll += level * level;
        slf += level * ln_F;
        sff += ln_F * ln_F;
    }
    const double spread = n * sll - sl * sl;
    if (n < kFewest || !(spread > 1e-12 * n * sll)) return kInfinity;
    const double slope = std::max(0.0, (n * slf - sl * sf) / spread), last = rows.level[below.back()];
    const double ln_F = sf / n + slope * (last - sl / n) + 1.5 * slope * (range.highest - last);
    const double scatter =
        std::sqrt(std::max(0.0, sff - sf * sf / n - slope * slope * spread / n) / n);  // about that line
    return (1.02 + 3.0 * scatter) * std::exp(ln_F);
}

// Returns whether the level stays while the force rises by a quarter, and by more than noise: in most presses, where presses
// can be told apart, since the force of a level may drift from one to the next.
bool stays(const CalibrationRows& rows, double plateau, double noise) {
    std::vector<std::vector<double>> presses(1);
    for (std::size_t i = 0; i < rows.level.size(); ++i) {
        const bool another = i > 0 && (rows.repeat.empty() ? !rows.time_s.empty() && rows.level[i] < plateau
                                                           : rows.repeat[i] != rows.repeat[i - 1]);
        if (another && !presses.back().empty()) presses.emplace_back();
        if (rows.level[i] >= plateau) presses.back().push_back(rows.force_N[i]);
    }
    std::size_t several = 0, rising = 0;
    for (std::vector<double>& force_N : presses) {
        if (force_N.size() < 3) continue;
        std::sort(force_N.begin(), force_N.end());
        const std::size_t extreme = force_N.size() / 20;  // of many rows the outermost are noise
        const double lowest = force_N[extreme], highest = force_N[force_N.size() - 1 - extreme];
        ++several;
        rising += highest > 1.25 * lowest && highest - lowest > 6.0 * noise;
    }
    return several > 0 && 2 * rising > several;
}

// Returns the quarter of the rows next to one end (at least five), in order of level, without the rows at the very end.
std::vector<std::size_t> quarter(const CalibrationRows& rows, const std::vector<std::size_t>& order, double lowest,
                                 double highest, bool top) {
    std::vector<std::size_t> inside;
    for (const std::size_t i : order) {
        if (rows.level[i] > lowest && rows.level[i] < highest) inside.push_back(i);
    }
    const std::size_t n = std::min(inside.size(), std::max<std::size_t>(inside.size() / 4, 5));
    const auto count = static_cast<std::ptrdiff_t>(n);
    return top ? std::vector<std::size_t>(inside.end() - count, inside.end())
               : std::vector<std::size_t>(inside.begin(), inside.begin() + count);
}

// Returns the scatter of y about the best line over x; infinite with fewer than four.
double scatter_about_line(const std::vector<double>& x, const std::vector<double>& y) {
    if (x.size() < 4) return kInfinity;
    const auto n = static_cast<Eigen::Index>(x.size());
    const Eigen::ArrayXd X = Eigen::Map<const Eigen::ArrayXd>(x.data(), n),
                         Y = Eigen::Map<const Eigen::ArrayXd>(y.data(), n);
    const Eigen::ArrayXd dx = X - X.mean(), dy = Y - Y.mean();
    const double spread = dx.square().sum(), slope = spread > 0.0 ? (dx * dy).sum() / spread : 0.0;
    return std::sqrt((dy - slope * dx).square().sum() / static_cast<double>(n - 2));
}

// Noise next to an end where the force is force_N: as great as in these rows, in newtons or in share of the force, by second
// differences; of few rows, about a line of ln F if that is less. Few rows stand far apart, as where weights are put on
// again and again, and second differences take the steps for noise.
double noise_at_end_N(const CalibrationRows& rows, const std::vector<std::size_t>& places, double force_N) {
    std::vector<double> level, near_N, ln_F;
    for (const std::size_t i : places) {
        level.push_back(rows.level[i]);
        near_N.push_back(rows.force_N[i]);
        ln_F.push_back(std::log(rows.force_N[i]));
    }
    const double noise = noise_N(near_N);
    if (std::any_of(near_N.begin(), near_N.end(), [](double one_N) { return one_N <= 0.0; })) return noise;
    constexpr std::size_t kFew = 12;
    const double about_line = places.size() > kFew ? kInfinity : force_N * scatter_about_line(level, ln_F);
    return std::min(std::max(noise, force_N * noise_N(ln_F)), about_line);
}

// Noise at a plateau that begins at force_N.
double noise_at_plateau_N(const CalibrationRows& rows, const std::vector<std::size_t>& order, LevelRange range,
                          double plateau, double force_N) {
    return noise_at_end_N(rows, quarter(rows, order, range.lowest, plateau, true), force_N);
}

int repeat_of(const CalibrationRows& rows, std::size_t i) { return rows.repeat.empty() ? 0 : rows.repeat[i]; }

int repeats_in(const CalibrationRows& rows) {
    return rows.repeat.empty() ? 1 : 1 + *std::max_element(rows.repeat.begin(), rows.repeat.end());
}

double activation(const CalibrationRows& rows, double lowest) {
    std::vector<double> first(static_cast<std::size_t>(repeats_in(rows)), kInfinity);
    for (std::size_t i = 0; i < rows.level.size(); ++i) {
        double& force_N = first[static_cast<std::size_t>(repeat_of(rows, i))];
        if (rows.level[i] > lowest) force_N = std::min(force_N, rows.force_N[i]);
    }
    first.erase(std::remove(first.begin(), first.end(), kInfinity), first.end());
    return std::max(0.0, files::median(first));  // below 0: the sensor's noise
}

}  // namespace

double noise_N(const std::vector<double>& force_N) {
    if (force_N.size() < 3) return 0.0;
    return 1.4826 * files::median(bends_of(force_N)) / std::sqrt(1.5);
}

void check_rows(const CalibrationRows& rows, bool any_force) {
    check_enough(rows);
    if (!any_force) check_unit(rows);
    check_times(rows);
    check_running(rows);
}

LevelRange level_range_of(const std::vector<double>& level) {
    const double highest = *std::max_element(level.begin(), level.end());
    if (highest <= 1.0) return {0.0, 1.0};
    double full = 3.0;
    while (full < highest) full = 2.0 * full + 1.0;
    return {0.0, full};
}

Ends ends_of(const CalibrationRows& rows, LevelRange range) {
    Ends ends;
    ends.activation_N = activation(rows, range.lowest);
    const auto order = by_level(rows.level);
    const double top = rows.level[order.back()];
    // Rows in the last 2 % of the levels: on a curve that rises to its end, their forces differ by a tenth.
    const double plateau = top >= range.highest ? range.highest : top - 0.02 * (range.highest - range.lowest);
    double lowest_N = kInfinity;
    double highest_N = 0.0;
    for (std::size_t i = 0; i < rows.level.size(); ++i) {
        if (rows.level[i] < plateau) continue;
        lowest_N = std::min(lowest_N, rows.force_N[i]);
        highest_N = std::max(highest_N, rows.force_N[i]);
    }
    const double noise = noise_at_plateau_N(rows, order, range, plateau, lowest_N);
    const bool full = top >= range.highest;
    if (full || stays(rows, plateau, noise)) {
        ends.saturation_N = lowest_N;
        ends.saturation_level = plateau;
        ends.above_saturation_N = highest_N;
        for (std::size_t i = 0; i < rows.level.size(); ++i)
            ends.saturated += rows.level[i] >= plateau && rows.force_N[i] > lowest_N + 3.0 * noise;
        std::vector<std::size_t> below = order;
        std::erase_if(below, [&](std::size_t i) { return rows.level[i] >= plateau || rows.level[i] <= range.lowest; });
        if (full && lowest_N > most_at_full_N(rows, below, range)) {
            ends.before_saturation_N = rows.force_N[below.back()];
            ends.saturated = 0;
            for (const double level : rows.level) ends.saturated += level >= plateau;
        }
    }
    double silent_N = 0.0;
    for (std::size_t i = 0; i < rows.level.size(); ++i) {
        if (rows.level[i] <= range.lowest) silent_N = std::max(silent_N, rows.force_N[i]);
    }
    for (std::size_t i = 0; i < rows.level.size(); ++i)
        ends.silent += rows.level[i] <= range.lowest && rows.force_N[i] < silent_N;
    return ends;
}

FitPoints fit_points(const CalibrationRows& rows, LevelRange range, const Ends& ends) {
    const auto order = by_level(rows.level);
    double silent_N = 0.0;
    for (std::size_t i = 0; i < rows.level.size(); ++i) {
        if (rows.level[i] <= range.lowest) silent_N = std::max(silent_N, rows.force_N[i]);
    }
    const double floor_N =
        silent_N - 3.0 * noise_at_end_N(rows, quarter(rows, order, range.lowest, range.highest, false), silent_N);
    const double plateau = std::isnan(ends.saturation_level) ? kInfinity : ends.saturation_level;
    const double ceiling_N =
        ends.saturation_N + 3.0 * noise_at_plateau_N(rows, order, range, plateau, ends.saturation_N);
    std::vector<std::size_t> kept;
    for (const std::size_t i : order) {
        const bool silent = rows.level[i] <= range.lowest && rows.force_N[i] < floor_N;
        const bool saturated =
            rows.level[i] >= plateau && (!std::isnan(ends.before_saturation_N) || rows.force_N[i] > ceiling_N);
        if (!silent && !saturated) kept.push_back(i);
    }
    FitPoints points;
    const auto n = static_cast<Eigen::Index>(kept.size());
    points.level.resize(n);
    points.force_N.resize(n);
    for (Eigen::Index k = 0; k < n; ++k) {
        const std::size_t i = kept[static_cast<std::size_t>(k)];
        points.level(k) = rows.level[i];
        points.force_N(k) = rows.force_N[i];
        if (!rows.repeat.empty()) points.repeat.push_back(rows.repeat[i]);
    }
    return points;
}

}  // namespace palpa::calibration
