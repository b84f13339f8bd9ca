#pragma once
// Counts in tables of logs and of results. An impossible count is refused with its line before it reaches the
// statistics.

#include <cmath>
#include <cstdint>
#include <string>

#include "files/table.h"

namespace palpa::study {

// The largest count that is accepted, more than anybody marks or answers. The exact tests sum over all counts up to
// this one in less than a second.
inline constexpr std::int64_t kMostCounts = 1'000'000;

// Returns the field of the current row as a whole number. Throws InputError with file, line and column if it is none,
// or is outside `from` to `to`.
inline std::int64_t whole_number(const files::Table& table, std::size_t column, std::int64_t from, std::int64_t to) {
    const double value = table.number(column);
    if (!(value >= static_cast<double>(from) && value <= static_cast<double>(to)) || value != std::floor(value)) {
        table.fail(column, "a whole number from " + std::to_string(from) + " to " + std::to_string(to));
    }
    return static_cast<std::int64_t>(value);
}

inline std::int64_t count(const files::Table& table, std::size_t column) {
    return whole_number(table, column, 0, kMostCounts);
}

}  // namespace palpa::study
