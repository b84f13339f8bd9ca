#include "study/names.h"

#include <algorithm>
#include <array>
#include <string>

namespace palpa::study {

bool reads_as_missing(std::string_view name) {
    // pandas.read_csv, argument na_values: the words that it takes for a missing value unless told otherwise
    constexpr std::array<std::string_view, 19> kMissing{
        "",     "#N/A", "#N/A N/A", "#NA",  "-1.#IND", "-1.#QNAN", "-NaN", "-nan", "1.#IND", "1.#QNAN",
        "<NA>", "N/A",  "NA",       "NULL", "NaN",     "None",     "n/a",  "nan",  "null"};
    return std::find(kMissing.begin(), kMissing.end(), name) != kMissing.end();
}

bool is_name(std::string_view name) {
    const bool plain =
        std::none_of(name.begin(), name.end(), [](char c) { return static_cast<unsigned char>(c) < 0x20 || c == '"'; });
    return plain && !reads_as_missing(name);
}

bool names_a_sum(std::string_view name) {
    std::string lower(name);
    for (char& c : lower) c = c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    return lower == "all" || lower == "total" || lower == "sum" || lower == "overall";
}

bool has_outer_space(std::string_view name) {
    constexpr std::string_view kHardSpace = "\xC2\xA0";
    if (name.empty()) return false;
    return name.front() == ' ' || name.back() == ' ' || name.substr(0, 2) == kHardSpace ||
           (name.size() >= 2 && name.substr(name.size() - 2) == kHardSpace);
}

bool is_code(std::string_view code) {
    const bool plain = std::all_of(code.begin(), code.end(), [](char c) {
        return (c >= '0' && c <= '9') || (c >= 'A' && c <= 'Z') || (c >= 'a' && c <= 'z');
    });
    return plain && !reads_as_missing(code) && !names_a_sum(code);
}

std::string without_spelling(const std::string& code) {
    const auto digit = [](char c) { return c >= '0' && c <= '9'; };
    std::string out;
    for (std::size_t i = 0; i < code.size(); ++i) {
        const char c = code[i];
        const bool in_front =
            c == '0' && i + 1 < code.size() && digit(code[i + 1]) && (out.empty() || !digit(out.back()));
        if (!in_front) out += c >= 'A' && c <= 'Z' ? static_cast<char>(c - 'A' + 'a') : c;
    }
    return out;
}

}  // namespace palpa::study
