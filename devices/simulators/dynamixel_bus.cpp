#include "devices/simulators/dynamixel_bus.h"

#include <algorithm>
#include <cmath>

namespace palpa::devices::simulators {
namespace {

constexpr std::uint8_t kDxlRangeError = 4, kDxlLengthError = 5, kDxlAccessError = 7;
constexpr std::int32_t kMostCurrentCounts = 2047, kMostPositionCounts = 1'048'575;
constexpr DynamixelItem kDxlPosition{132, 4}, kDxlCurrentNow{126, 2};

void set_value(DynamixelItem item, std::int32_t value, SimulatedDynamixel& servo) {
    for (std::size_t i = 0; i < item.bytes; ++i)
        servo.table[item.address + i] = static_cast<std::uint8_t>(static_cast<std::uint32_t>(value) >> (8 * i));
}

void answer_with(int id, std::uint8_t error, std::span<const std::uint8_t> parameters, DynamixelBus& bus) {
    const DynamixelPacket packet = encode_dynamixel_status(id, error, parameters);
    bus.out.insert(bus.out.end(), packet.view().begin(), packet.view().end());
}

// The error that a write of this value meets, 0 if it is taken.
std::uint8_t refusal(const SimulatedDynamixel& servo, DynamixelItem item, std::int32_t value) {
    const auto is = [&](DynamixelItem other) { return item.address == other.address; };
    const bool goal = is(kDxlGoalCurrent) || is(kDxlGoalPosition);
    if (goal && servo.table[kDxlWatchdog.address] == kDxlWatchdogFired) return kDxlRangeError;
    if (is(kDxlGoalCurrent) && std::abs(value) > kMostCurrentCounts) return kDxlRangeError;
    if (is(kDxlGoalPosition) && std::abs(value) > kMostPositionCounts) return kDxlRangeError;
    if (is(kDxlWatchdog) && value > 127) return kDxlRangeError;
    if (is(kDxlMode) && servo.table[kDxlTorque.address] != 0) return kDxlAccessError;
    if (item.address >= kDxlPresent.address) return kDxlAccessError;
    return 0;
}

std::uint8_t write_item(std::uint16_t address, std::span<const std::uint8_t> data, SimulatedDynamixel& servo) {
    for (const DynamixelItem item : {kDxlMode, kDxlTorque, kDxlWatchdog, kDxlGoalCurrent, kDxlGoalPosition}) {
        if (item.address != address || item.bytes != data.size()) continue;
        const std::int32_t value = item.bytes == 1 ? data[0] : dynamixel_value(data);
        const std::uint8_t error = refusal(servo, item, value);
        if (error == 0) set_value(item, value, servo);
        servo.refused += error != 0;
        return error;
    }
    return kDxlAccessError;
}

std::uint16_t word_at(const DynamixelMessage& message, std::size_t at) {
    return static_cast<std::uint16_t>(message.parameter[at] | message.parameter[at + 1] << 8);
}

void obey_read(const DynamixelMessage& message, SimulatedDynamixel& servo, DynamixelBus& bus) {
    if (message.parameters != 4) return answer_with(servo.id, kDxlLengthError, {}, bus);
    const std::size_t address = word_at(message, 0), count = word_at(message, 2);
    constexpr std::size_t kLongest = 100;
    if (count > kLongest || address + count > servo.table.size())
        return answer_with(servo.id, kDxlAccessError, {}, bus);
    answer_with(servo.id, 0, std::span(servo.table).subspan(address, count), bus);
}

void obey_write(const DynamixelMessage& message, SimulatedDynamixel& servo, DynamixelBus& bus) {
    if (message.parameters < 3) return answer_with(servo.id, kDxlLengthError, {}, bus);
    const std::span<const std::uint8_t> data = std::span(message.parameter).subspan(2, message.parameters - 2);
    answer_with(servo.id, write_item(word_at(message, 0), data, servo), {}, bus);
}

void obey_sync_write(const DynamixelMessage& message, DynamixelBus& bus) {
    if (message.parameters < 4) return;
    const std::uint16_t address = word_at(message, 0);
    const std::size_t bytes = word_at(message, 2);
    if (bytes == 0) return;
    for (std::size_t at = 4; at + 1 + bytes <= message.parameters; at += 1 + bytes) {
        for (SimulatedDynamixel& servo : bus.servo) {
            if (servo.id == message.parameter[at])
                write_item(address, std::span(message.parameter).subspan(at + 1, bytes), servo);
        }
    }
}

void obey_packet(const DynamixelMessage& message, DynamixelBus& bus) {
    if (message.instruction == kDynamixelStatus) return;
    for (SimulatedDynamixel& servo : bus.servo) {
        if (message.id != servo.id && message.id != kDynamixelAll) continue;
        servo.heard_s = bus.time_s;
        if (message.id == kDynamixelAll) continue;
        if (message.instruction == kDynamixelPing) {
            constexpr std::array<std::uint8_t, 3> kModelAndFirmware{0x06, 0x04, 0x26};
            answer_with(servo.id, 0, kModelAndFirmware, bus);
        }
        if (message.instruction == kDynamixelRead) obey_read(message, servo, bus);
        if (message.instruction == kDynamixelWrite) obey_write(message, servo, bus);
    }
    if (message.id == kDynamixelAll && message.instruction == kDynamixelSyncWrite) obey_sync_write(message, bus);
}

}  // namespace

std::int32_t value_at(const SimulatedDynamixel& servo, DynamixelItem item) {
    if (item.bytes == 1) return servo.table[item.address];
    return dynamixel_value(std::span(servo.table).subspan(item.address, item.bytes));
}

bool is_free(const SimulatedDynamixel& servo) {
    return value_at(servo, kDxlTorque) == 0 || value_at(servo, kDxlWatchdog) == kDxlWatchdogFired;
}

void take_bytes(std::span<const std::uint8_t> bytes, DynamixelBus& bus) {
    for (const std::uint8_t byte : bytes) {
        DynamixelMessage message;
        if (feed(byte, bus.parser, message)) obey_packet(message, bus);
    }
}

void advance(double dt_s, DynamixelBus& bus) {
    bus.time_s += dt_s;
    for (SimulatedDynamixel& servo : bus.servo) {
        const std::int32_t watchdog = value_at(servo, kDxlWatchdog);
        const bool on = value_at(servo, kDxlTorque) != 0;
        if (!on) servo.heard_s = bus.time_s;
        if (servo.watches && on && watchdog > 0 && watchdog != kDxlWatchdogFired &&
            bus.time_s - servo.heard_s > kDxlWatchdogUnit_s * watchdog) {
            set_value(kDxlWatchdog, kDxlWatchdogFired, servo);
            ++servo.fired;
        }
        const bool moves = !is_free(servo) && value_at(servo, kDxlMode) == kDxlPositionWithinCurrent;
        const double most = servo.speed_per_s * dt_s;
        if (moves) servo.position += std::clamp(value_at(servo, kDxlGoalPosition) - servo.position, -most, most);
        set_value(kDxlPosition, static_cast<std::int32_t>(std::lround(servo.position)), servo);
        const bool pulls = !is_free(servo) && value_at(servo, kDxlMode) == kDxlCurrent;
        set_value(kDxlCurrentNow, pulls ? value_at(servo, kDxlGoalCurrent) : 0, servo);
    }
}

}  // namespace palpa::devices::simulators
