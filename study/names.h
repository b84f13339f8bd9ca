#pragma once
// Names and codes in logs and tables. Programs that read tables (pandas, R, spreadsheets) take some words for a missing
// value and a double quote for the begin of a field, so such names are refused before they reach a log.

#include <string>
#include <string_view>

namespace palpa::study {

inline constexpr std::string_view kNameRule =
    "a name without tabs or double quotes that tables do not take for a missing value (as NA, n/a, null, nan)";
inline constexpr std::string_view kCodeRule =
    "letters and digits that tables do not take for a missing value (as NA, null, nan) or for everybody (as all, "
    "total)";
inline constexpr std::string_view kSumRule = "a name that no row of sums has (as all, total, sum, overall)";

// True for the words that pandas reads as a missing value, among them those of R and the empty text.
bool reads_as_missing(std::string_view name);

// True for a name as kNameRule says: of a condition, a group, a nodule, a comparison.
bool is_name(std::string_view name);

// True for a word that tables have in a row of sums: all, total, sum, overall, in any case.
bool names_a_sum(std::string_view name);

// True for a name that a space begins or ends, which looks like the name without it.
bool has_outer_space(std::string_view name);

// True for a participant's code as kCodeRule says; `sub-` is no part of it.
bool is_code(std::string_view code);

// The code without capitals and zeros in front of its numbers: p1 for P1, p01 and P001.
std::string without_spelling(const std::string& code);

}  // namespace palpa::study
