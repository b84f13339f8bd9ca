#pragma once
// The position in a .msh file while it is read; for msh.cpp only.

#include <algorithm>
#include <bit>
#include <charconv>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::files {

static_assert(std::endian::native == std::endian::little, "numbers are read as they lie in the file");

inline constexpr std::string_view kMshBlank = " \t\r\n";

// The position in the file. Numbers are read as text or as bytes, as the file's header says.
class MshCursor {
  public:
    MshCursor(std::string_view bytes, const std::string& file) : bytes_(bytes), file_(file) {}

    bool binary = false;

    [[noreturn]] void fail(std::string_view found, std::string_view expected) const {
        const auto before = bytes_.substr(0, at_);
        const auto line = 1 + std::count(before.begin(), before.end(), '\n');
        throw bad_input(file_, binary ? "byte " + std::to_string(at_) : "line " + std::to_string(line), found,
                        expected);
    }

    bool at_end() {
        at_ = std::min(bytes_.find_first_not_of(kMshBlank, at_), bytes_.size());
        return at_ == bytes_.size();
    }

    std::string_view word(std::string_view expected) {
        if (at_end()) fail("the end of the file", expected);
        const auto end = std::min(bytes_.find_first_of(kMshBlank, at_), bytes_.size());
        last_ = bytes_.substr(at_, end - at_);
        at_ = end;
        return last_;
    }

    std::string_view rest_of_line() {
        const auto end = std::min(bytes_.find('\n', at_), bytes_.size());
        const auto line = bytes_.substr(at_, end - at_);
        at_ = std::min(end + 1, bytes_.size());
        return line;
    }

    void skip_past(const std::string& text) {
        const auto found = bytes_.find(text, at_);
        if (found == std::string_view::npos) fail("the end of the file", text);
        at_ = found + text.size();
    }

    std::int64_t word_integer(std::string_view expected) { return from_word<std::int64_t>(expected); }

    // Read the format's types int, size_t and double. Throw InputError naming what was `expected`.
    int integer(std::string_view expected) {
        return binary ? from_bytes<std::int32_t>(expected) : from_word<std::int32_t>(expected);
    }
    std::uint64_t size(std::string_view expected) {
        return binary ? from_bytes<std::uint64_t>(expected) : from_word<std::uint64_t>(expected);
    }
    double real(std::string_view expected) {
        double value = 0.0;
        if (binary) {
            value = from_bytes<double>(expected);
        } else if (!parse_number(word(expected), value)) {
            fail(shown(last_), expected);
        }
        if (!std::isfinite(value)) fail(number_text(value), "a finite number: " + std::string(expected));
        return value;
    }

    // Throws InputError for a count of things that the rest of the file cannot hold; each thing takes at least this
    // many bytes.
    void check_count(std::uint64_t count, std::size_t text_bytes, std::size_t binary_bytes, std::string_view things) {
        const std::size_t each = binary ? binary_bytes : text_bytes;
        const std::size_t left = bytes_.size() - at_;
        if (count <= left / each) return;
        fail(std::to_string(count) + " " + std::string(things) + " announced with " + std::to_string(left) +
                 " bytes left",
             "as many as fit into the file");
    }

  private:
    template <class Value>
    Value from_bytes(std::string_view expected) {
        if (bytes_.size() - at_ < sizeof(Value)) fail("the end of the file", expected);
        Value value;
        std::memcpy(&value, bytes_.data() + at_, sizeof(Value));
        at_ += sizeof(Value);
        return value;
    }

    template <class Value>
    Value from_word(std::string_view expected) {
        const auto text = word(expected);
        Value value{};
        const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), value);
        if (error != std::errc() || end != text.data() + text.size()) fail(shown(text), expected);
        return value;
    }

    std::string_view bytes_;
    const std::string& file_;
    std::size_t at_ = 0;
    std::string_view last_;
};

}  // namespace palpa::files
