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
inline std::string p_text(double p) { return p < 1e-4 ? "<0.0001" : fixed(p, 4); }  // n/a for NaN
inline std::string whole(std::int64_t value) { return std::to_string(value); }
inline std::string number_of(std::int64_t n, const char* what) { return whole(n) + " " + what + (n == 1 ? "" : "s"); }

inline void add_interval(const std::optional<Interval>& ci, std::vector<std::string>& row) {
    row.push_back(ci ? share_text(ci->low) : kNone);
    row.push_back(ci ? share_text(ci->high) : kNone);
}

}  // namespace palpa::study
