#include "devices/maestro.h"

#include <algorithm>
#include <cassert>

namespace palpa::devices {
namespace {

// Compact commands; the Pololu protocol has them without bit 7.
enum Command : std::uint8_t {
    kSetTarget = 0x84,
    kSetSpeed = 0x87,
    kSetAcceleration = 0x89,
    kGetPosition = 0x90,
    kGetMoving = 0x93,
    kSetTargets = 0x9f,
    kGetErrors = 0xa1,
    kGoHome = 0xa2,
};

std::uint8_t low7(int value) { return static_cast<std::uint8_t>(value & 0x7f); }
std::uint8_t high7(int value) { return static_cast<std::uint8_t>((value >> 7) & 0x7f); }

void put_byte(std::uint8_t byte, MaestroPacket& packet) { packet.bytes[packet.size++] = byte; }

MaestroPacket begin_packet(const MaestroAddress& to, Command command) {
    MaestroPacket packet;
    if (to.chained) {
        put_byte(0xaa, packet);
        put_byte(low7(to.device), packet);
        put_byte(low7(command), packet);
    } else {
        put_byte(command, packet);
    }
    return packet;
}

MaestroPacket end_packet(const MaestroAddress& to, MaestroPacket packet) {
    if (to.crc) put_byte(crc7(packet.view()), packet);
    return packet;
}

MaestroPacket channel_and_value(const MaestroAddress& to, Command command, int channel, int value) {
    assert(channel >= 0 && channel < kMaestroChannels && value >= 0 && value < 1 << 14);
    MaestroPacket packet = begin_packet(to, command);
    put_byte(low7(channel), packet);
    put_byte(low7(value), packet);
    put_byte(high7(value), packet);
    return end_packet(to, packet);
}

// The highest pulse that a target can ask for is 16,383 quarter microseconds.
bool exists(MaestroReply kind, std::uint16_t value) {
    switch (kind) {
        case MaestroReply::none:
            return false;
        case MaestroReply::errors:
            return (value & ~kMaestroErrors) == 0;
        case MaestroReply::position:
            return value < 1 << 14;
        case MaestroReply::moving:
            return value <= 1;
    }
    return false;
}

}  // namespace

std::uint8_t crc7(std::span<const std::uint8_t> bytes) noexcept {
    unsigned crc = 0;
    for (const std::uint8_t byte : bytes) {
        crc ^= byte;
        for (int bit = 0; bit < 8; ++bit) crc = (crc & 1u) != 0 ? (crc ^ 0x91u) >> 1 : crc >> 1;
    }
    return static_cast<std::uint8_t>(crc);
}

MaestroPacket encode_target(const MaestroAddress& to, int channel, int quarter_us) noexcept {
    return channel_and_value(to, kSetTarget, channel, quarter_us);
}

MaestroPacket encode_targets(const MaestroAddress& to, int first_channel,
                             std::span<const std::uint16_t> quarter_us) noexcept {
    assert(!quarter_us.empty() && first_channel >= 0 &&
           quarter_us.size() + static_cast<std::size_t>(first_channel) <= kMaestroChannels);
    MaestroPacket packet = begin_packet(to, kSetTargets);
    put_byte(static_cast<std::uint8_t>(quarter_us.size()), packet);
    put_byte(low7(first_channel), packet);
    for (const std::uint16_t target : quarter_us) {
        assert(target < 1 << 14);
        put_byte(low7(target), packet);
        put_byte(high7(target), packet);
    }
    return end_packet(to, packet);
}

MaestroPacket encode_speed(const MaestroAddress& to, int channel, int quarter_us_per_10ms) noexcept {
    return channel_and_value(to, kSetSpeed, channel, quarter_us_per_10ms);
}

MaestroPacket encode_acceleration(const MaestroAddress& to, int channel, int value) noexcept {
    return channel_and_value(to, kSetAcceleration, channel, value);
}

MaestroPacket encode_get_position(const MaestroAddress& to, int channel) noexcept {
    assert(channel >= 0 && channel < kMaestroChannels);
    MaestroPacket packet = begin_packet(to, kGetPosition);
    put_byte(low7(channel), packet);
    return end_packet(to, packet);
}

MaestroPacket encode_get_moving(const MaestroAddress& to) noexcept {
    return end_packet(to, begin_packet(to, kGetMoving));
}
MaestroPacket encode_get_errors(const MaestroAddress& to) noexcept {
    return end_packet(to, begin_packet(to, kGetErrors));
}
MaestroPacket encode_go_home(const MaestroAddress& to) noexcept { return end_packet(to, begin_packet(to, kGoHome)); }

void await(MaestroReply reply, MaestroReplyParser& parser) noexcept {
    parser.unasked += static_cast<std::int64_t>(parser.have);
    parser.have = 0;
    parser.awaited = reply;
}

bool feed(std::uint8_t byte, MaestroReplyParser& parser, std::uint16_t& value) noexcept {
    if (parser.awaited == MaestroReply::none) {
        ++parser.unasked;
        return false;
    }
    parser.byte[parser.have++] = byte;
    const std::size_t wanted = parser.awaited == MaestroReply::moving ? 1 : 2;
    if (parser.have < wanted) return false;
    const auto found = static_cast<std::uint16_t>(parser.byte[0] | (wanted == 2 ? parser.byte[1] << 8 : 0));
    const bool good = exists(parser.awaited, found);
    parser.have = 0;
    parser.awaited = MaestroReply::none;
    if (!good) {
        ++parser.malformed;
        return false;
    }
    ++parser.replies;
    value = found;
    return true;
}

}  // namespace palpa::devices
