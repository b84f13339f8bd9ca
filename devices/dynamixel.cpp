#include "devices/dynamixel.h"

#include <algorithm>
#include <cassert>

#include "devices/crc16.h"

namespace palpa::devices {
namespace {

constexpr std::size_t kDxlHead_bytes = 8;  // FF FF FD 00, id, length, instruction
constexpr std::array<std::uint8_t, 4> kDxlHeader{0xff, 0xff, 0xfd, 0x00};

void put_dxl(std::uint8_t byte, DynamixelPacket& packet) noexcept { packet.bytes[packet.size++] = byte; }

// Whether the bytes before `end` are FF FF FD: then another FD must follow, which is no data.
bool ends_in_header(std::span<const std::uint8_t> bytes) noexcept {
    const std::size_t n = bytes.size();
    return n >= 3 && bytes[n - 3] == 0xff && bytes[n - 2] == 0xff && bytes[n - 1] == 0xfd;
}

DynamixelPacket make_packet(int id, std::uint8_t instruction, std::span<const std::uint8_t> parameters) noexcept {
    assert(parameters.size() <= kMostDynamixelParameters);
    DynamixelPacket packet;
    for (const std::uint8_t byte : kDxlHeader) put_dxl(byte, packet);
    put_dxl(static_cast<std::uint8_t>(id), packet);
    packet.size += 2;  // the length, once it is known
    put_dxl(instruction, packet);
    const std::size_t body = kDxlHead_bytes - 1;  // stuffing counts from the instruction on
    for (const std::uint8_t byte : parameters) {
        put_dxl(byte, packet);
        if (ends_in_header(packet.view().subspan(body))) put_dxl(0xfd, packet);
    }
    const std::size_t length = packet.size - body + 2;  // instruction, parameters, CRC
    packet.bytes[5] = static_cast<std::uint8_t>(length & 0xff);
    packet.bytes[6] = static_cast<std::uint8_t>(length >> 8);
    const std::uint16_t crc = crc16(packet.view());
    put_dxl(static_cast<std::uint8_t>(crc & 0xff), packet);
    put_dxl(static_cast<std::uint8_t>(crc >> 8), packet);
    return packet;
}

void put_value(std::int32_t value, std::size_t bytes, std::uint8_t*& to) noexcept {
    const auto bits = static_cast<std::uint32_t>(value);
    for (std::size_t i = 0; i < bytes; ++i) *to++ = static_cast<std::uint8_t>(bits >> (8 * i));
}

// The whole length of the packet in the buffer, 0 while it is not known, 1 if it cannot be a packet.
std::size_t expected_size(const DynamixelParser& parser) noexcept {
    const std::size_t head = std::min(parser.size, kDxlHeader.size());
    if (!std::equal(kDxlHeader.begin(), kDxlHeader.begin() + static_cast<std::ptrdiff_t>(head), parser.bytes.begin()))
        return 1;
    if (parser.size < 7) return 0;
    const std::size_t length = parser.bytes[5] + 256u * parser.bytes[6];
    const bool possible = length >= 3 && kDxlHead_bytes - 1 + length <= kMostDynamixel_bytes;
    return possible ? kDxlHead_bytes - 1 + length : 1;
}

// Drops the first byte and all up to the next possible header.
void drop_to_header(DynamixelParser& parser) noexcept {
    const auto begin = parser.bytes.begin();
    const auto end = begin + static_cast<std::ptrdiff_t>(parser.size);
    const auto next = std::find(begin + 1, end, kDxlHeader[0]);
    std::copy(next, end, begin);
    parser.size = static_cast<std::size_t>(end - next);
}

bool unpack(const DynamixelParser& parser, std::size_t size, DynamixelMessage& out) noexcept {
    const std::span<const std::uint8_t> all(parser.bytes.data(), size);
    const std::uint16_t crc = crc16(all.first(size - 2));
    if (all[size - 2] != (crc & 0xff) || all[size - 1] != crc >> 8) return false;
    out.id = all[4];
    out.instruction = all[7];
    out.parameters = 0;
    const std::span<const std::uint8_t> body = all.subspan(kDxlHead_bytes - 1, size - kDxlHead_bytes - 1);
    for (std::size_t i = 1; i < body.size(); ++i) {
        if (body[i] == 0xfd && ends_in_header(body.first(i))) continue;
        if (out.parameters == kMostDynamixelParameters) return false;
        out.parameter[out.parameters++] = body[i];
    }
    return out.instruction != kDynamixelStatus || out.parameters > 0;
}

}  // namespace

std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc) noexcept {
    unsigned value = crc;
    for (const std::uint8_t byte : bytes) {
        value ^= static_cast<unsigned>(byte) << 8;
        for (int bit = 0; bit < 8; ++bit) value = (value & 0x8000u) != 0 ? (value << 1) ^ 0x8005u : value << 1;
    }
    return static_cast<std::uint16_t>(value);
}

DynamixelPacket encode_dynamixel_ping(int id) noexcept { return make_packet(id, kDynamixelPing, {}); }

DynamixelPacket encode_dynamixel_read(int id, DynamixelItem item) noexcept {
    std::array<std::uint8_t, 4> parameters;
    std::uint8_t* to = parameters.data();
    put_value(item.address, 2, to);
    put_value(item.bytes, 2, to);
    return make_packet(id, kDynamixelRead, parameters);
}

DynamixelPacket encode_dynamixel_write(int id, DynamixelItem item, std::int32_t value) noexcept {
    std::array<std::uint8_t, 6> parameters{};
    std::uint8_t* to = parameters.data();
    put_value(item.address, 2, to);
    put_value(value, std::min<std::size_t>(item.bytes, 4), to);
    return make_packet(id, kDynamixelWrite, std::span(parameters).first(2u + std::min<std::size_t>(item.bytes, 4)));
}

DynamixelPacket encode_dynamixel_sync_write(DynamixelItem item, std::span<const int> ids,
                                            std::span<const std::int32_t> values) noexcept {
    constexpr std::size_t kMostServos = 16;
    assert(ids.size() == values.size() && ids.size() <= kMostServos && item.bytes <= 4);
    std::array<std::uint8_t, 4 + 5 * kMostServos> parameters{};
    std::uint8_t* to = parameters.data();
    put_value(item.address, 2, to);
    put_value(item.bytes, 2, to);
    for (std::size_t i = 0; i < ids.size(); ++i) {
        *to++ = static_cast<std::uint8_t>(ids[i]);
        put_value(values[i], item.bytes, to);
    }
    return make_packet(kDynamixelAll, kDynamixelSyncWrite,
                       {parameters.data(), static_cast<std::size_t>(to - parameters.data())});
}

DynamixelPacket encode_dynamixel_status(int id, std::uint8_t error, std::span<const std::uint8_t> parameters) noexcept {
    std::array<std::uint8_t, kMostDynamixelParameters> all{};
    all[0] = error;
    const std::size_t count = std::min(parameters.size(), all.size() - 1);
    std::copy_n(parameters.begin(), count, all.begin() + 1);
    return make_packet(id, kDynamixelStatus, std::span(all).first(1 + count));
}

bool feed(std::uint8_t byte, DynamixelParser& parser, DynamixelMessage& out) noexcept {
    if (parser.size == parser.bytes.size()) drop_to_header(parser);  // cannot be: every packet is shorter
    parser.bytes[parser.size++] = byte;
    while (parser.size > 0) {
        const std::size_t wanted = expected_size(parser);
        if (wanted == 1) {
            parser.malformed += parser.size >= 7;
            drop_to_header(parser);
            continue;
        }
        if (wanted == 0 || parser.size < wanted) return false;
        const bool good = unpack(parser, wanted, out);
        if (good) {
            // what follows came with a false header before this packet, and is kept
            std::copy(parser.bytes.begin() + static_cast<std::ptrdiff_t>(wanted),
                      parser.bytes.begin() + static_cast<std::ptrdiff_t>(parser.size), parser.bytes.begin());
            parser.size -= wanted;
            ++parser.packets;
            return true;
        }
        ++parser.malformed;
        drop_to_header(parser);
    }
    return false;
}

std::int32_t dynamixel_value(std::span<const std::uint8_t> bytes) noexcept {
    std::uint32_t bits = 0;
    const std::size_t count = std::min<std::size_t>(bytes.size(), 4);
    for (std::size_t i = 0; i < count; ++i) bits |= static_cast<std::uint32_t>(bytes[i]) << (8 * i);
    if (count == 2) return static_cast<std::int16_t>(bits);
    return static_cast<std::int32_t>(bits);
}

}  // namespace palpa::devices
