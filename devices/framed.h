#pragma once
// Frames of our own for boards that people program themselves, and the plain ones that they know from SoftRobots' sketches.
//
// A frame, both ways:   FF kind sequence state n   n values   CRC
//
// Every byte behind the header is below 0x80, so that FF stands at the beginning of a frame and nowhere else: a reader that
// lost its place finds it again at the next frame. A value has 21 bits, most significant seven first; it is counts +
// 1,048,576, so counts go from -1,048,576 to 1,048,575. The CRC (crc16.h, over all bytes before it, FF included) takes three
// bytes likewise.
//
//   to the board    set: drive the outputs to these counts; ask: say how you are; relax: go to rest
//   from the board  is: answers every frame by its sequence number; what it measures; its state
//
// The board rests by itself when 100 ms have passed without a good frame, until it is set again after a `relax`. docs/tangible.md
// holds a sketch for it.
//
// A sketch frame is FF b1 ... bn with bytes from 0 to 254, as SoftRobots' SerialPortBridgeGeneric sends it to Arduino
// sketches: without length, CRC, answer or watchdog. The board holds its last outputs when the line falls silent.
// Source of the latter: SofaDefrost/SoftRobots, SerialPortBridgeGeneric (its description; nothing was taken over).

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpa::devices {

inline constexpr std::size_t kMostFramedValues = 16;
inline constexpr std::size_t kMostFrame_bytes = 5 + 3 * kMostFramedValues + 3;
inline constexpr std::int32_t kLeastFramedCounts = -(1 << 20);
inline constexpr std::int32_t kMostFramedCounts = (1 << 20) - 1;
inline constexpr double kFramedTimeout_s = 0.1;

enum class FrameKind : std::uint8_t { set = 1, ask = 2, relax = 3, is = 0x41 };
enum class BoardState : std::uint8_t { drives, relaxed, timed_out, fault };

struct Frame {
    FrameKind kind = FrameKind::ask;
    std::uint8_t sequence = 0;  // 0 to 127
    BoardState state = BoardState::drives;
    std::array<std::int32_t, kMostFramedValues> value{};
    std::size_t values = 0;
};

struct FrameBytes {
    std::array<std::uint8_t, kMostFrame_bytes> bytes{};
    std::size_t size = 0;
    std::span<const std::uint8_t> view() const { return {bytes.data(), size}; }
};
// Counts out of range become the nearest in range.
FrameBytes encode_frame(const Frame& frame) noexcept;

struct FrameParser {
    std::array<std::uint8_t, kMostFrame_bytes> bytes{};
    std::size_t size = 0;  // 0: between frames
    std::int64_t frames = 0;
    std::int64_t malformed = 0;  // frames cut off, wrong CRCs, kinds and states that do not exist
};
// Returns true when `byte` completes a good frame.
bool feed(std::uint8_t byte, FrameParser& parser, Frame& out) noexcept;

// Counts out of 0 to 254 become the nearest in range. At most 16.
FrameBytes encode_sketch_frame(std::span<const std::int32_t> counts) noexcept;

}  // namespace palpa::devices
