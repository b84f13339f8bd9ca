#include "devices/simulators/maestro_board.h"

#include <algorithm>
#include <cmath>
#include <random>

namespace palpa::devices::simulators {
namespace {

void raise(std::uint16_t error, SimulatedBoard& board) {
    board.errors = static_cast<std::uint16_t>(board.errors | error);
    ++board.error_events;
    for (std::size_t i = 0; i < board.servo.size(); ++i) board.servo[i].target = board.home[i];
}

// Bytes of data after the command byte; -1: no such command, -2: not known before the next byte.
int data_bytes(std::uint8_t compact, const SimulatedBoard& board, std::size_t data_at) {
    switch (compact) {
        case 0x84:
        case 0x87:
        case 0x89:
            return 3;
        case 0x90:
            return 1;
        case 0x93:
        case 0xa1:
        case 0xa2:
            return 0;
        case 0x9f:
            return board.size > data_at ? 2 + 2 * board.packet[data_at] : -2;
        default:
            return -1;
    }
}

int value14(const std::uint8_t* bytes) { return bytes[0] | bytes[1] << 7; }

void reply16(int value, MaestroBoards& boards) {
    boards.out.push_back(static_cast<std::uint8_t>(value & 0xff));
    boards.out.push_back(static_cast<std::uint8_t>(value >> 8));
}

bool is_moving(const SimulatedBoard& board) {
    return std::any_of(board.servo.begin(), board.servo.end(),
                       [](const SimulatedServo& servo) { return servo.target != 0.0 && servo.pulse != servo.target; });
}

void set_target(int target, std::size_t channel, const MaestroBoards& boards, SimulatedBoard& board) {
    const double lowest = 4.0 * boards.device.lowest_us, highest = 4.0 * boards.device.highest_us;
    board.servo[channel].target = target == 0 ? 0.0 : std::clamp<double>(target, lowest, highest);
}

void carry_out(std::uint8_t compact, const std::uint8_t* data, SimulatedBoard& board, MaestroBoards& boards) {
    const auto channels = static_cast<std::size_t>(board.channels);
    const bool to_channel = compact == 0x84 || compact == 0x87 || compact == 0x89 || compact == 0x90;
    if (to_channel && data[0] >= channels) return raise(kMaestroProtocol, board);
    switch (compact) {
        case 0x84:
            return set_target(value14(data + 1), data[0], boards, board);
        case 0x87:
            board.servo[data[0]].speed = value14(data + 1);
            return;
        case 0x89:
            board.servo[data[0]].acceleration = value14(data + 1);
            return;
        case 0x90:
            return reply16(static_cast<int>(std::lround(board.servo[data[0]].pulse)), boards);
        case 0x93:
            return boards.out.push_back(is_moving(board) ? 1 : 0);
        case 0x9f:
            if (static_cast<std::size_t>(data[0]) + data[1] > channels) return raise(kMaestroProtocol, board);
            for (std::size_t i = 0; i < data[0]; ++i) set_target(value14(data + 2 + 2 * i), data[1] + i, boards, board);
            return;
        case 0xa1:
            reply16(board.errors, boards);
            board.errors = 0;
            return;
        case 0xa2:
            for (std::size_t i = 0; i < channels; ++i) board.servo[i].target = board.home[i];
            return;
        default:
            return;
    }
}

// Looks at the command as far as it has arrived, and carries it out when it is whole.
void look(SimulatedBoard& board, MaestroBoards& boards) {
    const bool pololu = board.packet[0] == 0xaa;
    const std::size_t command_at = pololu ? 2 : 0;
    if (board.size <= command_at) {
        if (pololu && board.size == 2) board.foreign = board.packet[1] != board.address.device;
        return;
    }
    const auto compact = static_cast<std::uint8_t>(board.packet[command_at] | 0x80);
    const int data = data_bytes(compact, board, command_at + 1);
    const std::size_t most = board.packet.size() - command_at - 2;
    if (data == -1 || (data >= 0 && static_cast<std::size_t>(data) > most)) {
        if (!board.foreign) raise(kMaestroProtocol, board);
        board.size = 0;
        return;
    }
    const std::size_t wanted =
        command_at + 1 + static_cast<std::size_t>(std::max(data, 0)) + (boards.settings.crc ? 1 : 0);
    if (data < 0 || board.size < wanted) return;
    const std::size_t size = board.size;
    board.size = 0;
    if (board.foreign) return;
    if (boards.settings.crc && crc7(std::span(board.packet.data(), size - 1)) != board.packet[size - 1])
        return raise(kMaestroCrc, board);
    board.heard_s = boards.time_s;
    board.timed_out = false;
    ++board.commands;
    carry_out(compact, board.packet.data() + command_at + 1, board, boards);
}

void take_byte(std::uint8_t byte, SimulatedBoard& board, MaestroBoards& boards) {
    const bool begins = byte >= 0x80;
    if (begins) {
        if (board.size > 0 && !board.foreign) raise(kMaestroProtocol, board);  // an interrupted command
        board.size = 0;
        board.foreign = false;
    } else if (board.size == 0) {
        if (!board.foreign) raise(kMaestroProtocol, board);  // data of no command
        return;
    }
    board.packet[board.size++] = byte;
    look(board, boards);
}

// One pulse: it goes towards the target no faster than the limit.
void send_pulse(double frame_s, SimulatedServo& servo) {
    if (servo.target == 0.0 || servo.pulse == 0.0 || servo.speed == 0) {
        servo.pulse = servo.target;
        return;
    }
    const double most = servo.speed * frame_s / 0.01;
    servo.pulse += std::clamp(servo.target - servo.pulse, -most, most);
}

void move_pin(const MaestroSettings& settings, double dt_s, double pulse, double stroke_m, SimulatedPin& pin) {
    if (pin.stuck || pulse == 0.0) return;  // a servo without pulses is limp, and friction holds the pin
    const double wanted_m = std::clamp(height_m_of(pin.truth, pulse), -0.1 * stroke_m, 1.1 * stroke_m);
    const double most_m = settings.pin_speed_m_per_s * dt_s;
    const double share = -std::expm1(-dt_s / settings.servo_lag_s);
    pin.height_m += std::clamp(share * (wanted_m - pin.height_m), -most_m, most_m);
}

void small_step(double dt_s, MaestroBoards& boards) {
    boards.time_s += dt_s;
    const double timeout_s = boards.settings.timeout_s;
    for (SimulatedBoard& board : boards.board) {
        if (timeout_s <= 0.0 || board.timed_out || boards.time_s - board.heard_s <= timeout_s) continue;
        board.timed_out = true;
        ++board.timeouts;
        raise(kMaestroTimeout, board);
    }
    if (boards.time_s >= boards.frame_due_s) {
        boards.frame_due_s += boards.settings.frame_s;
        for (SimulatedBoard& board : boards.board) {
            for (SimulatedServo& servo : board.servo) send_pulse(boards.settings.frame_s, servo);
        }
    }
    for (SimulatedPin& pin : boards.pin) {
        const SimulatedBoard& board = boards.board[static_cast<std::size_t>(pin.truth.board)];
        move_pin(boards.settings, dt_s, board.servo[static_cast<std::size_t>(pin.truth.channel)].pulse,
                 boards.device.stroke_m, pin);
    }
}

}  // namespace

MaestroBoards make_maestro_boards(const PinDevice& device, const MaestroSettings& settings, double scatter,
                                  std::uint64_t seed) {
    MaestroBoards boards;
    boards.device = device;
    boards.settings = settings;
    boards.baud_known = !device.detect_baud;
    for (const PinBoard& board : device.boards) {
        SimulatedBoard simulated;
        simulated.address = board.address;
        simulated.channels = board.channels;
        boards.board.push_back(simulated);
    }
    std::mt19937_64 random(seed);
    std::uniform_real_distribution<double> off(-scatter, scatter);
    for (const PinServo& pin : device.pins) {
        SimulatedBoard& board = boards.board[static_cast<std::size_t>(pin.board)];
        const auto channel = static_cast<std::size_t>(pin.channel);
        const double rest = quarter_us_of(device, pin, device.rest_m);
        board.home[channel] = board.servo[channel].target = board.servo[channel].pulse = rest;
        SimulatedPin simulated{pin, 0.0, false};
        if (scatter > 0.0) {
            simulated.truth.zero_us += off(random) * pin.us_per_mm * 1e3 * device.stroke_m;
            simulated.truth.us_per_mm *= 1.0 + off(random);
        }
        simulated.height_m = height_m_of(simulated.truth, rest);
        boards.pin.push_back(simulated);
    }
    return boards;
}

void take_bytes(std::span<const std::uint8_t> bytes, MaestroBoards& boards) {
    for (const std::uint8_t byte : bytes) {
        if (!boards.baud_known) {
            boards.baud_known = byte == kMaestroBaudByte;
            continue;
        }
        for (SimulatedBoard& board : boards.board) take_byte(byte, board, boards);
    }
}

void advance(double dt_s, MaestroBoards& boards) {
    constexpr double kSmall_s = 1e-3;
    const auto steps = static_cast<int>(std::ceil(dt_s / kSmall_s - 1e-9));
    for (int i = 0; i < steps; ++i) small_step(dt_s / steps, boards);
}

}  // namespace palpa::devices::simulators
