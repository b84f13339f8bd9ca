#pragma once
// Pololu Maestro servo controllers on a serial line.
//
// Supported: the compact protocol (one board alone on its line: chained boards would all obey it) and the Pololu protocol
// with device numbers, both with and without CRC-7; Set Target, Set Multiple Targets (Mini 12, 18 and 24), Speed,
// Acceleration, Get Position, Get Moving State, Get Errors, Go Home. Not supported: Mini SSC, scripts, PWM.
// Targets are in quarter microseconds. Source: Pololu user's guide 0J40, sections 4.e and 5.a to 5.g.
// Tried with devices/simulators only, not with a board.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpa::devices {

inline constexpr int kMaestroChannels = 24;             // of the largest board
inline constexpr std::uint8_t kMaestroBaudByte = 0xaa;  // a board that detects the baud rate waits for it

struct MaestroAddress {
    int device = 12;       // 0 to 127; Pololu protocol only
    bool chained = false;  // Pololu protocol, else compact
    bool crc = true;
};

struct MaestroPacket {
    std::array<std::uint8_t, 6 + 2 * kMaestroChannels> bytes{};
    std::size_t size = 0;
    std::span<const std::uint8_t> view() const { return {bytes.data(), size}; }
};

// CRC-7, polynomial 0x91, least significant bit first.
std::uint8_t crc7(std::span<const std::uint8_t> bytes) noexcept;

// 0 turns the servo off. Targets above 16,383 are a bug (assert), as are more than 24 or none.
MaestroPacket encode_target(const MaestroAddress& to, int channel, int quarter_us) noexcept;
MaestroPacket encode_targets(const MaestroAddress& to, int first_channel,
                             std::span<const std::uint16_t> quarter_us) noexcept;
MaestroPacket encode_speed(const MaestroAddress& to, int channel, int quarter_us_per_10ms) noexcept;  // 0: unlimited
MaestroPacket encode_acceleration(const MaestroAddress& to, int channel, int value) noexcept;
MaestroPacket encode_get_position(const MaestroAddress& to, int channel) noexcept;
MaestroPacket encode_get_moving(const MaestroAddress& to) noexcept;
MaestroPacket encode_get_errors(const MaestroAddress& to) noexcept;
MaestroPacket encode_go_home(const MaestroAddress& to) noexcept;

// Bits of Get Errors. Any of them has sent all servos of the board to their homes.
enum MaestroError : std::uint16_t {
    kMaestroSignal = 1 << 0,
    kMaestroOverrun = 1 << 1,
    kMaestroBufferFull = 1 << 2,
    kMaestroCrc = 1 << 3,
    kMaestroProtocol = 1 << 4,
    kMaestroTimeout = 1 << 5,
    kMaestroScriptStack = 1 << 6,
    kMaestroCallStack = 1 << 7,
    kMaestroProgramCounter = 1 << 8,
};
inline constexpr std::uint16_t kMaestroErrors = 0x1ff;

enum class MaestroReply : std::uint8_t { none, errors, position, moving };

// Replies carry neither a header nor a CRC: what a byte means follows from what was asked. One question is open at a time.
struct MaestroReplyParser {
    MaestroReply awaited = MaestroReply::none;
    std::array<std::uint8_t, 2> byte{};
    std::size_t have = 0;
    std::int64_t replies = 0;
    std::int64_t unasked = 0;    // bytes that nobody had asked for: doubled, or too late
    std::int64_t malformed = 0;  // replies with a value that does not exist
};
// Opens a question; an older one is given up.
void await(MaestroReply reply, MaestroReplyParser& parser) noexcept;
// Returns true when `byte` completes the awaited reply; `value` is then in the range of its kind.
bool feed(std::uint8_t byte, MaestroReplyParser& parser, std::uint16_t& value) noexcept;

}  // namespace palpa::devices
