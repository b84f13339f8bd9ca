#include "devices/pins.h"

#include <algorithm>
#include <cassert>
#include <cmath>

namespace palpa::devices {
namespace {

constexpr double kQuarters_per_us = 4.0;
constexpr double kMm_per_m = 1e3;
constexpr int kFewChannels = 6;  // the Micro Maestro does not know Set Multiple Targets

void append(const MaestroPacket& packet, PinFrame& out) {
    assert(out.size + packet.size <= out.bytes.size());
    const auto view = packet.view();
    std::copy(view.begin(), view.end(), out.bytes.begin() + static_cast<std::ptrdiff_t>(out.size));
    out.size += packet.size;
}

}  // namespace

std::uint16_t quarter_us_of(const PinDevice& device, const PinServo& pin, double height_m) noexcept {
    const double known_m = std::isfinite(height_m) ? height_m : device.rest_m;
    const double height_mm = kMm_per_m * std::clamp(known_m, 0.0, device.stroke_m);
    const double pulse_us = pin.zero_us + pin.direction * pin.us_per_mm * height_mm;
    const double safe_us = std::clamp(pulse_us, device.lowest_us, device.highest_us);
    return static_cast<std::uint16_t>(std::lround(kQuarters_per_us * safe_us));
}

double height_m_of(const PinServo& pin, double quarter_us) noexcept {
    return (quarter_us / kQuarters_per_us - pin.zero_us) / (pin.direction * pin.us_per_mm * kMm_per_m);
}

void pin_frame(const PinDevice& device, std::span<const double> heights_m, PinFrame& out) noexcept {
    assert(heights_m.size() == device.pins.size());
    out.size = 0;
    std::array<std::array<std::uint16_t, kMaestroChannels>, kMostBoards> target{};
    for (std::size_t i = 0; i < device.pins.size(); ++i) {
        const PinServo& pin = device.pins[i];
        target[static_cast<std::size_t>(pin.board)][static_cast<std::size_t>(pin.channel)] =
            quarter_us_of(device, pin, heights_m[i]);
    }
    for (std::size_t b = 0; b < device.boards.size(); ++b) {
        const PinBoard& board = device.boards[b];
        if (board.count == 0) continue;
        const auto first = static_cast<std::size_t>(board.first);
        const auto count = static_cast<std::size_t>(board.count);
        if (board.channels > kFewChannels) {
            append(encode_targets(board.address, board.first, std::span(target[b].data() + first, count)), out);
            continue;
        }
        for (std::size_t c = first; c < first + count; ++c)
            append(encode_target(board.address, static_cast<int>(c), target[b][c]), out);
    }
}

}  // namespace palpa::devices
