#include "devices/rig.h"

#include <algorithm>
#include <cmath>

#include "devices/alicat.h"
#include "devices/dynamixel.h"
#include "devices/framed.h"
#include "files/input_error.h"

namespace palpa::devices {
namespace {

files::InputError bad_port(std::string_view found, const ActuatorRig& rig) {
    std::string names;
    for (const RigPort& port : rig.ports) names += port.name + "=PATH, ";
    if (!rig.sensor.empty()) names += "sensor=PATH, sensor=udp:HOST:PORT, ";
    names.resize(names.size() - 2);
    return files::bad_input("--port", "", files::shown(found), names);
}

void set_sensor(std::string_view text, std::string_view place, const ActuatorRig& rig, CountsPlace& out) {
    constexpr std::string_view kUdp = "udp:";
    if (!place.starts_with(kUdp)) {
        out = CountsPlace{std::string(place), out.baud, "", 0};
        return;
    }
    place.remove_prefix(kUdp.size());
    const std::size_t colon = place.rfind(':');
    int port = 0;
    if (colon != std::string_view::npos && colon > 0 && place.size() - colon <= 6) {
        for (const char c : place.substr(colon + 1)) port = c >= '0' && c <= '9' ? 10 * port + (c - '0') : 1 << 20;
    }
    if (port < 1 || port > 65535) throw bad_port(text, rig);
    out = CountsPlace{"", out.baud, std::string(place.substr(0, colon)), port};
}

}  // namespace

std::string_view name_of(Protocol protocol) {
    switch (protocol) {
        case Protocol::framed:
            return "framed";
        case Protocol::sketch:
            return "sketch";
        case Protocol::dynamixel:
            return "dynamixel";
        case Protocol::alicat:
            return "alicat";
        case Protocol::maestro:
            return "maestro";
    }
    return "";
}

void set_port(std::string_view name_and_path, ActuatorRig& rig) {
    const std::size_t equals = name_and_path.find('=');
    const std::string_view name = name_and_path.substr(0, equals);
    const std::string_view path = equals == std::string_view::npos ? "" : name_and_path.substr(equals + 1);
    if (path.empty()) throw bad_port(name_and_path, rig);
    if (name == "sensor" && !rig.sensor.empty()) return set_sensor(name_and_path, path, rig, rig.sensor.front().place);
    const auto port =
        std::find_if(rig.ports.begin(), rig.ports.end(), [&](const RigPort& p) { return p.name == name; });
    if (port == rig.ports.end()) throw bad_port(name_and_path, rig);
    port->path = path;
}

double counts_of(const RigPort& port, const RigChannel& channel, double value) noexcept {
    const double wanted = std::isfinite(value) ? std::clamp(value, channel.lower, channel.upper) : channel.relaxed;
    const double counts = channel.zero_counts + channel.counts_per_unit * wanted;
    const CountsRange range = counts_range(port, channel.drive);
    return std::clamp(counts, range.lowest, range.highest);
}

double value_of(const RigChannel& channel, double counts) noexcept {
    return (counts - channel.zero_counts) / channel.counts_per_unit;
}

CountsRange counts_range(const RigPort& port, Drive drive) noexcept {
    constexpr double kMostCurrent = 2047.0;
    constexpr double kMostTurns = 1'048'575.0;  // 256 turns of 4,096 counts
    switch (port.protocol) {
        case Protocol::framed:
            return {kLeastFramedCounts, kMostFramedCounts};
        case Protocol::sketch:
            return {0.0, 254.0};
        case Protocol::dynamixel:
            if (drive == Drive::force) return {-kMostCurrent, kMostCurrent};
            return {-kMostTurns, kMostTurns};
        case Protocol::alicat:
            return {-kMostAlicatValue, kMostAlicatValue};
        case Protocol::maestro:
            return {port.lowest_us, port.highest_us};
    }
    return {};
}

PinDevice pins_of(const ActuatorRig& rig, std::size_t port) {
    const RigPort& from = rig.ports[port];
    PinDevice pins;
    pins.name = from.name;
    pins.port = from.path;
    pins.baud = from.baud;
    pins.timeout_s = from.timeout_s;
    pins.lowest_us = from.lowest_us;
    pins.highest_us = from.highest_us;
    pins.stroke_m = 0.0;
    pins.speed_m_per_s = 0.0;
    PinBoard board{MaestroAddress{from.board, from.chained, from.crc}, kMaestroChannels, kMaestroChannels, 0};
    int last = 0;
    for (const RigChannel& channel : rig.channels) {
        if (channel.port != port) continue;
        PinServo servo;
        servo.channel = channel.id;
        servo.zero_us = channel.zero_counts + channel.counts_per_unit * channel.lower;
        servo.us_per_mm = 1e-3 * std::abs(channel.counts_per_unit);
        servo.direction = channel.counts_per_unit > 0.0 ? 1.0 : -1.0;
        pins.pins.push_back(servo);
        pins.stroke_m = std::max(pins.stroke_m, channel.upper - channel.lower);
        pins.rest_m = channel.relaxed - channel.lower;
        pins.speed_m_per_s = std::max(pins.speed_m_per_s, channel.rate_per_s);
        board.first = std::min(board.first, channel.id);
        last = std::max(last, channel.id);
    }
    board.count = last - board.first + 1;
    pins.boards.push_back(board);
    pins.rows = 1;
    pins.columns = static_cast<int>(pins.pins.size());
    return pins;
}

}  // namespace palpa::devices
