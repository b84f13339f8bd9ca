#pragma once
// Simulated Alicat pressure controllers on one line: bytes in, bytes out, pressures. A model without clock or port.
//
// Modelled: poll, set point in both forms, hold closed, cancel; an answer that takes its time, and a command that comes before
// it and spoils both; set points out of range, which are not taken; no timeout: a set point stays. Assumed, not measured: a
// pressure of first order.

#include <cstdint>
#include <span>
#include <string>
#include <vector>

namespace palpa::devices::simulators {

struct SimulatedAlicat {
    char unit = 'A';
    double full_scale = 100.0;  // engineering units
    double set_point = 0.0;
    double pressure = 0.0;
    bool held = false;
};

struct AlicatUnits {
    std::vector<SimulatedAlicat> unit;
    double lag_s = 0.02;
    double answer_s = 0.004;  // until the answer begins
    double time_s = 0.0;
    std::string line;   // of the command that is arriving
    std::string reply;  // that is due
    double due_s = 0.0;
    std::int64_t commands = 0;
    std::int64_t spoiled = 0;  // commands that came before the answer to the one before
    std::vector<std::uint8_t> out;
};

void take_bytes(std::span<const std::uint8_t> bytes, AlicatUnits& units);
void advance(double dt_s, AlicatUnits& units);

}  // namespace palpa::devices::simulators
