// Dynamixel packets, and the simulated servos that take them.

#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "devices/crc16.h"
#include "devices/dynamixel.h"
#include "devices/simulators/dynamixel_bus.h"
#include "tests/devices/wires.h"

using namespace palpa::devices;
using namespace palpa::devices::simulators;
using namespace palpa::test;

namespace {

struct Packets {
    std::vector<DynamixelMessage> message;
    std::int64_t malformed = 0;
};

Packets decoded(std::span<const std::uint8_t> bytes) {
    Packets out;
    DynamixelParser parser;
    DynamixelMessage message;
    for (const std::uint8_t byte : bytes) {
        if (feed(byte, parser, message)) out.message.push_back(message);
    }
    out.malformed = parser.malformed;
    return out;
}

std::vector<std::uint8_t> parameters_of(const DynamixelMessage& message) {
    return {message.parameter.begin(), message.parameter.begin() + static_cast<std::ptrdiff_t>(message.parameters)};
}

DynamixelBus two_servos() {
    DynamixelBus bus;
    bus.servo.resize(2);
    bus.servo[0].id = 1;
    bus.servo[1].id = 2;
    return bus;
}

void tell_bus(const DynamixelPacket& packet, DynamixelBus& bus) { take_bytes(packet.view(), bus); }

// The servo pulls with what it was told, and the line talks every 10 ms.
void engage_current(int id, std::int32_t watchdog, DynamixelBus& bus) {
    tell_bus(encode_dynamixel_write(id, kDxlMode, kDxlCurrent), bus);
    tell_bus(encode_dynamixel_write(id, kDxlGoalCurrent, 150), bus);
    tell_bus(encode_dynamixel_write(id, kDxlTorque, 1), bus);
    tell_bus(encode_dynamixel_write(id, kDxlWatchdog, watchdog), bus);
    bus.out.clear();
}

}  // namespace

TEST_CASE("dynamixel: packets and CRCs are byte for byte as documented") {
    CHECK(hex_of(encode_dynamixel_ping(1).view()) == "FF FF FD 00 01 03 00 01 19 4E");
    const std::vector<std::uint8_t> model{0x06, 0x04, 0x26};
    CHECK(hex_of(encode_dynamixel_status(1, 0, model).view()) == "FF FF FD 00 01 07 00 55 00 06 04 26 65 5D");
    CHECK(crc16(encode_dynamixel_ping(1).view().first(8)) == 0x4e19);
    const DynamixelPacket goal = encode_dynamixel_write(1, kDxlGoalPosition, -2);
    CHECK(hex_of(goal.view().first(14)) == "FF FF FD 00 01 09 00 03 74 00 FE FF FF FF");
}

TEST_CASE("dynamixel: a header within the data is stuffed, and comes back as it was") {
    const std::vector<std::uint8_t> data{0x12, 0xff, 0xff, 0xfd, 0xff, 0xff, 0xfd, 0x00, 0xff, 0xff, 0xfd};
    const DynamixelPacket packet = encode_dynamixel_status(7, 0, data);
    CHECK(packet.size == 7 + 2 + data.size() + 3 + 2);  // three bytes more
    const Packets found = decoded(packet.view());
    REQUIRE(found.message.size() == 1);
    std::vector<std::uint8_t> wanted{0};
    add_bytes(data, wanted);
    CHECK(parameters_of(found.message[0]) == wanted);
    CHECK(found.malformed == 0);
}

TEST_CASE("dynamixel: every split of a valid stream decodes alike, with garbage before and between") {
    std::vector<std::uint8_t> stream{0xff, 0xff, 0x13, 0xfd};
    add_bytes(encode_dynamixel_status(1, 0, std::vector<std::uint8_t>{1, 2, 3}).view(), stream);
    add_bytes(encode_dynamixel_read(2, kDxlPresent).view(), stream);
    add_bytes(std::vector<std::uint8_t>{0xff, 0xff, 0xfd, 0x00, 0x01, 0x10, 0x00}, stream);  // cut off
    add_bytes(encode_dynamixel_status(2, 0x80, std::vector<std::uint8_t>{0xff, 0xff, 0xfd}).view(), stream);
    add_bytes(encode_dynamixel_ping(3).view(), stream);
    const Packets whole = decoded(stream);
    REQUIRE(whole.message.size() == 4);
    CHECK(whole.message[2].parameter[0] == 0x80);
    for (std::size_t cut = 0; cut <= stream.size(); ++cut) {
        CAPTURE(cut);
        DynamixelParser parser;
        DynamixelMessage message;
        std::vector<DynamixelMessage> found;
        for (const auto part : {std::span(stream).first(cut), std::span(stream).subspan(cut)}) {
            for (const std::uint8_t byte : part) {
                if (feed(byte, parser, message)) found.push_back(message);
            }
        }
        REQUIRE(found.size() == 4);
        for (std::size_t i = 0; i < 4; ++i) {
            CHECK(found[i].id == whole.message[i].id);
            CHECK(parameters_of(found[i]) == parameters_of(whole.message[i]));
        }
    }
}

TEST_CASE("dynamixel: a packet with any one byte changed is refused, and the next one is read") {
    const DynamixelPacket packet = encode_dynamixel_status(1, 0, std::vector<std::uint8_t>{9, 8, 7});
    for (std::size_t at = 0; at < packet.size; ++at) {
        CAPTURE(at);
        std::vector<std::uint8_t> stream(packet.view().begin(), packet.view().end());
        stream[at] ^= 0x24;
        add_bytes(packet.view(), stream);
        add_bytes(std::vector<std::uint8_t>(200, 0), stream);  // a length that was changed waits for so many bytes
        CHECK(decoded(stream).message.size() == 1);
    }
}

TEST_CASE("dynamixel: a million random bytes give no message that is too long and no command out of range") {
    constexpr unsigned kSeed = 20;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    DynamixelBus bus = two_servos();
    for (const int id : {1, 2}) engage_current(id, 5, bus);
    const std::vector<std::uint8_t> begin{0xff, 0xff, 0xfd, 0x00, 0x01};
    for (int i = 0; i < 1'000'000; ++i) {
        // every tenth time what looks like a packet for servo 1
        if (i % 10 == 0) take_bytes(begin, bus);
        const auto byte = static_cast<std::uint8_t>(random());
        take_bytes(std::span(&byte, 1), bus);
        if (i % 1000 == 0) advance(1e-3, bus);
    }
    for (const SimulatedDynamixel& servo : bus.servo) {
        CHECK(std::abs(value_at(servo, kDxlGoalCurrent)) <= 2047);
        CHECK(std::abs(value_at(servo, kDxlGoalPosition)) <= 1'048'575);
    }
}

TEST_CASE("dynamixel: the watchdog stops a servo that hears nothing, and its goals are refused until it is cleared") {
    DynamixelBus bus = two_servos();
    engage_current(1, 5, bus);
    for (int i = 0; i < 20; ++i) {
        advance(0.01, bus);
        tell_bus(encode_dynamixel_read(1, kDxlPresent), bus);
    }
    CHECK(value_at(bus.servo[0], {126, 2}) == 150);
    CHECK_FALSE(is_free(bus.servo[0]));
    for (int i = 0; i < 11; ++i) advance(0.01, bus);
    CHECK(is_free(bus.servo[0]));
    CHECK(value_at(bus.servo[0], {126, 2}) == 0);
    const std::vector<int> ids{1};
    const std::vector<std::int32_t> goals{200};
    tell_bus(encode_dynamixel_sync_write(kDxlGoalCurrent, ids, goals), bus);
    CHECK(value_at(bus.servo[0], kDxlGoalCurrent) == 150);
    tell_bus(encode_dynamixel_write(1, kDxlWatchdog, 0), bus);
    tell_bus(encode_dynamixel_sync_write(kDxlGoalCurrent, ids, goals), bus);
    CHECK(value_at(bus.servo[0], kDxlGoalCurrent) == 200);
    CHECK_FALSE(is_free(bus.servo[0]));
}
