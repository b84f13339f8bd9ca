#pragma once
// Simulated Dynamixel servos on one line: bytes in, bytes out, what the motors do. A model without clock or port.
//
// Modelled: ping, read, write, sync write; the control table's mode, torque, watchdog, goals and present values; refused writes
// (mode while the torque is on; goals out of range, or after the watchdog has fired). Assumed, not measured: a motor that
// reaches its goal current at once and its goal position at a fixed speed; a watchdog restarted by packets that are for the
// servo alone or for all.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "devices/dynamixel.h"

namespace palpa::devices::simulators {

struct SimulatedDynamixel {
    int id = 1;
    std::array<std::uint8_t, 147> table{};
    double position = 0.0;         // counts, exact
    double speed_per_s = 40000.0;  // counts
    double heard_s = 0.0;
    bool watches = true;       // false: an older firmware, whose watchdog does nothing
    std::int64_t fired = 0;    // watchdog
    std::int64_t refused = 0;  // writes
};

struct DynamixelBus {
    std::vector<SimulatedDynamixel> servo;
    DynamixelParser parser;
    double time_s = 0.0;
    std::vector<std::uint8_t> out;  // replies that nobody has taken
};

void take_bytes(std::span<const std::uint8_t> bytes, DynamixelBus& bus);
void advance(double dt_s, DynamixelBus& bus);

std::int32_t value_at(const SimulatedDynamixel& servo, DynamixelItem item);
// Whether the motor carries no torque, or its watchdog has stopped it.
bool is_free(const SimulatedDynamixel& servo);

}  // namespace palpa::devices::simulators
