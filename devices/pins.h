#pragma once
// A shape display: pins on RC servos, driven by Pololu Maestro boards (devices/maestro.h; docs/tactile.md). A servo reports
// nothing: where a pin is can only be estimated.
// Tried with devices/simulators only, not with pins.

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <span>
#include <string>
#include <vector>

#include "devices/maestro.h"

namespace palpa::devices {

inline constexpr std::size_t kMostPins = 144;
inline constexpr std::size_t kMostBoards = 12;

struct PinServo {
    int board = 0;  // index into PinDevice::boards
    int channel = 0;
    double zero_us = 1300.0;   // pulse at height 0, the lowest
    double us_per_mm = 200.0;  // > 0
    double direction = 1.0;    // 1: a longer pulse is higher; -1: lower
};

struct PinBoard {
    MaestroAddress address;
    int channels = 18;
    int first = 0;  // channels that carry pins: a row without gaps
    int count = 0;
};

// The device file, assets/devices/pins-6x6.json.
struct PinDevice {
    std::string name;
    std::string port;  // of the chain
    int baud = 115200;
    bool detect_baud = true;  // the boards wait for a byte 0xAA
    double timeout_s = 0.1;   // that is set in the boards; Palpa proves it before it drives them
    int rows = 6;
    int columns = 6;
    double pitch_m = 2e-3;
    double diameter_m = 1e-3;
    double stroke_m = 2e-3;
    double step_m = 1e-4;
    double speed_m_per_s = 0.03;
    double rest_m = 0.0;       // height of the pins at rest, where the boards' home must be
    double frame_s = 0.02;     // from one set of targets to the next
    double lowest_us = 992.0;  // range of the pulses
    double highest_us = 2000.0;
    std::vector<PinBoard> boards;
    std::vector<PinServo> pins;  // rows x columns, row by row
};

// Throws InputError with file and key: among others two pins on one channel, a channel that the board does not have, a
// stroke that leaves the range of the pulses, gaps between a board's channels, two chained boards of one number.
PinDevice read_pin_device(const std::filesystem::path& path);
void write_pin_device(const PinDevice& device, const std::filesystem::path& path);

// Height (m, 0 the lowest) to pulse in quarter microseconds and back. Heights are limited to the stroke; one that is not
// finite becomes the rest.
std::uint16_t quarter_us_of(const PinDevice& device, const PinServo& pin, double height_m) noexcept;
double height_m_of(const PinServo& pin, double quarter_us) noexcept;

// The bytes of one frame: the targets of every board.
struct PinFrame {
    std::array<std::uint8_t, kMostBoards*(6 + 2 * kMaestroChannels)> bytes{};
    std::size_t size = 0;
    std::span<const std::uint8_t> view() const { return {bytes.data(), size}; }
};
void pin_frame(const PinDevice& device, std::span<const double> heights_m, PinFrame& out) noexcept;

// What a board has said.
struct BoardHealth {
    int device = 0;
    bool answers = false;
    bool timeout = false;            // it went home by itself when the line fell silent
    bool crc = false;                // it refuses garbled commands
    std::uint16_t errors = 0;        // all bits since the start, but those that the proof provokes
    std::int64_t error_replies = 0;  // questions that found errors
    std::int64_t missing = 0;        // questions without a reply
};

enum class PinState : std::uint8_t {
    proving,  // the boards are asked whether they are safe; the pins rest
    driving,
    gone,        // the port is unplugged
    no_answer,   // a board does not answer
    no_timeout,  // a board would hold its pins when Palpa is gone
    no_crc,      // a board would take garbled targets
    faulty,      // a board has found errors in each of its last twenty replies
};

struct PinHealth {
    PinState state = PinState::proving;
    bool resting = true;  // nothing was sent to it for 100 ms
    std::int64_t frames = 0;
    std::int64_t late_frames = 0;  // by more than half a frame
    std::int64_t reconnects = 0;
    std::int64_t unasked = 0;    // bytes that nobody had asked for
    std::int64_t malformed = 0;  // replies with a value that does not exist
    std::array<BoardHealth, kMostBoards> board{};
    std::size_t boards = 0;
};

// Drives the pins from a thread of its own: it proves timeout and CRC of every board, falling silent once, then writes a
// frame of targets as often as the line allows (write_period_s() in pin_line.h) and asks one board for its errors in each.
// If send() is not called for 100 ms, the pins rest. Boards that are not safe are not driven. Twice a second a port that was
// unplugged is opened again, and boards that do not answer or are not safe are proved again.
class PinDriver {
  public:
    // Throws std::runtime_error with the system's reason if the port cannot be opened.
    explicit PinDriver(const PinDevice& device);
    ~PinDriver();  // the pins rest
    PinDriver(const PinDriver&) = delete;
    PinDriver& operator=(const PinDriver&) = delete;

    // Heights of all pins, row by row. The latest ones count; a frame may mix those of two neighbouring calls. Never waits.
    void send(std::span<const double> heights_m) noexcept;
    PinState state() const noexcept;  // never waits
    PinHealth health() const;
    const PinDevice& device() const;

  private:
    struct Works;
    std::unique_ptr<Works> works_;
};

}  // namespace palpa::devices
