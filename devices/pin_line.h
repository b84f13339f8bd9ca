#pragma once
// The serial line of a shape display's boards: questions and answers, and the proof that the boards are safe. It waits, so
// it belongs to a thread of its own or to a command.

#include <memory>
#include <span>

#include "devices/pins.h"
#include "platform/serial_port.h"

namespace palpa::devices {

struct PinLine {
    platform::SerialPort port;
    MaestroReplyParser parser{};
    bool gone = false;

    // Throws std::runtime_error with the system's reason.
    explicit PinLine(const PinDevice& device) : port(device.port, device.baud) {}
};

// Time from one set of targets to the next on the line. The boards take the latest targets once per frame, at moments that
// nobody knows: the more often targets are written, the newer those that they take. A quarter of a frame, or as often as
// 0.8 of the line's time allows, and once per frame at least.
double write_period_s(const PinDevice& device) noexcept;

bool write_line(std::span<const std::uint8_t> bytes, PinLine& line) noexcept;

// Asks a board for its errors, which clears them. Returns false if no sensible reply came within wait_s.
bool ask_errors(const MaestroAddress& to, double wait_s, PinLine& line, std::uint16_t& errors);

// Sets the speed limit of every pin's channel to the device's speed.
bool set_speeds(const PinDevice& device, PinLine& line);

// Proves each board, and fills `boards` (device.boards.size() of them): it answers; it refuses a command with a wrong CRC,
// where the device file wants CRCs; its timeout fires when the line is silent for one and a half times as long. The settings
// that make a board safe cannot be read over the line, so this is the only way to know them. The pins go to their home.
void prove_boards(const PinDevice& device, PinLine& line, std::span<BoardHealth> boards);

// What a proof means: driving, gone, no_answer, no_timeout or no_crc.
PinState state_of(const PinDevice& device, const PinLine& line, std::span<const BoardHealth> boards);

}  // namespace palpa::devices
