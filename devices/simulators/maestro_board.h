#pragma once
// Simulated Maestro boards on one line with the servos and pins behind them: bytes in, bytes out, true heights. A model
// without clock or port: the program maestro_simulator and a run in virtual time both advance it.
//
// Modelled: compact and Pololu protocol, CRC-7, the error register, the serial timeout, homes, targets in quarter
// microseconds, the speed limit, one pulse every 20 ms, a servo of first order (12 ms) with a greatest speed. Assumed, not
// measured: the servo, and that targets are taken while an error is set.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "devices/pins.h"

namespace palpa::devices::simulators {

struct MaestroSettings {     // those that stand in a board and not on the line
    double timeout_s = 0.1;  // 0: none
    bool crc = true;
    double frame_s = 0.02;
    double servo_lag_s = 0.012;
    double pin_speed_m_per_s = 0.03;
};

struct SimulatedServo {
    double target = 0.0;   // quarter microseconds; 0: off
    double pulse = 0.0;    // being sent
    int speed = 0;         // quarter microseconds per 10 ms; 0: unlimited
    int acceleration = 0;  // kept, not modelled
};

struct SimulatedBoard {
    MaestroAddress address;
    int channels = 18;
    std::uint16_t errors = 0;
    double heard_s = 0.0;  // last valid command
    bool timed_out = false;
    std::array<std::uint8_t, 64> packet{};  // bytes of the command that is arriving
    std::size_t size = 0;
    bool foreign = false;  // of another board
    std::array<SimulatedServo, kMaestroChannels> servo{};
    std::array<double, kMaestroChannels> home{};  // quarter microseconds
    std::int64_t commands = 0;
    std::int64_t error_events = 0;
    std::int64_t timeouts = 0;
};

struct SimulatedPin {
    PinServo truth;  // what its pulse really means; the device file may be wrong about it
    double height_m = 0.0;
    bool stuck = false;
};

struct MaestroBoards {
    PinDevice device;
    MaestroSettings settings;
    std::vector<SimulatedBoard> board;
    std::vector<SimulatedPin> pin;  // rows x columns
    bool baud_known = false;
    double time_s = 0.0;
    double frame_due_s = 0.0;
    std::vector<std::uint8_t> out;  // replies that nobody has taken
};

// scatter: share by which the pins' true gains differ from the device file's, and the zeros by as much of the stroke, by
// the seed; 0: the device file is right.
MaestroBoards make_maestro_boards(const PinDevice& device, const MaestroSettings& settings, double scatter,
                                  std::uint64_t seed);

void take_bytes(std::span<const std::uint8_t> bytes, MaestroBoards& boards);
void advance(double dt_s, MaestroBoards& boards);  // in steps of 1 ms at most

}  // namespace palpa::devices::simulators
