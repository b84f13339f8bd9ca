#include "devices/simulators/rig_wires.h"

#include <algorithm>
#include <cmath>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <poll.h>
#include <stdexcept>

#include "devices/force_sensor.h"
#include "devices/simulators/sockets.h"
#include "devices/simulators/stream.h"

namespace palpa::devices::simulators {
namespace {

volatile std::sig_atomic_t garbage_asked = 0;

constexpr double kListens_s = 2.0;   // after "start"
constexpr double kPause_s = 0.5;     // of who drives
constexpr double kInRange = 1e-3;    // of a range: counts are whole, and so is what comes back
constexpr double kFullScale = 1.25;  // of a pressure controller, over the highest set point

bool within(double from_s, double seconds, double now_s) {
    return seconds > 0.0 && now_s >= from_s && now_s < from_s + seconds;
}

void set_up_line(const ActuatorRig& rig, std::size_t port, bool watchdogs, std::uint64_t seed, SimulatedLine& line) {
    for (const RigChannel& channel : rig.channels) {
        if (channel.port != port) continue;
        const double resting = channel.zero_counts + channel.counts_per_unit * channel.relaxed;
        SimulatedDynamixel servo;
        servo.id = channel.id;
        servo.watches = watchdogs;
        servo.position = resting;
        line.dynamixel.servo.push_back(servo);
        SimulatedAlicat unit;
        unit.unit = static_cast<char>('A' + channel.id % 26);
        const double lower = channel.zero_counts + channel.counts_per_unit * channel.lower;
        const double upper = channel.zero_counts + channel.counts_per_unit * channel.upper;
        unit.full_scale = kFullScale * std::max({lower, upper, 1.0});
        line.alicat.unit.push_back(unit);
        line.sketch[static_cast<std::size_t>(channel.id) % kMostChannels] = static_cast<std::int32_t>(resting);
    }
    if (!watchdogs) line.framed.timeout_s = 0.0;
    if (rig.ports[port].protocol != Protocol::maestro) return;
    const PinDevice pins = pins_of(rig, port);
    MaestroSettings settings;
    settings.timeout_s = watchdogs ? pins.timeout_s : 0.0;
    settings.crc = rig.ports[port].crc;
    settings.pin_speed_m_per_s = pins.speed_m_per_s;
    line.maestro = std::make_unique<MaestroBoards>(make_maestro_boards(pins, settings, 0.0, seed));
}

std::string link_of(const WiresOptions& options, const std::string& name) {
    return options.links.empty() ? "" : options.links + "/" + name;
}

template <class Model>
std::vector<std::uint8_t> answer_of(std::span<const std::uint8_t> in, Model& model) {
    take_bytes(in, model);
    std::vector<std::uint8_t> out;
    out.swap(model.out);
    return out;
}

std::string no_terminal() {
    return std::string("no pseudo-terminal, or no link to it, can be had: ") + std::strerror(errno);
}

}  // namespace

void add_wires_options(CLI::App& app, WiresOptions& options) {
    add_line_options(app, options.faults);
    app.add_option("--links", options.links, "folder for symbolic links to the terminals, by the ports' names")
        ->check(CLI::ExistingDirectory);
    app.add_flag("!--no-watchdogs", options.watchdogs, "devices that hold their force when the line falls silent");
    app.add_flag("--sensor-udp", options.sensor_by_udp, "the sensor speaks by UDP");
    app.add_option("--sensor-Hz", options.sensor_rate_Hz)->check(CLI::Range(1.0, 1000.0))->capture_default_str();
    app.add_option("--silent-from-s", options.silent_from_s, "all is unplugged then, or at SIGUSR1");
    app.add_option("--silent-s", options.silent_s, "for so long");
    app.add_option("--garbage-from-s", options.garbage_from_s, "replies are random bytes then, or at SIGUSR2");
    app.add_option("--garbage-s", options.garbage_s, "for so long");
    app.add_option("--seed", options.seed)->capture_default_str();
}

RigWires::RigWires(const ActuatorRig& rig, const WiresOptions& options)
    : rig_(rig), options_(options), line_(rig.ports.size()), began_s_(steady_s()), random_(options.seed) {
    for (std::size_t i = 0; i < line_.size(); ++i) set_up_line(rig, i, options.watchdogs, options.seed, line_[i]);
    if (options.sensor_by_udp) udp_ = open_socket(udp_port_);
    plug(true);
    std::signal(SIGUSR2, [](int) { garbage_asked = 1; });
}

RigWires::~RigWires() {
    plug(false);
    if (udp_ >= 0) ::close(udp_);
    if (options_.links.empty()) return;
    for (const RigPort& port : rig_.ports) std::filesystem::remove(link_of(options_, port.name));
    std::filesystem::remove(link_of(options_, "sensor"));
}

void RigWires::plug(bool in) {
    if (in == plugged_) return;
    plugged_ = in;
    for (std::size_t i = 0; i < line_.size(); ++i) {
        if (!in) unplug(line_[i].terminal);
        if (in) line_[i].terminal = plug_in(link_of(options_, rig_.ports[i].name));
        if (in && line_[i].terminal.master < 0) throw std::runtime_error(no_terminal());
    }
    if (rig_.sensor.empty() || udp_ >= 0) return;
    if (!in) return unplug(sensor_);
    sensor_ = plug_in(link_of(options_, "sensor"));
    if (sensor_.master < 0) throw std::runtime_error(no_terminal());
}

std::string RigWires::ports() const {
    std::string text;
    const auto add = [&](const std::string& name, const std::string& path) {
        const std::string link = link_of(options_, name);
        text += (text.empty() ? "" : " ") + name + "=" + (link.empty() || path.starts_with("udp:") ? path : link);
    };
    for (std::size_t i = 0; i < line_.size(); ++i) add(rig_.ports[i].name, line_[i].terminal.path);
    if (udp_ >= 0) {
        add("sensor", "udp:127.0.0.1:" + std::to_string(udp_port_));
    } else if (!rig_.sensor.empty()) {
        add("sensor", sensor_.path);
    }
    return text;
}

void RigWires::take_sketch(std::span<const std::uint8_t> bytes, SimulatedLine& line) const {
    for (const std::uint8_t byte : bytes) {
        if (byte == 0xff) {
            line.sketch_at = 0;
        } else if (line.sketch_at < line.sketch.size()) {
            line.sketch[line.sketch_at++] = byte;
        }
    }
}

void RigWires::talk(std::size_t port) {
    SimulatedLine& line = line_[port];
    std::uint8_t bytes[1024];
    const ssize_t n = ::read(line.terminal.master, bytes, sizeof bytes);
    if (n > 0) {
        if (time_s_ - heard_s_ > kPause_s) talking_from_s_ = time_s_;
        heard_s_ = time_s_;
    }
    const std::vector<std::uint8_t> in =
        n > 0 ? through(options_.faults, std::span(bytes, static_cast<std::size_t>(n)), random_)
              : std::vector<std::uint8_t>{};
    std::vector<std::uint8_t> out;
    switch (rig_.ports[port].protocol) {
        case Protocol::framed:
            out = answer_of(in, line.framed);
            break;
        case Protocol::sketch:
            take_sketch(in, line);
            break;
        case Protocol::dynamixel:
            out = answer_of(in, line.dynamixel);
            break;
        case Protocol::alicat:
            out = answer_of(in, line.alicat);
            break;
        case Protocol::maestro:
            out = answer_of(in, *line.maestro);
            break;
    }
    if (within(options_.garbage_from_s, options_.garbage_s, time_s_)) {
        for (std::uint8_t& byte : out) byte = static_cast<std::uint8_t>(random_());
    }
    out = through(options_.faults, out, random_);
    const ssize_t written = out.empty() ? 0 : ::write(line.terminal.master, out.data(), out.size());
    static_cast<void>(written);  // without a reader the reply is lost
}

void RigWires::advance_all(double dt_s) {
    time_s_ += dt_s;
    for (SimulatedLine& line : line_) {
        advance(dt_s, line.dynamixel);
        advance(dt_s, line.alicat);
        advance(dt_s, line.framed);
        if (line.maestro) advance(dt_s, *line.maestro);
    }
    for (std::size_t i = 0; i < rig_.channels.size(); ++i) {
        const RigChannel& channel = rig_.channels[i];
        const double slack = kInRange * (channel.upper - channel.lower) + 1.0 / std::abs(channel.counts_per_unit);
        const double now = wanted(i);
        out_of_range_ += !(now >= channel.lower - slack && now <= channel.upper + slack);
    }
}

void RigWires::run() {
    std::array<pollfd, kMostPorts> waiting{};
    for (std::size_t i = 0; i < line_.size(); ++i) waiting[i] = {line_[i].terminal.master, POLLIN, 0};
    ::poll(waiting.data(), line_.size(), 1);
    // in whole milliseconds, so that a busy line does not make the steps small
    constexpr double kTick_s = 1e-3;
    const double due_s = steady_s() - began_s_ - time_s_;
    for (double left_s = due_s; left_s >= kTick_s; left_s -= kTick_s) advance_all(kTick_s);
    if (unplug_asked != 0) options_.silent_from_s = time_s_;
    if (garbage_asked != 0) options_.garbage_from_s = time_s_;
    unplug_asked = 0;
    garbage_asked = 0;
    plug(!within(options_.silent_from_s, options_.silent_s, time_s_));
    for (std::size_t i = 0; plugged_ && i < line_.size(); ++i) talk(i);
}

// What the device was told, in its unit, whatever its watchdog makes of it.
double RigWires::wanted(std::size_t channel) const {
    const RigChannel& info = rig_.channels[channel];
    const SimulatedLine& line = line_[info.port];
    std::size_t own = 0;
    for (std::size_t i = 0; i < channel; ++i) own += rig_.channels[i].port == info.port;
    const auto id = static_cast<std::size_t>(info.id);
    switch (rig_.ports[info.port].protocol) {
        case Protocol::framed:
            if (line.framed.state != BoardState::drives || id >= line.framed.outputs) return info.relaxed;
            return value_of(info, line.framed.output[id]);
        case Protocol::sketch:
            return value_of(info, line.sketch[id]);
        case Protocol::dynamixel: {
            const SimulatedDynamixel& servo = line.dynamixel.servo[own];
            if (is_free(servo)) return info.relaxed;
            if (info.drive == Drive::force) return value_of(info, value_at(servo, kDxlGoalCurrent));
            return value_of(info, value_at(servo, kDxlGoalPosition));
        }
        case Protocol::alicat:
            return value_of(info, line.alicat.unit[own].set_point);
        case Protocol::maestro:
            return info.lower + line.maestro->pin[own].height_m;
    }
    return info.relaxed;
}

double RigWires::value(std::size_t channel) const {
    const RigChannel& info = rig_.channels[channel];
    const SimulatedLine& line = line_[info.port];
    std::size_t own = 0;
    for (std::size_t i = 0; i < channel; ++i) own += rig_.channels[i].port == info.port;
    const Protocol protocol = rig_.ports[info.port].protocol;
    if (protocol == Protocol::alicat) return value_of(info, line.alicat.unit[own].pressure);
    const bool by_length = protocol == Protocol::dynamixel && info.drive == Drive::length;
    if (by_length && !is_free(line.dynamixel.servo[own])) return value_of(info, line.dynamixel.servo[own].position);
    return wanted(channel);
}

bool RigWires::relaxed(std::size_t channel) const {
    const RigChannel& info = rig_.channels[channel];
    return std::abs(wanted(channel) - info.relaxed) <=
           kInRange * (info.upper - info.lower) + 1.0 / std::abs(info.counts_per_unit);
}

double RigWires::talking_s() const { return time_s_ - heard_s_ > kPause_s ? 0.0 : time_s_ - talking_from_s_; }

void RigWires::send_reading(std::int32_t counts) {
    const auto t_us = static_cast<std::uint32_t>(static_cast<std::uint64_t>(1e6 * time_s_));
    char text[40];
    const int n = std::snprintf(text, sizeof text, "%u,%d\n", t_us, counts);
    const auto size = static_cast<std::size_t>(n);
    if (udp_ >= 0) {
        if (listener_.empty() || steady_s() - asked_s_ > kListens_s) return;
        ::sendto(udp_, text, size, 0, reinterpret_cast<const sockaddr*>(listener_.data()),
                 static_cast<socklen_t>(listener_.size()));
        return;
    }
    const std::vector<std::uint8_t> bytes =
        through(options_.faults, std::span(reinterpret_cast<const std::uint8_t*>(text), size), random_);
    const ssize_t written = ::write(sensor_.master, bytes.data(), bytes.size());
    static_cast<void>(written);  // without a reader the reading is lost
}

void RigWires::show_displacement(double displacement_m) {
    if (udp_ >= 0) {
        char text[64];
        sockaddr_in from{};
        socklen_t length = sizeof from;
        while (::recvfrom(udp_, text, sizeof text, 0, reinterpret_cast<sockaddr*>(&from), &length) > 0) {
            listener_.assign(reinterpret_cast<const char*>(&from), length);
            asked_s_ = steady_s();
        }
    }
    if (rig_.sensor.empty() || !plugged_ || time_s_ < shown_due_s_) return;
    shown_due_s_ = std::max(shown_due_s_ + 1.0 / options_.sensor_rate_Hz, time_s_ - 0.5 / options_.sensor_rate_Hz);
    const RigSensor& sensor = rig_.sensor.front();
    send_reading(static_cast<std::int32_t>(std::lround(sensor.zero_counts + displacement_m / sensor.m_per_count)));
}

}  // namespace palpa::devices::simulators
