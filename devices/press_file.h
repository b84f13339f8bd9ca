#pragma once
// PRESS.tsv: how a hand presses. Columns t_s, x_mm, y_mm, and depth_mm or force_N.

#include <filesystem>
#include <limits>
#include <string>
#include <vector>

namespace palpa::devices {

struct PressRow {
    double t_s = 0.0;
    double x_m = 0.0;
    double y_m = 0.0;
    double depth_m = std::numeric_limits<double>::quiet_NaN();  // one of depth and force is there, in all rows the same
    double force_N = std::numeric_limits<double>::quiet_NaN();
};

// Throws InputError with file, line and column: for a time that goes back or stands still, a value that is missing or not
// finite, a file without rows, and for both or neither of depth_mm and force_N.
std::vector<PressRow> read_press(const std::filesystem::path& tsv);
std::vector<PressRow> parse_press(std::string text, const std::string& file_name);
void write_press(const std::vector<PressRow>& rows, const std::filesystem::path& tsv);

// The row at a time, linear between rows; before the first and after the last row, that row. `at` remembers where it was
// (start with 0). Needs at least one row (assert).
PressRow press_at(const std::vector<PressRow>& rows, double t_s, std::size_t& at) noexcept;

}  // namespace palpa::devices
