#pragma once
// A simulated board that speaks our frames (devices/framed.h): bytes in, bytes out, outputs. A model without clock or port.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "devices/framed.h"

namespace palpa::devices::simulators {

struct FramedBoard {
    BoardState state = BoardState::relaxed;
    double timeout_s = kFramedTimeout_s;  // 0: a board without a watchdog
    std::size_t outputs = 0;              // of the last `set`
    std::array<std::int32_t, kMostFramedValues> output{};
    double heard_s = 0.0;
    double time_s = 0.0;
    FrameParser parser;
    std::int64_t timeouts = 0;
    std::vector<std::uint8_t> out;
};

void take_bytes(std::span<const std::uint8_t> bytes, FramedBoard& board);
void advance(double dt_s, FramedBoard& board);

}  // namespace palpa::devices::simulators
