#pragma once
// CRC-16 with the polynomial 0x8005, most significant bit first, start 0: that of Dynamixel 2.0 and of our own frames.

#include <cstdint>
#include <span>

namespace palpa::devices {

// Continues from `crc`.
std::uint16_t crc16(std::span<const std::uint8_t> bytes, std::uint16_t crc = 0) noexcept;

}  // namespace palpa::devices
