// Converts numbers to and from text with the standard library.

#include <array>
#include <charconv>
#include <cmath>

#include "files/text.h"

namespace palpa::files {

bool parse_number(std::string_view text, double& out) {
    if (!text.empty() && text.front() == '+') text.remove_prefix(1);
    if (text.empty() || text.front() == '+') return false;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), out);
    return error == std::errc() && end == text.data() + text.size();
}

void append_number(double value, std::string& out) {
    if (std::isnan(value)) {
        out.append("n/a");
        return;
    }
    std::array<char, 32> buffer;
    const auto [end, error] = std::to_chars(buffer.data(), buffer.data() + buffer.size(), value);
    static_cast<void>(error);  // 32 characters hold every double
    out.append(buffer.data(), end);
}

}  // namespace palpa::files
