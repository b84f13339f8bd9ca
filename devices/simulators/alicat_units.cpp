#include "devices/simulators/alicat_units.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "files/text.h"

namespace palpa::devices::simulators {
namespace {

void obey(std::string_view rest, SimulatedAlicat& unit) {
    double value = 0.0;
    if (rest == "HC" || rest == "HP") unit.held = true;
    if (rest == "C") unit.held = false;
    if (rest.empty() || rest.front() != 'S') return;
    rest.remove_prefix(1);
    while (!rest.empty() && rest.front() == ' ') rest.remove_prefix(1);
    if (files::parse_number(rest, value) && value >= 0.0 && value <= unit.full_scale)
        unit.set_point = std::round(100.0 * value) / 100.0;
}

// Fields of a pressure controller: pressure, set point.
std::string frame_of(const SimulatedAlicat& unit) {
    std::array<char, 64> text{};
    std::snprintf(text.data(), text.size(), "%c %+07.2f %+07.2f%s\r", unit.unit, unit.pressure, unit.set_point,
                  unit.held ? " HLD" : "");
    return text.data();
}

void take_line(AlicatUnits& units) {
    std::string line;
    line.swap(units.line);
    std::transform(line.begin(), line.end(), line.begin(),
                   [](char c) { return c >= 'a' && c <= 'z' ? static_cast<char>(c - 'a' + 'A') : c; });
    for (SimulatedAlicat& unit : units.unit) {
        if (line.empty() || line.front() != unit.unit) continue;
        ++units.commands;
        obey(std::string_view(line).substr(1), unit);
        units.reply = frame_of(unit);
        units.due_s = units.time_s + units.answer_s;
    }
}

}  // namespace

void take_bytes(std::span<const std::uint8_t> bytes, AlicatUnits& units) {
    constexpr std::size_t kLongest = 64;
    for (const std::uint8_t byte : bytes) {
        if (!units.reply.empty()) {
            ++units.spoiled;
            units.reply.clear();
            units.line.clear();
        }
        if (byte == '\r') {
            take_line(units);
        } else if (units.line.size() < kLongest) {
            units.line.push_back(static_cast<char>(byte));
        }
    }
}

void advance(double dt_s, AlicatUnits& units) {
    units.time_s += dt_s;
    const double share = 1.0 - std::exp(-dt_s / units.lag_s);
    for (SimulatedAlicat& unit : units.unit) {
        if (!unit.held) unit.pressure += share * (unit.set_point - unit.pressure);
    }
    if (units.reply.empty() || units.time_s < units.due_s) return;
    units.out.insert(units.out.end(), units.reply.begin(), units.reply.end());
    units.reply.clear();
}

}  // namespace palpa::devices::simulators
