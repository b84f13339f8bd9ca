#pragma once
// Alicat pressure controllers on a serial line: commands and replies as ASCII, ended by a carriage return.
//
// Supported: several units on one line (letters A to Z), poll, set point as a decimal number in the unit's own engineering
// units, hold closed, cancel hold. Not supported: streaming, set points as integers, mass flow.
// A unit answers every command by its data frame: letter, then numbers in an order that is a setting of the unit (query
// `A??D*`), then words of its state. It acts only after 3.5 bytes of silence, and a command that begins before the answer to
// the one before has ended does what nobody knows: the caller asks, waits, and asks again.
// A unit keeps its set point when the line falls silent: nothing but a further command brings the pressure down.
// Sources: Alicat operating manuals (PC series, BC series) and serial primer. Tried with devices/simulators only.

#include <array>
#include <cstddef>
#include <cstdint>
#include <string_view>

namespace palpa::devices {

inline constexpr double kMostAlicatValue = 99999.0;

struct AlicatCommand {
    std::array<char, 24> text{};
    std::size_t size = 0;
    std::string_view view() const { return {text.data(), size}; }
};

// `unit`: A to Z (assert).
AlicatCommand encode_alicat_poll(char unit) noexcept;
// `spaced`: the newer form "AS 5.44", else "AS5.44". A value that is not finite, or beyond 99,999 either way, is a bug
// (assert). Three decimals.
AlicatCommand encode_alicat_set_point(char unit, double value, bool spaced) noexcept;
AlicatCommand encode_alicat_hold_closed(char unit) noexcept;
AlicatCommand encode_alicat_cancel_hold(char unit) noexcept;

// A data frame.
struct AlicatFrame {
    static constexpr std::size_t kMostValues = 12;
    char unit = 'A';
    std::array<double, kMostValues> value{};  // finite, in the order of the unit
    std::size_t values = 0;
    bool held = false;  // the valves are held (word HLD)
};

struct AlicatParser {
    std::array<char, 128> line{};
    std::size_t size = 0;
    bool skipping = false;  // a line too long, until it ends
    std::int64_t frames = 0;
    std::int64_t malformed = 0;
};
// Returns true when `byte` ends a good frame.
bool feed(std::uint8_t byte, AlicatParser& parser, AlicatFrame& out) noexcept;

}  // namespace palpa::devices
