#include "devices/alicat.h"

#include <cassert>
#include <charconv>
#include <cmath>

namespace palpa::devices {
namespace {

AlicatCommand alicat_command(char unit, std::string_view rest) noexcept {
    assert(unit >= 'A' && unit <= 'Z' && rest.size() + 2 <= AlicatCommand{}.text.size());
    AlicatCommand command;
    command.text[command.size++] = unit;
    for (const char c : rest) command.text[command.size++] = c;
    command.text[command.size++] = '\r';
    return command;
}

// The next word of the line, which is shortened by it.
std::string_view next_word(std::string_view& line) noexcept {
    const std::size_t begin = line.find_first_not_of(' ');
    if (begin == std::string_view::npos) return line = {};
    line.remove_prefix(begin);
    const std::string_view word = line.substr(0, line.find(' '));
    line.remove_prefix(word.size());
    return word;
}

bool number_of(std::string_view word, double& value) noexcept {
    if (!word.empty() && word.front() == '+') word.remove_prefix(1);
    const auto read = std::from_chars(word.data(), word.data() + word.size(), value, std::chars_format::fixed);
    return read.ec == std::errc() && read.ptr == word.data() + word.size() && std::abs(value) <= kMostAlicatValue;
}

bool is_word(std::string_view word) noexcept {
    for (const char c : word) {
        if (c < '!' || c > '~') return false;
    }
    return true;
}

// Numbers first, then words: the gas of a flow meter, HLD, error codes.
bool parse_frame(std::string_view line, AlicatFrame& out) noexcept {
    const std::string_view unit = next_word(line);
    if (unit.size() != 1 || unit[0] < 'A' || unit[0] > 'Z') return false;
    out.unit = unit[0];
    out.values = 0;
    out.held = false;
    bool words = false;
    for (std::string_view word = next_word(line); !word.empty(); word = next_word(line)) {
        double value = 0.0;
        if (!words && number_of(word, value)) {
            if (out.values == AlicatFrame::kMostValues) return false;
            out.value[out.values++] = value;
            continue;
        }
        if (!is_word(word)) return false;
        words = true;
        out.held = out.held || word == "HLD";
    }
    return out.values > 0;
}

}  // namespace

AlicatCommand encode_alicat_poll(char unit) noexcept { return alicat_command(unit, ""); }
AlicatCommand encode_alicat_hold_closed(char unit) noexcept { return alicat_command(unit, "HC"); }
AlicatCommand encode_alicat_cancel_hold(char unit) noexcept { return alicat_command(unit, "C"); }

AlicatCommand encode_alicat_set_point(char unit, double value, bool spaced) noexcept {
    assert(std::abs(value) <= kMostAlicatValue);  // also against NaN
    std::array<char, 20> text{'S', ' '};
    char* const begin = text.data() + (spaced ? 2 : 1);
    // adding zero turns -0 into 0
    const auto wrote = std::to_chars(begin, text.data() + text.size(), value + 0.0, std::chars_format::fixed, 3);
    return alicat_command(unit, {text.data(), static_cast<std::size_t>(wrote.ptr - text.data())});
}

bool feed(std::uint8_t byte, AlicatParser& parser, AlicatFrame& out) noexcept {
    if (byte == '\n') return false;
    if (byte != '\r') {
        if (parser.skipping) return false;
        if (parser.size == parser.line.size()) {
            parser.skipping = true;
            return false;
        }
        parser.line[parser.size++] = static_cast<char>(byte);
        return false;
    }
    const bool empty = parser.size == 0 && !parser.skipping;
    const bool good = !parser.skipping && parse_frame({parser.line.data(), parser.size}, out);
    parser.size = 0;
    parser.skipping = false;
    parser.frames += good;
    parser.malformed += !good && !empty;
    return good;
}

}  // namespace palpa::devices
