#include "desk/request_head.h"

#include <algorithm>
#include <charconv>

namespace palpa::desk {
namespace {

constexpr int kMostLines = 100;
constexpr std::size_t kMostDigits = 15;

char lower(char c) { return c >= 'A' && c <= 'Z' ? static_cast<char>(c + 32) : c; }

std::string lower_case(std::string_view text) {
    std::string out(text);
    std::transform(out.begin(), out.end(), out.begin(), lower);
    return out;
}

bool is_token(char c) {
    return (c >= '0' && c <= '9') || (lower(c) >= 'a' && lower(c) <= 'z') ||
           std::string_view("!#$%&'*+-.^_`|~").find(c) != std::string_view::npos;
}

std::string_view trimmed(std::string_view text) {
    while (!text.empty() && (text.front() == ' ' || text.front() == '\t')) text.remove_prefix(1);
    while (!text.empty() && (text.back() == ' ' || text.back() == '\t')) text.remove_suffix(1);
    return text;
}

bool has_controls(std::string_view line) {
    return std::any_of(line.begin(), line.end(),
                       [](char c) { return (static_cast<unsigned char>(c) < 0x20 && c != '\t') || c == 0x7f; });
}

CheckedHead refused(int status) { return {status, "", 0}; }

}  // namespace

CheckedHead check_head(std::string_view head) {
    CheckedHead out;
    bool has_length = false;
    bool wants_length = false;
    for (int line_number = 0;; ++line_number) {
        const auto end = head.find("\r\n");
        if (end == std::string_view::npos) return refused(400);
        const std::string_view line = head.substr(0, end);
        head.remove_prefix(end + 2);
        if (has_controls(line)) return refused(400);
        if (line_number > kMostLines) return refused(431);
        if (line_number == 0) {
            const auto first = line.find(' '), last = line.rfind(' ');
            if (first == std::string_view::npos || first == last) return refused(400);
            const std::string_view method = line.substr(0, first);
            const std::string_view target = line.substr(first + 1, last - first - 1);
            if (target.size() > kLongestTarget) return refused(414);
            if (target.empty() || target.front() != '/' || target.find(' ') != std::string_view::npos)
                return refused(400);
            wants_length = method == "PUT" || method == "POST" || method == "PATCH";
            out.text.append(line).append("\r\n");
            continue;
        }
        if (line.empty()) break;
        const auto colon = line.find(':');
        if (colon == std::string_view::npos || colon == 0 ||
            !std::all_of(line.begin(), line.begin() + static_cast<std::ptrdiff_t>(colon), is_token)) {
            return refused(400);
        }
        const std::string name = lower_case(line.substr(0, colon));
        const std::string_view value = trimmed(line.substr(colon + 1));
        if (name == "transfer-encoding") return refused(411);
        if (name == "content-encoding" && lower_case(value) != "identity") return refused(415);
        if (name == "content-type" && lower_case(value).rfind("multipart/", 0) == 0) return refused(415);
        if (name == "range" || name == "if-range" || name == "accept-encoding") continue;
        if (name == "content-length") {
            const auto [stop, error] = std::from_chars(value.data(), value.data() + value.size(), out.content_bytes);
            if (has_length || error != std::errc() || stop != value.data() + value.size() || value.size() > kMostDigits)
                return refused(400);
            has_length = true;
        }
        out.text.append(line.substr(0, colon)).append(": ").append(value).append("\r\n");
    }
    if (wants_length && !has_length) return refused(411);
    if (!head.empty()) return refused(400);
    out.text.append("\r\n");
    return out;
}

const char* why_refused(int status) {
    switch (status) {
        case 411:
            return "the length of the body is missing: Content-Length, and no chunks";
        case 414:
            return "the path is longer than 1024 bytes";
        case 415:
            return "the body must be neither compressed nor multipart";
        case 431:
            return "the head of the request is too long";
        default:
            return "the request cannot be read";
    }
}

}  // namespace palpa::desk
