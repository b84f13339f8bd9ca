// The bytes of a line of Dynamixel servos, both ways: packets as the driver takes them, and as the simulated servos do.

#include <cstdlib>

#include "devices/crc16.h"
#include "devices/dynamixel.h"
#include "devices/simulators/dynamixel_bus.h"
#include "tests/fuzz/fuzz.h"

using namespace palpa;
using namespace palpa::devices;

namespace {

void take_packets(std::span<const std::uint8_t> bytes) {
    DynamixelParser parser;
    DynamixelMessage message;
    for (const std::uint8_t byte : bytes) {
        if (!feed(byte, parser, message)) continue;
        if (message.parameters > message.parameter.size()) fuzz::finding("more parameters than there is room for");
        if (message.instruction == kDynamixelStatus && message.parameters == 0)
            fuzz::finding("a status without its error");
    }
    if (parser.size > parser.bytes.size()) fuzz::finding("a packet longer than its buffer");
}

void drive_servos(std::span<const std::uint8_t> bytes) {
    simulators::DynamixelBus bus;
    bus.servo.resize(2);
    bus.servo[1].id = 2;
    simulators::take_bytes(bytes, bus);
    simulators::advance(0.005, bus);
    for (const simulators::SimulatedDynamixel& servo : bus.servo) {
        if (std::abs(simulators::value_at(servo, kDxlGoalCurrent)) > 2047) fuzz::finding("a current out of range");
        if (std::abs(simulators::value_at(servo, kDxlGoalPosition)) > 1'048'575)
            fuzz::finding("a position out of range");
    }
}

}  // namespace

// The input is taken as it is, and as the inside of packets whose length and CRC are right.
PALPA_FUZZ_ENTRY(dynamixel)(const std::uint8_t* data, std::size_t size) {
    take_packets({data, size});
    drive_servos({data, size});
    constexpr std::size_t kMost = 100;
    std::vector<std::uint8_t> packet{0xff, 0xff, 0xfd, 0x00};
    packet.push_back(size > 0 ? data[0] : 1);
    const std::size_t body = size > 1 ? std::min(size - 1, kMost) : 0;
    packet.push_back(static_cast<std::uint8_t>(body + 2));
    packet.push_back(0);
    packet.insert(packet.end(), data + (size > 0 ? 1 : 0), data + (size > 0 ? 1 : 0) + body);
    const std::uint16_t crc = crc16(packet);
    packet.push_back(static_cast<std::uint8_t>(crc & 0xff));
    packet.push_back(static_cast<std::uint8_t>(crc >> 8));
    take_packets(packet);
    drive_servos(packet);
    return 0;
}
