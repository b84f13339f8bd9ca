#include "files/input_error.h"

#include "files/printable.h"

namespace palpa::files {

InputError bad_input(std::string_view file, std::string_view where, std::string_view found, std::string_view expected) {
    std::string message(file);
    if (!where.empty()) message.append(": ").append(where);
    message.append(": found ").append(found).append(", expected ").append(expected);
    return InputError(printable(message));
}

std::string shown(std::string_view text) {
    constexpr std::size_t kLongest = 40;
    std::string out = "'";
    for (const char c : text.substr(0, kLongest)) {
        const bool control = static_cast<unsigned char>(c) < 0x20 || c == 0x7f;
        out.push_back(control ? '?' : c);
    }
    if (text.size() > kLongest) out.append("...");
    return out + "'";
}

}  // namespace palpa::files
