#pragma once
// Values as the cells of the report's tables.

#include <cmath>
#include <cstdint>
#include <cstdio>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/statistics.h"

namespace palpa::study {

inline const std::string kNone = "n/a";

inline std::string fixed(double value, int digits) {
    if (!std::isfinite(value)) return kNone;
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    const bool zero = std::string_view(text).find_first_of("123456789") == std::string_view::npos;
    return zero && text[0] == '-' ? text + 1 : text;  // no -0.0000
}

inline std::string share_text(double value) { return fixed(value, 4); }
// n/a for NaN; a number also where it is small, so that a program can read the column.
inline std::string p_text(double p) {
    if (!(p < 1e-4)) return fixed(p, 4);
    char text[32];
    std::snprintf(text, sizeof text, "%.1e", p);
    return text;
}
inline std::string whole(std::int64_t value) { return std::to_string(value); }
inline std::string number_of(std::int64_t n, const char* what) { return whole(n) + " " + what + (n == 1 ? "" : "s"); }

// A text of somebody's as a cell of a Markdown table: bars would be borders, and a line break the end of the table.
inline std::string markdown_cell(std::string_view text) {
    std::string out;
    for (const char c : text) {
        if (c == '|') out += '\\';
        out += c == '\n' || c == '\r' ? ' ' : c;
    }
    return out;
}

inline void add_interval(const std::optional<Interval>& ci, std::vector<std::string>& row) {
    row.push_back(ci ? share_text(ci->low) : kNone);
    row.push_back(ci ? share_text(ci->high) : kNone);
}

}  // namespace palpa::study
