// Maestro packets and replies, and the simulated boards that take them.

#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <string>

#include "devices/maestro.h"
#include "devices/simulators/maestro_board.h"
#include "tests/close_to.h"

using namespace palpa::devices;
using namespace palpa::devices::simulators;
using namespace palpa::test;

namespace {

std::string hex(std::span<const std::uint8_t> bytes) {
    std::string text;
    char two[4];
    for (const std::uint8_t byte : bytes) {
        std::snprintf(two, sizeof two, "%02X", byte);
        text += (text.empty() ? "" : " ") + std::string(two);
    }
    return text;
}

MaestroAddress compact_line() { return {12, false, true}; }
MaestroAddress chained_line(int device) { return {device, true, true}; }

PinDevice shipped_pins() { return read_pin_device(std::string(PALPA_SOURCE_DIR) + "/assets/devices/pins-6x6.json"); }

// Boards that know their baud rate and have no error.
MaestroBoards ready_boards(double timeout_s = 0.1) {
    MaestroSettings settings;
    settings.timeout_s = timeout_s;
    MaestroBoards boards = make_maestro_boards(shipped_pins(), settings, 0.0, 1);
    boards.baud_known = true;
    return boards;
}

std::vector<std::uint8_t> two_targets() {
    std::vector<std::uint8_t> bytes;
    for (const int device : {12, 13}) {
        const std::array<std::uint16_t, 2> quarters{6000, 5600};
        const MaestroPacket packet = encode_targets(chained_line(device), 3, quarters);
        bytes.insert(bytes.end(), packet.view().begin(), packet.view().end());
    }
    return bytes;
}

// Every pulse that a servo can get lies within the range of the pulses, or is off.
bool all_in_range(const MaestroBoards& boards) {
    for (const SimulatedBoard& board : boards.board) {
        for (const SimulatedServo& servo : board.servo) {
            const bool off = servo.target == 0.0;
            if (!off && !(servo.target >= 4.0 * 992.0 && servo.target <= 4.0 * 2000.0)) return false;
        }
    }
    return true;
}

}  // namespace

TEST_CASE("Maestro: packets and CRCs are byte for byte as documented") {
    // the maker's own examples first; the others were computed anew
    CHECK(crc7(std::array<std::uint8_t, 2>{0x83, 0x01}) == 0x17);
    CHECK(hex(encode_get_position(chained_line(1), 0).view()) == "AA 01 10 00 6B");
    CHECK(hex(encode_target(compact_line(), 0, 6000).view()) == "84 00 70 2E 2B");
    CHECK(hex(encode_target(chained_line(12), 0, 6000).view()) == "AA 0C 04 00 70 2E 22");
    const std::array<std::uint16_t, 2> off_and_middle{0, 6000};
    CHECK(hex(encode_targets(compact_line(), 3, off_and_middle).view()) == "9F 02 03 00 00 70 2E 24");
    CHECK(hex(encode_targets(chained_line(12), 3, off_and_middle).view()) == "AA 0C 1F 02 03 00 00 70 2E 28");
    CHECK(hex(encode_speed(compact_line(), 5, 140).view()) == "87 05 0C 01 59");
    CHECK(hex(encode_get_position(compact_line(), 0).view()) == "90 00 65");
    CHECK(hex(encode_get_moving(compact_line()).view()) == "93 13");
    CHECK(hex(encode_get_errors(compact_line()).view()) == "A1 1B");
    CHECK(hex(encode_go_home(compact_line()).view()) == "A2 49");
    CHECK(hex(encode_get_errors(chained_line(12)).view()) == "AA 0C 21 78");
    CHECK(hex(encode_go_home(chained_line(12)).view()) == "AA 0C 22 2A");
    CHECK(hex(encode_target({12, false, false}, 0, 6000).view()) == "84 00 70 2E");
}

TEST_CASE("Maestro: replies are taken when they were asked for, and only with values that exist") {
    MaestroReplyParser parser;
    std::uint16_t value = 0;
    CHECK_FALSE(feed(0x20, parser, value));
    CHECK(parser.unasked == 1);
    await(MaestroReply::errors, parser);
    CHECK_FALSE(feed(0x20, parser, value));
    CHECK(feed(0x00, parser, value));
    CHECK(value == kMaestroTimeout);
    await(MaestroReply::errors, parser);
    CHECK_FALSE(feed(0x00, parser, value));
    CHECK_FALSE(feed(0xfe, parser, value));  // bits that no board has
    CHECK(parser.malformed == 1);
    await(MaestroReply::position, parser);
    feed(0x70, parser, value);
    CHECK(feed(0x17, parser, value));
    CHECK(value == 6000);
    await(MaestroReply::moving, parser);
    CHECK(feed(1, parser, value));
    await(MaestroReply::errors, parser);
    feed(0x01, parser, value);  // the second byte is lost: the next question is not shifted by it
    await(MaestroReply::errors, parser);
    feed(0x00, parser, value);
    CHECK(feed(0x00, parser, value));
    CHECK(value == 0);
    CHECK(parser.replies == 4);
}

TEST_CASE("Maestro: one million random bytes give no reply out of range") {
    std::mt19937_64 random(1);
    MaestroReplyParser parser;
    int wrong = 0;
    for (int i = 0; i < 1000000; ++i) {
        if (random() % 3 == 0) await(static_cast<MaestroReply>(random() % 4), parser);
        const MaestroReply awaited = parser.awaited;
        std::uint16_t value = 0;
        if (!feed(static_cast<std::uint8_t>(random()), parser, value)) continue;
        wrong += awaited == MaestroReply::errors && value > kMaestroErrors;
        wrong += awaited == MaestroReply::position && value >= 1 << 14;
        wrong += awaited == MaestroReply::moving && value > 1;
        wrong += parser.have > 2;
    }
    CHECK(wrong == 0);
    CHECK(parser.replies > 1000);
}

TEST_CASE("Maestro boards: every split of the bytes gives the same targets") {
    const std::vector<std::uint8_t> bytes = two_targets();
    for (std::size_t split = 0; split <= bytes.size(); ++split) {
        CAPTURE(split);
        MaestroBoards boards = ready_boards();
        take_bytes(std::span(bytes).first(split), boards);
        take_bytes(std::span(bytes).subspan(split), boards);
        for (const SimulatedBoard& board : boards.board) {
            CHECK(board.servo[3].target == 6000.0);
            CHECK(board.servo[4].target == 5600.0);
            CHECK(board.errors == 0);
        }
    }
}

TEST_CASE("Maestro boards: bytes lost, doubled and garbled never move a pin; the error is reported and cleared") {
    const std::vector<std::uint8_t> bytes = two_targets();
    for (std::size_t i = 0; i < bytes.size() / 2; ++i) {  // of the first board's packet
        for (const int kind : {0, 1, 2}) {
            std::vector<std::uint8_t> spoiled = bytes;
            if (kind == 0) spoiled.erase(spoiled.begin() + static_cast<std::ptrdiff_t>(i));
            if (kind == 1) spoiled.insert(spoiled.begin() + static_cast<std::ptrdiff_t>(i), bytes[i]);
            if (kind == 2) spoiled[i] ^= 0x04;
            CAPTURE(i);
            CAPTURE(kind);
            MaestroBoards boards = ready_boards();
            const double home = boards.board[0].home[3];
            take_bytes(spoiled, boards);
            const bool harmless = kind == 1 && i == 0;  // a second AA only begins anew
            if (!harmless) CHECK(boards.board[0].servo[3].target == home);
            CHECK(all_in_range(boards));
            take_bytes(encode_get_errors(chained_line(12)).view(), boards);
            boards.out.clear();
            take_bytes(encode_get_errors(chained_line(12)).view(), boards);
            REQUIRE(boards.out.size() == 2);
            CHECK(boards.out[0] + boards.out[1] == 0);
            take_bytes(bytes, boards);
            CHECK(boards.board[0].servo[3].target == 6000.0);
        }
    }
}

TEST_CASE("Maestro boards: one million random bytes leave every target in range") {
    std::mt19937_64 random(7);
    MaestroBoards boards = ready_boards();
    for (int i = 0; i < 1000; ++i) {
        std::vector<std::uint8_t> bytes(1000);
        for (std::uint8_t& byte : bytes) {
            // often a sensible beginning, so that packets get far
            constexpr std::uint8_t kOften[] = {0xaa, 0x0c, 0x0d, 0x1f, 0x04, 0x9f, 0x84, 0x00};
            byte = random() % 2 == 0 ? kOften[random() % 8] : static_cast<std::uint8_t>(random());
        }
        take_bytes(bytes, boards);
        advance(0.001, boards);
        boards.out.clear();
        REQUIRE(all_in_range(boards));
    }
}

TEST_CASE(
    "Maestro boards: a silent line sends every servo home and sets the timeout's bit; without a timeout it does not") {
    for (const double timeout_s : {0.1, 0.0}) {
        CAPTURE(timeout_s);
        MaestroBoards boards = ready_boards(timeout_s);
        take_bytes(two_targets(), boards);
        advance(0.09, boards);
        CHECK(boards.board[0].servo[3].target == 6000.0);
        advance(0.03, boards);
        const bool home = boards.board[0].servo[3].target == boards.board[0].home[3];
        CHECK(home == (timeout_s > 0.0));
        CHECK(((boards.board[0].errors & kMaestroTimeout) != 0) == (timeout_s > 0.0));
        advance(0.3, boards);
        if (timeout_s > 0.0) CHECK(boards.pin[3].height_m == close_to(0.0));
    }
}

TEST_CASE("Maestro boards: any valid command to a board restarts its timeout") {
    MaestroBoards boards = ready_boards();
    take_bytes(two_targets(), boards);
    for (int i = 0; i < 20; ++i) {
        advance(0.05, boards);
        take_bytes(encode_get_errors(chained_line(12)).view(), boards);
    }
    CHECK(boards.board[0].timeouts == 0);
    CHECK(boards.board[1].timeouts == 1);
}

TEST_CASE("Maestro boards: the pulse follows the speed limit, and the pin lags behind it") {
    MaestroBoards boards = ready_boards(0.0);
    take_bytes(encode_speed(chained_line(12), 0, 240).view(), boards);  // 6 mm/s x 5: 30 mm/s at 200 us/mm
    const int top = static_cast<int>(boards.board[0].home[0]) + 1600;   // 2 mm
    take_bytes(encode_target(chained_line(12), 0, top).view(), boards);
    advance(0.02, boards);
    const double after_frame = boards.board[0].servo[0].pulse - boards.board[0].home[0];
    CHECK(after_frame <= 2 * 480.0);
    CHECK(after_frame >= 480.0);
    CHECK(boards.pin[0].height_m < 0.6e-3);
    advance(0.2, boards);
    CHECK(boards.board[0].servo[0].pulse == top);
    CHECK(boards.pin[0].height_m == close_to(2e-3).epsilon(1e-3));
}
