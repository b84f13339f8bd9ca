#pragma once
// Measured points of one calibration: read, checked, and prepared for a fit.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/fit.h"
#include "calibration/profile.h"

namespace palpa::calibration {

enum class PressPhase : std::uint8_t { press, release };

// The rows of a file, in its order. A column that the file lacks is empty here.
struct CalibrationRows {
    std::string file;
    std::vector<std::size_t> line;
    std::vector<double> level;
    std::vector<double> force_N;
    std::string force_column = "force_N";  // the file's: force_N, or force_gf alone
    std::vector<double> time_s;
    std::vector<int> repeat;  // 0, 1, ... by first occurrence
    std::vector<PressPhase> phase;
    DeviceNames device;              // from columns pen, tablet, driver, os, date; "several" if rows differ
    std::vector<std::string> notes;  // for people, such as several sessions taken together
};

inline constexpr double kMostForce_N = 60.0;  // under a pen or finger; ten times a pen's full scale

struct RowFilter {
    std::string column;
    std::string value;
};

struct ReadOptions {
    std::vector<RowFilter> where;  // only rows that meet all of them are read
    bool any_force = false;        // skips the check of the size of the forces
    bool for_fit = true;           // false: one row is enough, and their order does not matter
};

// Reads a table of points. Columns: level (or pressure_norm), force_N or force_gf (if both, they must agree), optional
// time_s, repeat, phase (press, release). If the file holds several pens or days and no repeats, sessions count as
// repeats. Throws InputError, naming line and column, for what cannot be used: fewer than 3 distinct levels, all forces
// equal, forces that are no numbers or further below 0 than the noise of a zeroed sensor (five times its noise, 1 % of the highest force),
// gram-force for newtons or the other way round, times that do not rise, a sensor that stands still.
CalibrationRows read_points(const std::filesystem::path& file, const ReadOptions& options);

// The checks of a whole table in read_points(). Throws InputError.
void check_rows(const CalibrationRows& rows, bool any_force);

// The lowest and highest level that a device can report.
struct LevelRange {
    double lowest = 0.0;
    double highest = 1.0;
};
// Returns 0 ... 1 for levels up to 1, else 0 ... the next 2^n - 1 from 3 on.
LevelRange level_range_of(const std::vector<double>& level);

// What the ends of the range do to the points: below the activation force the level is 0, above saturation it no longer
// rises.
struct Ends {
    double activation_N = platform::kMissing;  // lowest force with a level above 0 (median over repeats)
    // Lowest force at which the level no longer rises; NaN: it rises to the end.
    double saturation_N = platform::kMissing;
    double saturation_level = platform::kMissing;
    double above_saturation_N = platform::kMissing;  // greatest force measured there
    // The force at the highest level below, if the lowest one at full level is far above what leads there: saturation begins
    // somewhere between the two, and no row at full level is fitted. Else NaN.
    double before_saturation_N = platform::kMissing;
    std::size_t silent = 0;     // rows at level 0 with less than the greatest force at that level
    std::size_t saturated = 0;  // rows beyond saturation
};
Ends ends_of(const CalibrationRows& rows, LevelRange range);

// Returns the noise (one standard deviation) of forces in order of level or time: robust, from second differences.
double noise_N(const std::vector<double>& force_N);

// Returns the points for a fit, sorted by level. A level of 0 stands for every force up to the activation force, and
// the level at saturation for every force above: of these rows only those within the noise of that force are used.
FitPoints fit_points(const CalibrationRows& rows, LevelRange range, const Ends& ends);

}  // namespace palpa::calibration
