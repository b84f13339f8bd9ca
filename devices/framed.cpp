#include "devices/framed.h"

#include <algorithm>

#include "devices/crc16.h"

namespace palpa::devices {
namespace {

constexpr std::uint8_t kFrameHeader = 0xff;
constexpr std::size_t kFrameHead_bytes = 5;

void put_21_bits(std::uint32_t value, FrameBytes& out) noexcept {
    for (int shift = 14; shift >= 0; shift -= 7)
        out.bytes[out.size++] = static_cast<std::uint8_t>((value >> shift) & 0x7fu);
}

std::uint32_t get_21_bits(const std::uint8_t* bytes) noexcept {
    return (static_cast<std::uint32_t>(bytes[0]) << 14) | (static_cast<std::uint32_t>(bytes[1]) << 7) | bytes[2];
}

bool known(std::uint8_t kind) noexcept {
    switch (static_cast<FrameKind>(kind)) {
        case FrameKind::set:
        case FrameKind::ask:
        case FrameKind::relax:
        case FrameKind::is:
            return true;
    }
    return false;
}

bool head_is_good(const FrameParser& parser) noexcept {
    return known(parser.bytes[1]) && parser.bytes[3] <= static_cast<std::uint8_t>(BoardState::fault) &&
           parser.bytes[4] <= kMostFramedValues;
}

bool unpack_frame(const FrameParser& parser, Frame& out) noexcept {
    const std::size_t body = parser.size - 3;
    if (get_21_bits(parser.bytes.data() + body) != crc16({parser.bytes.data(), body})) return false;
    out.kind = static_cast<FrameKind>(parser.bytes[1]);
    out.sequence = parser.bytes[2];
    out.state = static_cast<BoardState>(parser.bytes[3]);
    out.values = parser.bytes[4];
    for (std::size_t i = 0; i < out.values; ++i) {
        const auto counts = static_cast<std::int32_t>(get_21_bits(parser.bytes.data() + kFrameHead_bytes + 3 * i));
        out.value[i] = counts + kLeastFramedCounts;
    }
    return true;
}

bool give_up(FrameParser& parser) noexcept {
    ++parser.malformed;
    parser.size = 0;
    return false;
}

}  // namespace

FrameBytes encode_frame(const Frame& frame) noexcept {
    FrameBytes out;
    const std::size_t values = std::min(frame.values, kMostFramedValues);
    for (const std::uint8_t byte :
         {kFrameHeader, static_cast<std::uint8_t>(frame.kind), static_cast<std::uint8_t>(frame.sequence & 0x7f),
          static_cast<std::uint8_t>(frame.state), static_cast<std::uint8_t>(values)})
        out.bytes[out.size++] = byte;
    for (std::size_t i = 0; i < values; ++i) {
        const std::int32_t counts = std::clamp(frame.value[i], kLeastFramedCounts, kMostFramedCounts);
        put_21_bits(static_cast<std::uint32_t>(counts - kLeastFramedCounts), out);
    }
    put_21_bits(crc16(out.view()), out);
    return out;
}

bool feed(std::uint8_t byte, FrameParser& parser, Frame& out) noexcept {
    if (byte == kFrameHeader) {
        parser.malformed += parser.size > 0;
        parser.bytes[0] = byte;
        parser.size = 1;
        return false;
    }
    if (parser.size == 0) return false;  // the rest of a frame that was given up
    if (byte >= 0x80) return give_up(parser);
    parser.bytes[parser.size++] = byte;
    if (parser.size < kFrameHead_bytes) return false;
    if (parser.size == kFrameHead_bytes && !head_is_good(parser)) return give_up(parser);
    if (parser.size < kFrameHead_bytes + 3u * parser.bytes[4] + 3u) return false;
    if (!unpack_frame(parser, out)) return give_up(parser);
    parser.size = 0;
    ++parser.frames;
    return true;
}

FrameBytes encode_sketch_frame(std::span<const std::int32_t> counts) noexcept {
    FrameBytes out;
    out.bytes[out.size++] = kFrameHeader;
    for (std::size_t i = 0; i < std::min(counts.size(), kMostFramedValues); ++i)
        out.bytes[out.size++] = static_cast<std::uint8_t>(std::clamp(counts[i], 0, 254));
    return out;
}

}  // namespace palpa::devices
