#include "devices/pin_line.h"

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <optional>
#include <thread>

#include "devices/force_sensor.h"

namespace palpa::devices {
namespace {

constexpr double kReply_s = 0.05;  // 7 bytes at 9600 baud take 7 ms; the rest is for a busy computer

void drain(PinLine& line) {
    std::array<std::uint8_t, 64> bytes;
    std::uint16_t ignored = 0;
    for (int n = 1; n > 0;) {
        n = line.port.read(0.0, bytes.data(), bytes.size());
        line.gone = line.gone || n < 0;
        for (int i = 0; i < n; ++i) feed(bytes[static_cast<std::size_t>(i)], line.parser, ignored);
    }
}

bool take_reply(double wait_s, PinLine& line, std::uint16_t& value) {
    const double until_s = steady_s() + wait_s;
    for (double left_s = wait_s; left_s > 0.0 && !line.gone; left_s = until_s - steady_s()) {
        std::uint8_t byte = 0;
        const int n = line.port.read(left_s, &byte, 1);
        line.gone = n < 0;
        if (n != 1) continue;
        if (feed(byte, line.parser, value)) return true;
        if (line.parser.awaited == MaestroReply::none) return false;  // malformed
    }
    return false;
}

// Asks again a few times: right after the opening, a board may still hold the half of an older command.
bool ask_patiently(const MaestroAddress& to, PinLine& line, std::uint16_t& errors) {
    for (int i = 0; i < 3 && !line.gone; ++i) {
        if (ask_errors(to, kReply_s, line, errors)) return true;
    }
    return false;
}

// A board that checks CRCs drops the question and has the error; one that does not, answers it. Nothing if neither was seen
// in a few questions, as on a line that loses or changes bytes.
std::optional<bool> refuses_wrong_crc(const MaestroAddress& to, PinLine& line) {
    MaestroPacket wrong = encode_get_errors(to);
    wrong.bytes[wrong.size - 1] ^= 0x55;
    for (int i = 0; i < 5 && !line.gone; ++i) {
        drain(line);
        await(MaestroReply::errors, line.parser);
        std::uint16_t errors = 0;
        if (write_line(wrong.view(), line) && take_reply(kReply_s, line, errors)) return false;
        await(MaestroReply::none, line.parser);
        if (ask_patiently(to, line, errors) && (errors & kMaestroCrc) != 0) return true;
    }
    return std::nullopt;
}

}  // namespace

double write_period_s(const PinDevice& device) noexcept {
    constexpr double kBitsPerByte = 10.0;
    constexpr std::size_t kQuestion_bytes = 5 + 2;  // for a board's errors, and the reply
    constexpr double kShare = 0.8;
    std::size_t bytes = kQuestion_bytes;
    for (const PinBoard& board : device.boards) bytes += 6 + 2 * static_cast<std::size_t>(board.count);
    const double line_s = kBitsPerByte * static_cast<double>(bytes) / device.baud;
    return std::clamp(line_s / kShare, 0.25 * device.frame_s, device.frame_s);
}

bool write_line(std::span<const std::uint8_t> bytes, PinLine& line) noexcept {
    line.gone = line.gone || !line.port.write(bytes.data(), bytes.size());
    return !line.gone;
}

bool ask_errors(const MaestroAddress& to, double wait_s, PinLine& line, std::uint16_t& errors) {
    drain(line);
    await(MaestroReply::errors, line.parser);
    const bool replied = write_line(encode_get_errors(to).view(), line) && take_reply(wait_s, line, errors);
    if (!replied) await(MaestroReply::none, line.parser);
    return replied;
}

bool set_speeds(const PinDevice& device, PinLine& line) {
    for (const PinServo& pin : device.pins) {
        // quarter microseconds per 10 ms
        const double speed = std::ceil(4.0 * pin.us_per_mm * 1e3 * device.speed_m_per_s * 0.01);
        const MaestroAddress& to = device.boards[static_cast<std::size_t>(pin.board)].address;
        const int limit = static_cast<int>(std::clamp(speed, 1.0, 16383.0));
        if (!write_line(encode_speed(to, pin.channel, limit).view(), line)) return false;
    }
    return true;
}

void prove_boards(const PinDevice& device, PinLine& line, std::span<BoardHealth> boards) {
    if (device.detect_baud) write_line(std::span(&kMaestroBaudByte, 1), line);
    std::uint16_t errors = 0;
    for (std::size_t i = 0; i < boards.size(); ++i) {
        const MaestroAddress& to = device.boards[i].address;
        boards[i].device = to.device;
        boards[i].timeout = false;
        boards[i].answers = ask_patiently(to, line, errors);
    }
    for (std::size_t i = 0; i < boards.size(); ++i) {
        const MaestroAddress& to = device.boards[i].address;
        boards[i].crc = false;
        if (!boards[i].answers || !to.crc) continue;
        const std::optional<bool> refuses = refuses_wrong_crc(to, line);
        boards[i].crc = refuses.value_or(false);
        boards[i].answers = refuses.has_value();
    }
    for (std::size_t i = 0; i < boards.size(); ++i) {
        if (boards[i].answers) ask_patiently(device.boards[i].address, line, errors);  // what the proof itself provoked
    }
    if (line.gone) return;
    const double silent_s = 1.5 * device.timeout_s + 2.0 * device.frame_s;
    std::this_thread::sleep_for(std::chrono::duration<double>(silent_s));
    for (std::size_t i = 0; i < boards.size(); ++i) {
        if (!boards[i].answers || !ask_patiently(device.boards[i].address, line, errors)) continue;
        boards[i].timeout = (errors & kMaestroTimeout) != 0;
        boards[i].errors = static_cast<std::uint16_t>(boards[i].errors | (errors & ~kMaestroTimeout));
    }
}

PinState state_of(const PinDevice& device, const PinLine& line, std::span<const BoardHealth> boards) {
    if (line.gone) return PinState::gone;
    PinState state = PinState::driving;
    for (std::size_t i = 0; i < boards.size(); ++i) {
        if (!boards[i].answers) return PinState::no_answer;
        if (!boards[i].timeout) state = PinState::no_timeout;
        if (state == PinState::driving && device.boards[i].address.crc && !boards[i].crc) state = PinState::no_crc;
    }
    return state;
}

}  // namespace palpa::devices
