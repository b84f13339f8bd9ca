#pragma once
// Dynamixel servos, protocol 2.0: packets without a port.
//
// Supported: ping, read, write and sync write of the X series' control table, status packets, byte stuffing. Not
// supported: protocol 1.0, bulk and fast instructions, firmware of other series with another control table.
// Sources: ROBOTIS e-manual, "Protocol 2.0" (packets, CRC, stuffing) and the control table of the X series (addresses, bus
// watchdog). Tried with devices/simulators only, not with a servo.

#include <array>
#include <cstddef>
#include <cstdint>
#include <span>

namespace palpa::devices {

inline constexpr std::size_t kMostDynamixelParameters = 128;
inline constexpr std::size_t kMostDynamixel_bytes = 16 + kMostDynamixelParameters + kMostDynamixelParameters / 3;
inline constexpr int kDynamixelAll = 0xfe;  // every servo of the line, none answers
inline constexpr int kMostDynamixelId = 252;

enum DynamixelInstruction : std::uint8_t {
    kDynamixelPing = 0x01,
    kDynamixelRead = 0x02,
    kDynamixelWrite = 0x03,
    kDynamixelStatus = 0x55,
    kDynamixelSyncWrite = 0x83,
};

// Addresses of the control table, and how many bytes stand there.
struct DynamixelItem {
    std::uint16_t address;
    std::uint16_t bytes;
};
inline constexpr DynamixelItem kDxlMode{11, 1};  // DynamixelMode; only while the torque is off
inline constexpr DynamixelItem kDxlTorque{64, 1};
inline constexpr DynamixelItem kDxlHardwareError{70, 1};
inline constexpr DynamixelItem kDxlWatchdog{98, 1};  // unit 20 ms; 0: off; 255: it has fired
inline constexpr DynamixelItem kDxlGoalCurrent{102, 2};
inline constexpr DynamixelItem kDxlGoalPosition{116, 4};
inline constexpr DynamixelItem kDxlPresent{126, 10};  // current (2), velocity (4), position (4)
inline constexpr double kDxlWatchdogUnit_s = 0.02;
inline constexpr std::uint8_t kDxlWatchdogFired = 0xff;

enum DynamixelMode : std::uint8_t { kDxlCurrent = 0, kDxlPositionWithinCurrent = 5 };

struct DynamixelPacket {
    std::array<std::uint8_t, kMostDynamixel_bytes> bytes{};
    std::size_t size = 0;
    std::span<const std::uint8_t> view() const { return {bytes.data(), size}; }
};

// A value of the control table, least significant byte first. Negative ones are two's complements.
DynamixelPacket encode_dynamixel_ping(int id) noexcept;
DynamixelPacket encode_dynamixel_read(int id, DynamixelItem item) noexcept;
DynamixelPacket encode_dynamixel_write(int id, DynamixelItem item, std::int32_t value) noexcept;
// One value for each of several servos, that none answers. At most 16; as many values as ids (assert).
DynamixelPacket encode_dynamixel_sync_write(DynamixelItem item, std::span<const int> ids,
                                            std::span<const std::int32_t> values) noexcept;
DynamixelPacket encode_dynamixel_status(int id, std::uint8_t error, std::span<const std::uint8_t> parameters) noexcept;

// A packet as it came, with the stuffing undone. For a status packet, parameter[0] is its error.
struct DynamixelMessage {
    std::uint8_t id = 0;
    std::uint8_t instruction = 0;
    std::array<std::uint8_t, kMostDynamixelParameters> parameter{};
    std::size_t parameters = 0;
};

// Builds packets from bytes as they arrive. After a broken packet the bytes that it had swallowed are looked through for
// the next header, so that a false header costs no packet behind it.
struct DynamixelParser {
    std::array<std::uint8_t, kMostDynamixel_bytes> bytes{};
    std::size_t size = 0;
    std::int64_t packets = 0;
    std::int64_t malformed = 0;  // wrong CRCs, lengths that cannot be
};
// Returns true when `byte` completes a packet.
bool feed(std::uint8_t byte, DynamixelParser& parser, DynamixelMessage& out) noexcept;

// Little-endian value of up to four bytes, two's complement.
std::int32_t dynamixel_value(std::span<const std::uint8_t> bytes) noexcept;

}  // namespace palpa::devices
