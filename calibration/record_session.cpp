#include "calibration/record_session.h"

#include <algorithm>
#include <cmath>

#include "calibration/calibrate.h"
#include "files/input_error.h"
#include "files/quantile.h"
#include "files/table.h"
#include "files/text.h"

namespace palpa::calibration {
namespace {

double width(const RecordOptions& options) { return options.range.highest - options.range.lowest; }

void drop_before(double t_s, std::deque<RecordSession::Timed>& values) {
    while (values.size() > 1 && values[1].t_s < t_s) values.pop_front();  // one stays: it holds until the next
}

// Computes the median of the values that held from from_s on, and their range. The value before from_s counts: a device
// that is held still may send nothing.
bool level_in(const std::deque<RecordSession::Timed>& levels, double from_s, double& median, double& moved) {
    if (levels.empty() || levels.front().t_s > from_s) return false;
    std::vector<double> inside;
    for (std::size_t i = 0; i < levels.size(); ++i) {
        const bool held = i + 1 == levels.size() || levels[i + 1].t_s > from_s;
        if (held) inside.push_back(levels[i].value);
    }
    const auto [lowest, highest] = std::minmax_element(inside.begin(), inside.end());
    moved = *highest - *lowest;
    median = files::median(inside);
    return true;
}

// Computes the mean force, and the difference between the means of its two halves, in which noise does not hide that a
// hand holds still. Returns false if a half has no reading.
bool force_in(const std::deque<RecordSession::Timed>& forces, double from_s, double to_s, double& mean_N,
              double& moved_N) {
    double sum[2] = {0.0, 0.0};
    int n[2] = {0, 0};
    const double middle_s = 0.5 * (from_s + to_s);
    for (const auto& force : forces) {
        if (force.t_s < from_s || force.t_s > to_s) continue;
        const int half = force.t_s > middle_s;
        sum[half] += force.value;
        ++n[half];
    }
    if (n[0] == 0 || n[1] == 0) return false;  // the sensor has stopped
    mean_N = (sum[0] + sum[1]) / (n[0] + n[1]);
    moved_N = std::abs(sum[1] / n[1] - sum[0] / n[0]);
    return true;
}

std::string round_percent(double share) {
    if (share > 1.0) return "over 100 %";
    const double digits = share < 0.1 ? 10.0 : 1.0;
    return files::short_number(std::round(100.0 * digits * share) / digits) + " %";
}

// Whether points lie beside a band, and none of it is reached by extrapolation only (as warnings.cpp calls that).
bool has_points(const RecordOptions& options, const std::vector<CapturedPoint>& points, const Ends& ends, int band) {
    const double wide = width(options) / options.bands;
    const double from = options.range.lowest + band * wide, centre = from + 0.5 * wide;
    bool beside = false, below = !std::isnan(ends.saturation_N), above = false;
    for (const CapturedPoint& point : points) {
        beside = beside || std::abs(point.level - centre) <= 1.5 * wide;
        above = above || point.level <= from + wide;
        below = below || point.level >= centre - 0.1 * wide;
    }
    return beside && above && below;
}

// Why the error of a band is not known.
const char* what_is_missing(const RecordOptions& options, const std::vector<CapturedPoint>& points, int band) {
    const double middle = options.range.lowest + (band + 0.5) * width(options) / options.bands;
    bool inside = false, upper = false;
    for (const CapturedPoint& point : points) {
        inside = inside || band_of(options, point.level) == band;
        upper = upper || point.level >= middle;
    }
    return !inside ? " (no point)" : upper ? " (too few points)" : " (no point in its upper half)";
}

}  // namespace

CalibrationRows rows_of(const std::vector<CapturedPoint>& points) {
    CalibrationRows rows;
    rows.file = "the session";
    for (const CapturedPoint& point : points) {
        rows.line.push_back(rows.line.size() + 2);
        rows.level.push_back(point.level);
        rows.force_N.push_back(point.force_N);
        rows.repeat.push_back(point.repeat);
    }
    return rows;
}

int band_of(const RecordOptions& options, double level) {
    const double share = (level - options.range.lowest) / width(options);
    return std::clamp(static_cast<int>(share * options.bands), 0, options.bands - 1);
}

void take_level(const RecordOptions& options, double t_s, double level, bool touching, RecordSession& session) {
    constexpr double kLifted_s = 0.25;  // in shorter gaps the pen bounces
    if (touching && !session.touching) {
        session.levels.clear();
        if (session.captured_in_repeat && t_s - session.lifted_s > kLifted_s) {
            ++session.repeat;
            session.captured_in_repeat = false;
            session.last_level = platform::kMissing;
            session.last_force_N = 0.0;
        }
    }
    if (!touching && session.touching) session.lifted_s = t_s;
    session.touching = touching;
    session.levels.push_back({t_s, touching ? level : 0.0});
    drop_before(t_s - 2.0 * options.steady_s, session.levels);
}

void take_force(const RecordOptions& options, double t_s, double force_N, RecordSession& session) {
    session.forces.push_back({t_s, force_N});
    drop_before(t_s - 2.0 * options.steady_s, session.forces);
}

void take_rest(const RecordOptions& options, double t_s, double shown_N, RecordSession& session) {
    constexpr double kRest_s = 0.4;
    session.rest.push_back({t_s, shown_N});
    drop_before(t_s - kRest_s, session.rest);
    if (t_s - session.rest.front().t_s < 0.9 * kRest_s) return;
    double mean_N = 0.0;
    double moved_N = 0.0;
    if (!force_in(session.rest, session.rest.front().t_s, t_s, mean_N, moved_N)) return;
    if (moved_N <= 0.25 * options.least_tolerance_N) session.zero_N = mean_N;
}

bool capture(const RecordOptions& options, double now_s, RecordSession& session) {
    if (!session.touching) return false;
    const double from_s = now_s - options.steady_s;
    double level = 0.0, level_moved = 0.0, force_N = 0.0, force_moved_N = 0.0;
    if (!level_in(session.levels, from_s, level, level_moved) ||
        !force_in(session.forces, from_s, now_s, force_N, force_moved_N))
        return false;
    if (!(level > options.range.lowest) || level > options.range.highest ||
        level_moved > options.level_tolerance * width(options))
        return false;
    if (force_moved_N > std::max(options.force_tolerance * std::abs(force_N), options.least_tolerance_N)) return false;
    if (force_N < -options.least_tolerance_N) ++session.below_zero;
    if (!(force_N > 0.0)) return false;
    const double apart = 0.5 * width(options) / options.bands;
    // at full level the force may still rise: this shows the saturation, and is captured too
    const bool same_place = std::abs(level - session.last_level) < apart &&
                            std::abs(force_N - session.last_force_N) < 0.1 * session.last_force_N;
    if (same_place) return false;
    const bool rising = std::isnan(session.last_level) || force_N >= session.last_force_N;
    session.points.push_back({now_s + session.clock_shift_s, level, force_N, session.repeat,
                              rising ? PressPhase::press : PressPhase::release});
    session.captured_in_repeat = true;
    session.last_level = level;
    session.last_force_N = force_N;
    return true;
}

int target_band(const RecordOptions& options, const RecordSession& session, const std::vector<double>& band_error) {
    std::vector<bool> visited(static_cast<std::size_t>(options.bands), false);
    for (const CapturedPoint& point : session.points) {
        if (point.repeat == session.repeat) visited[static_cast<std::size_t>(band_of(options, point.level))] = true;
    }
    const int from = std::isnan(session.last_level) ? 0 : band_of(options, session.last_level);
    for (int i = from; i < options.bands; ++i) {
        if (!visited[static_cast<std::size_t>(i)]) return i;
    }
    int worst = -1;
    for (int i = 0; i < static_cast<int>(band_error.size()); ++i) {
        const double error = band_error[static_cast<std::size_t>(i)];
        if (visited[static_cast<std::size_t>(i)] || !(std::isnan(error) || error > options.goal)) continue;
        if (worst < 0 || std::isnan(error) || error > band_error[static_cast<std::size_t>(worst)]) worst = i;
    }
    return worst;
}

Knowledge knowledge_of(const RecordOptions& options, const std::vector<CapturedPoint>& points) {
    Knowledge out;
    std::string jump;
    out.band_error.assign(static_cast<std::size_t>(options.bands), platform::kMissing);
    for (const CapturedPoint& point : points) out.repeats = std::max(out.repeats, point.repeat + 1);
    CalibrateOptions how;
    how.range = options.range;
    how.bootstrap_fits = 200;
    try {
        const CalibrationRows rows = rows_of(points);
        if (rows.level.empty()) throw files::InputError("no point yet");
        check_rows(rows, true);
        const Calibration calibration = calibrate(rows, how);
        const Ends& ends = calibration.ends;
        if (!std::isnan(ends.before_saturation_N))
            jump = "full level begins somewhere between " + files::short_number(ends.before_saturation_N) + " and " +
                   files::short_number(ends.saturation_N) + " N";
        const Bootstrap& boot = calibration.bootstrap;
        if (boot.fits > 0) {
            for (int band = 0; band < options.bands; ++band) {
                if (!has_points(options, points, ends, band)) continue;
                const auto at = static_cast<std::size_t>(
                    std::lround((band + 0.5) / options.bands * static_cast<double>(boot.level.size() - 1)));
                const double force_N = value_N(calibration.profile.curve, boot.level[at]);
                out.band_error[static_cast<std::size_t>(band)] = 0.5 * (boot.high_N[at] - boot.low_N[at]) / force_N;
            }
        }
    } catch (const files::InputError& error) {
        out.missing = error.what();
        return out;
    }
    std::string places;
    for (int band = 0; band < options.bands; ++band) {
        const double error = out.band_error[static_cast<std::size_t>(band)];
        if (error <= options.goal) continue;
        places += (places.empty() ? "" : ", ") + round_percent(static_cast<double>(band) / options.bands) + " to " +
                  round_percent((band + 1.0) / options.bands) +
                  (std::isnan(error) ? what_is_missing(options, points, band) : " (" + round_percent(error) + ")");
    }
    if (out.repeats < options.least_repeats)
        out.missing = std::to_string(out.repeats) + " of " + std::to_string(options.least_repeats) + " repeats";
    if (!places.empty())
        out.missing +=
            (out.missing.empty() ? "" : "; ") + ("not known to " + round_percent(options.goal) + ": " + places);
    out.done = out.missing.empty();
    if (out.done) out.missing = jump;
    return out;
}

std::string points_csv(const std::vector<CapturedPoint>& points) {
    std::string text = "time_s,level,force_N,repeat,phase\n";
    for (const CapturedPoint& point : points) {
        files::append_number(point.time_s, text);
        text += ',';
        files::append_number(point.level, text);
        text += ',';
        files::append_number(point.force_N, text);
        text += ',' + std::to_string(point.repeat) + (point.phase == PressPhase::press ? ",press\n" : ",release\n");
    }
    return text;
}

std::vector<CapturedPoint> read_session(const std::filesystem::path& file) {
    files::Table table = files::read_csv(file);
    const std::size_t time_s = table.column("time_s"), level = table.column("level"), force_N = table.column("force_N"),
                      repeat = table.column("repeat"), phase = table.column("phase");
    std::vector<CapturedPoint> points;
    while (table.next()) {
        const double number = table.finite_number(repeat);
        if (number < 0.0 || number > 1e6 || number != std::floor(number)) table.fail(repeat, "a whole number from 0");
        points.push_back({table.finite_number(time_s), table.finite_number(level), table.finite_number(force_N),
                          static_cast<int>(number),
                          table.field(phase) == "release" ? PressPhase::release : PressPhase::press});
    }
    return points;
}

}  // namespace palpa::calibration
