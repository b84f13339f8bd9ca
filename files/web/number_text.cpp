// Converts numbers to and from text where the standard library lacks from_chars and to_chars for them (libc++ 14). The
// C library of the web knows no locale but "C", so strtod is safe here.

#include <array>
#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>

#include "files/text.h"

namespace palpa::files {

bool parse_number(std::string_view text, double& out) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    // strtod also skips spaces and reads hexadecimal numbers, neither of which our files hold
    const std::string copy(text);
    if (copy.empty() || copy.find_first_of(" \t\n\v\f\rxX(+") == 0 || copy.find_first_of("xX(") != std::string::npos)
        return false;
    char* end = nullptr;
    const double value = std::strtod(copy.c_str(), &end);
    if (end != copy.c_str() + copy.size()) return false;
    const bool named = copy.find_first_of("nN") != std::string::npos;  // inf, nan
    if (std::isinf(value) && !named) return false;                     // too large for a double
    out = value;
    return true;
}

void append_number(double value, std::string& out) {
    if (std::isnan(value)) {
        out.append("n/a");
        return;
    }
    if (std::isinf(value)) {
        out.append(value < 0.0 ? "-inf" : "inf");
        return;
    }
    std::array<char, 64> buffer;
    const char* const end = nlohmann::detail::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    std::string_view text(buffer.data(), static_cast<std::size_t>(end - buffer.data()));
    if (text.size() > 2 && text.substr(text.size() - 2) == ".0") text.remove_suffix(2);
    out.append(text);
}

}  // namespace palpa::files
