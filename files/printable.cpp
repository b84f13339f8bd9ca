#include "files/printable.h"

#include "files/json.h"

namespace palpa::files {

std::string printable(std::string_view message) {
    constexpr std::size_t kLongest = 4000;
    std::string out;
    for (const char c : message.substr(0, kLongest)) {
        const auto byte = static_cast<unsigned char>(c);
        // U+0080 to U+009F in UTF-8, which terminals interpret too
        const bool second = !out.empty() && out.back() == '\xc2' && byte >= 0x80 && byte < 0xa0;
        if (second) out.pop_back();
        const bool control = (byte < 0x20 && c != '\n') || byte == 0x7f;
        out.push_back(control || second ? '?' : c);
    }
    return message.size() > kLongest ? out + "..." : out;
}

bool is_utf8(std::string_view text) {
    try {
        Json(text).dump();
    } catch (const Json::type_error&) {
        return false;
    }
    return true;
}

}  // namespace palpa::files
