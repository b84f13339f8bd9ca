#pragma once
// Measured points of one calibration: read, checked, and made ready for a fit.

#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

#include "calibration/fit.h"
#include "calibration/profile.h"

namespace palpa::calibration {

enum class PressPhase : std::uint8_t { press, release };

// As they stand in the file, in its order. A column that the file has not is empty here.
struct CalibrationRows {
    std::string file;
    std::vector<std::size_t> line;
    std::vector<double> level;
    std::vector<double> force_N;
    std::vector<double> time_s;
    std::vector<int> repeat;  // 0, 1, ... by first occurrence
    std::vector<PressPhase> phase;
    DeviceNames device;              // from columns pen, tablet, driver, os, date, where all rows agree
    std::vector<std::string> notes;  // for people: several sessions taken together
};

struct RowFilter {
    std::string column;
    std::string value;
};

struct ReadOptions {
    std::vector<RowFilter> where;  // only rows for which all hold
    bool any_force = false;        // no check of the size of the forces
    bool for_fit = true;           // false: one row is enough, and their order does not matter
};

// Columns: level (or pressure_norm), force_N or force_gf (if both, they must agree), optional time_s, repeat, phase
// (press, release). Of several pens or days the sessions count as repeats. Throws InputError for what cannot be
// calibrated with, naming line and column: fewer than 3 distinct levels, all forces equal, forces that are negative
// or not numbers, gram-force for newtons or the other way round, times that do not rise, a sensor that stands still.
CalibrationRows read_points(const std::filesystem::path& file, const ReadOptions& options);

// Throws InputError; also part of read_points().
void check_rows(const CalibrationRows& rows, bool any_force);

// The lowest and highest level that a device can report.
struct LevelRange {
    double lowest = 0.0;
    double highest = 1.0;
};
// 0 ... 1 for levels up to 1, else 0 ... the next 2^n - 1.
LevelRange level_range_of(const std::vector<double>& level);

// What the two ends of the range do to the points.
struct Ends {
    double activation_N = platform::kMissing;  // lowest force with a level above 0 (median over repeats)
    double saturation_N =
        platform::kMissing;  // lowest force at which the level rises no more; NaN: it rises to the end
    double saturation_level = platform::kMissing;
    double above_saturation_N = platform::kMissing;  // the greatest force measured there
    std::size_t silent = 0;                          // rows at level 0 pressed with less than the greatest force there
    std::size_t saturated = 0;                       // rows beyond saturation
};
Ends ends_of(const CalibrationRows& rows, LevelRange range);

// Sorted by level. A level of 0 stands for every force up to the activation force, and the level at saturation for
// every force above: of these rows only those within the noise of that force are taken.
FitPoints fit_points(const CalibrationRows& rows, LevelRange range, const Ends& ends);

}  // namespace palpa::calibration
