// The key "wires" of a device file, read and written.

#include <algorithm>
#include <cmath>

#include "devices/dynamixel.h"
#include "devices/rig.h"
#include "files/text.h"

namespace palpa::devices {
namespace {

using files::JsonReader;

struct RigUnit {
    const char* name;
    double scale;  // to SI
};
RigUnit unit_of(Drive drive) {
    switch (drive) {
        case Drive::force:
            return {"N", 1.0};
        case Drive::length:
            return {"mm", 1e-3};
        case Drive::pressure:
            return {"kPa", 1e3};
    }
    return {"", 1.0};
}
constexpr std::string_view kDriveNames[]{"force", "length", "pressure"};

bool has_drive(Protocol protocol, Drive drive) {
    switch (protocol) {
        case Protocol::framed:
        case Protocol::sketch:
            return true;
        case Protocol::dynamixel:
            return drive != Drive::pressure;
        case Protocol::alicat:
            return drive == Drive::pressure;
        case Protocol::maestro:
            return drive == Drive::length;
    }
    return false;
}

void read_maestro(JsonReader& reader, RigPort& port) {
    port.board = reader.integer("board", 0, 127, port.board);
    port.chained = reader.has("line") && reader.choice("line", {"compact", "pololu"}) == 1;
    port.crc = reader.boolean("crc", true);
    port.timeout_s = 1e-3 * reader.number("timeout_ms", {10.0, 1000.0}, 100.0);
    if (!reader.has("pulse_us")) return;
    const std::vector<double> pulse_us = reader.numbers("pulse_us", 2, {64.0, 4080.0});
    if (pulse_us[0] >= pulse_us[1])
        reader.fail("pulse_us", files::short_number(pulse_us[0]), "less than " + files::short_number(pulse_us[1]));
    port.lowest_us = pulse_us[0];
    port.highest_us = pulse_us[1];
}

RigPort read_port(JsonReader& reader, const ActuatorRig& rig) {
    reader.only({"name", "protocol", "path", "baud", "board", "line", "crc", "timeout_ms", "pulse_us", "spaced",
                 "pressure_field", "set_point_field"});
    RigPort port;
    port.name = reader.text("name");
    const auto same = [&](const RigPort& other) { return other.name == port.name; };
    if (port.name.empty() || port.name == "sensor" || port.name.find('=') != std::string::npos ||
        std::any_of(rig.ports.begin(), rig.ports.end(), same))
        reader.fail("name", "'" + port.name + "'", "a name of its own, without '=', and not 'sensor'");
    port.protocol =
        static_cast<Protocol>(reader.choice("protocol", {"framed", "sketch", "dynamixel", "alicat", "maestro"}));
    port.path = reader.text("path");
    const int usual = port.protocol == Protocol::dynamixel ? 1000000
                      : port.protocol == Protocol::alicat  ? 38400
                                                           : 115200;
    port.baud = reader.integer("baud", 9600, 1000000, usual);
    if (port.protocol == Protocol::maestro) read_maestro(reader, port);
    if (port.protocol == Protocol::alicat) {
        constexpr int kLastField = 11;
        port.spaced = reader.boolean("spaced", false);
        port.pressure_field = reader.integer("pressure_field", 0, kLastField, 0);
        port.set_point_field = reader.integer("set_point_field", 0, kLastField, 1);
    }
    reader.finish();
    return port;
}

int read_id(JsonReader& reader, const RigPort& port) {
    if (port.protocol == Protocol::alicat) {
        const std::string unit = reader.text("unit", "A");
        if (unit.size() != 1 || unit[0] < 'A' || unit[0] > 'Z')
            reader.fail("unit", "'" + unit + "'", "a letter A to Z");
        return unit[0] - 'A';
    }
    if (port.protocol == Protocol::dynamixel) return reader.integer("id", 0, kMostDynamixelId);
    const int most = port.protocol == Protocol::maestro ? kMaestroChannels - 1 : static_cast<int>(kMostChannels) - 1;
    return reader.integer("id", 0, most);
}

void read_range(JsonReader& reader, RigChannel& channel) {
    const RigUnit unit = unit_of(channel.drive);
    const std::string suffix = std::string("_") + unit.name;
    const std::string range_key = "range" + suffix, relaxed_key = "relaxed" + suffix;
    const std::vector<double> range = reader.numbers(range_key, 2, {-1e6, 1e6});
    if (range[0] >= range[1])
        reader.fail(range_key, files::short_number(range[0]) + ", " + files::short_number(range[1]),
                    "the lower end first");
    channel.lower = unit.scale * range[0];
    channel.upper = unit.scale * range[1];
    channel.relaxed =
        unit.scale * (channel.drive == Drive::length ? reader.number(relaxed_key, {range[0], range[1]})
                                                     : reader.number(relaxed_key, {range[0], range[1]}, range[0]));
    channel.rate_per_s = unit.scale * reader.number("rate" + suffix + "_per_s", files::kPositive);
}

void read_counts(JsonReader& reader, const RigPort& port, RigChannel& channel) {
    const RigUnit unit = unit_of(channel.drive);
    const std::string key = std::string("counts_per_") + unit.name;
    channel.zero_counts = reader.number("zero_counts", {-1e7, 1e7}, 0.0);
    channel.counts_per_unit = reader.number(key, {-1e7, 1e7}) / unit.scale;
    if (channel.counts_per_unit == 0.0) reader.fail(key, "0", "a number that is not 0");
    const CountsRange range = counts_range(port, channel.drive);
    for (const double end : {channel.lower, channel.upper}) {
        const double counts = channel.zero_counts + channel.counts_per_unit * end;
        constexpr double kRounding = 1e-6;
        if (counts >= range.lowest - kRounding && counts <= range.highest + kRounding) continue;
        reader.fail(key, files::short_number(counts) + " counts at an end of the range",
                    "counts from " + files::short_number(range.lowest) + " to " + files::short_number(range.highest));
    }
}

RigChannel read_channel(JsonReader& reader, const ActuatorRig& rig) {
    reader.only({"name",          "port",           "id",          "unit",
                 "drive",         "range_N",        "range_mm",    "range_kPa",
                 "relaxed_N",     "relaxed_mm",     "relaxed_kPa", "rate_N_per_s",
                 "rate_mm_per_s", "rate_kPa_per_s", "zero_counts", "counts_per_N",
                 "counts_per_mm", "counts_per_kPa", "area_mm2",    "current_limit_counts"});
    RigChannel channel;
    channel.name = reader.text("name");
    const std::string name = reader.text("port");
    const auto port =
        std::find_if(rig.ports.begin(), rig.ports.end(), [&](const RigPort& p) { return p.name == name; });
    if (port == rig.ports.end()) reader.fail("port", "'" + name + "'", "the name of one of the ports");
    channel.port = static_cast<std::size_t>(port - rig.ports.begin());
    channel.id = read_id(reader, *port);
    for (const RigChannel& other : rig.channels) {
        if (other.name == channel.name)
            reader.fail("name", "'" + channel.name + "'", "a name that no other actuator has");
        if (other.port == channel.port && other.id == channel.id)
            reader.fail(port->protocol == Protocol::alicat ? "unit" : "id", std::to_string(channel.id),
                        "one that no other actuator has on port '" + name + "'");
    }
    channel.drive = static_cast<Drive>(reader.choice("drive", {"force", "length", "pressure"}));
    if (!has_drive(port->protocol, channel.drive))
        reader.fail("drive", "'" + std::string(kDriveNames[static_cast<std::size_t>(channel.drive)]) + "'",
                    "one that the protocol " + std::string(name_of(port->protocol)) + " has");
    read_range(reader, channel);
    read_counts(reader, *port, channel);
    if (channel.drive == Drive::force) channel.force_N_per_unit = 1.0;
    if (channel.drive == Drive::pressure) channel.force_N_per_unit = 1e-6 * reader.number("area_mm2", {0.0, 1e6}, 0.0);
    if (port->protocol == Protocol::dynamixel && channel.drive == Drive::length)
        channel.current_limit_counts = reader.number("current_limit_counts", {1.0, 2047.0});
    reader.finish();
    return channel;
}

RigSensor read_rig_sensor(JsonReader& reader) {
    reader.only({"path", "baud", "host", "port", "zero_counts", "counts_per_mm", "silence_ms"});
    RigSensor sensor;
    sensor.place.host = reader.text("host", "");
    if (sensor.place.host.empty()) {
        sensor.place.path = reader.text("path");
        sensor.place.baud = reader.integer("baud", 9600, 1000000, 115200);
    } else {
        sensor.place.port = reader.integer("port", 1, 65535);
    }
    sensor.zero_counts = reader.number("zero_counts", {-1e7, 1e7}, 0.0);
    const double counts_per_mm = reader.number("counts_per_mm", {-1e7, 1e7});
    if (std::abs(counts_per_mm) < 1e-3)
        reader.fail("counts_per_mm", files::short_number(counts_per_mm), "at least 0.001 either way");
    sensor.m_per_count = 1e-3 / counts_per_mm;
    sensor.silence_s = 1e-3 * reader.number("silence_ms", {10.0, 1000.0}, 100.0);
    reader.finish();
    return sensor;
}

// One driver serves the servos of a Maestro, and it has one rest for all.
void check_maestro(const JsonReader& reader, const ActuatorRig& rig) {
    for (std::size_t p = 0; p < rig.ports.size(); ++p) {
        if (rig.ports[p].protocol != Protocol::maestro) continue;
        const RigChannel* first = nullptr;
        for (const RigChannel& channel : rig.channels) {
            if (channel.port != p) continue;
            if (first == nullptr) first = &channel;
            constexpr double kRounding_m = 1e-9;
            const double apart_m = (channel.relaxed - channel.lower) - (first->relaxed - first->lower);
            if (std::abs(apart_m) > kRounding_m)
                reader.fail("actuators",
                            "'" + channel.name + "' relaxes elsewhere in its range than '" + first->name + "'",
                            "one distance from range_mm's lower end for all servos of a board");
        }
    }
}

files::Json port_json(const RigPort& port) {
    files::Json json{
        {"name", port.name}, {"protocol", name_of(port.protocol)}, {"path", port.path}, {"baud", port.baud}};
    if (port.protocol == Protocol::maestro) {
        json["board"] = port.board;
        json["line"] = port.chained ? "pololu" : "compact";
        json["crc"] = port.crc;
        json["timeout_ms"] = 1e3 * port.timeout_s;
        json["pulse_us"] = {port.lowest_us, port.highest_us};
    }
    if (port.protocol == Protocol::alicat) {
        json["spaced"] = port.spaced;
        json["pressure_field"] = port.pressure_field;
        json["set_point_field"] = port.set_point_field;
    }
    return json;
}

files::Json channel_json(const ActuatorRig& rig, const RigChannel& channel) {
    const RigPort& port = rig.ports[channel.port];
    const RigUnit unit = unit_of(channel.drive);
    const std::string suffix = std::string("_") + unit.name;
    files::Json json{{"name", channel.name}, {"port", port.name}};
    if (port.protocol == Protocol::alicat) {
        json["unit"] = std::string(1, static_cast<char>('A' + channel.id));
    } else {
        json["id"] = channel.id;
    }
    json["drive"] = kDriveNames[static_cast<std::size_t>(channel.drive)];
    json["range" + suffix] = {channel.lower / unit.scale, channel.upper / unit.scale};
    json["relaxed" + suffix] = channel.relaxed / unit.scale;
    json["rate" + suffix + "_per_s"] = channel.rate_per_s / unit.scale;
    json["zero_counts"] = channel.zero_counts;
    json[std::string("counts_per") + suffix] = channel.counts_per_unit * unit.scale;
    if (channel.drive == Drive::pressure) json["area_mm2"] = 1e6 * channel.force_N_per_unit;
    if (channel.current_limit_counts > 0.0) json["current_limit_counts"] = channel.current_limit_counts;
    return json;
}

files::Json sensor_json(const RigSensor& sensor) {
    files::Json json;
    if (sensor.place.host.empty()) {
        json = {{"path", sensor.place.path}, {"baud", sensor.place.baud}};
    } else {
        json = {{"host", sensor.place.host}, {"port", sensor.place.port}};
    }
    json["zero_counts"] = sensor.zero_counts;
    json["counts_per_mm"] = 1e-3 / sensor.m_per_count;
    json["silence_ms"] = 1e3 * sensor.silence_s;
    return json;
}

}  // namespace

ActuatorRig read_rig(JsonReader reader) {
    reader.only({"name", "ports", "actuators", "sensor", "total_force_N"});
    ActuatorRig rig;
    rig.name = reader.text("name", "");
    std::vector<JsonReader> ports = reader.objects("ports");
    if (ports.empty() || ports.size() > kMostPorts)
        reader.fail("ports", std::to_string(ports.size()) + " ports", "from 1 to " + std::to_string(kMostPorts));
    for (JsonReader& port : ports) rig.ports.push_back(read_port(port, rig));
    std::vector<JsonReader> actuators = reader.objects("actuators");
    if (actuators.empty() || actuators.size() > kMostChannels)
        reader.fail("actuators", std::to_string(actuators.size()) + " actuators",
                    "from 1 to " + std::to_string(kMostChannels));
    for (JsonReader& actuator : actuators) rig.channels.push_back(read_channel(actuator, rig));
    check_maestro(reader, rig);
    if (auto sensor = reader.optional_object("sensor")) rig.sensor.push_back(read_rig_sensor(*sensor));
    rig.total_force_N = reader.number("total_force_N", {0.0, 1000.0, true});
    reader.finish();
    return rig;
}

files::Json rig_json(const ActuatorRig& rig) {
    files::Json json{{"name", rig.name}};
    json["ports"] = files::Json::array();
    for (const RigPort& port : rig.ports) json["ports"].push_back(port_json(port));
    json["actuators"] = files::Json::array();
    for (const RigChannel& channel : rig.channels) json["actuators"].push_back(channel_json(rig, channel));
    if (!rig.sensor.empty()) json["sensor"] = sensor_json(rig.sensor.front());
    json["total_force_N"] = rig.total_force_N;
    return json;
}

}  // namespace palpa::devices
