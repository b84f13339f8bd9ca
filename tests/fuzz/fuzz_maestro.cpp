// The bytes of a line of Maestro boards, both ways: replies as the driver takes them, commands as the simulated boards do.

#include "devices/maestro.h"
#include "devices/simulators/maestro_board.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

namespace {

void take_replies(const std::uint8_t* data, std::size_t size) {
    MaestroReplyParser parser;
    for (std::size_t i = 0; i < size; ++i) {
        if (parser.awaited == MaestroReply::none) await(static_cast<MaestroReply>(1 + i % 3), parser);
        const MaestroReply awaited = parser.awaited;
        std::uint16_t value = 0;
        if (!feed(data[i], parser, value)) continue;
        const bool wrong = (awaited == MaestroReply::errors && value > kMaestroErrors) ||
                           (awaited == MaestroReply::position && value >= 1 << 14) ||
                           (awaited == MaestroReply::moving && value > 1);
        if (wrong) fuzz::finding("a reply with a value that does not exist");
    }
    if (parser.have > 1 || parser.replies < 0) fuzz::finding("a reply longer than it is");
}

void take_commands(const std::uint8_t* data, std::size_t size, bool crc) {
    PinDevice device;
    device.rows = device.columns = 1;
    device.boards = {PinBoard{{12, true, crc}, 18, 0, 1}, PinBoard{{13, true, crc}, 6, 0, 0}};
    device.pins = {PinServo{}};
    simulators::MaestroSettings settings;
    settings.crc = crc;
    simulators::MaestroBoards boards = simulators::make_maestro_boards(device, settings, 0.0, 1);
    boards.baud_known = true;
    simulators::take_bytes({data, size}, boards);
    simulators::advance(0.005, boards);
    for (const simulators::SimulatedBoard& board : boards.board) {
        if (board.size > board.packet.size()) fuzz::finding("a command longer than its buffer");
        for (const simulators::SimulatedServo& servo : board.servo) {
            const bool off = servo.target == 0.0;
            const bool in_range = servo.target >= 4.0 * device.lowest_us && servo.target <= 4.0 * device.highest_us;
            if (!off && !in_range) fuzz::finding("a target out of range");
        }
    }
}

}  // namespace

PALPA_FUZZ_ENTRY(maestro)(const std::uint8_t* data, std::size_t size) {
    take_replies(data, size);
    take_commands(data, size, false);
    take_commands(data, size, true);
    return 0;
}
