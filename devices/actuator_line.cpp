#include "devices/actuator_line.h"

#include <algorithm>
#include <atomic>
#include <cmath>
#include <exception>
#include <limits>
#include <mutex>
#include <thread>

#include "devices/force_sensor.h"
#include "devices/line_io.h"
#include "platform/real_time.h"

namespace palpa::devices {
namespace {

constexpr double kLineUnsent_s = 0.1;
constexpr double kLineAgain_s = 0.5;
constexpr double kRelaxHere_s = 0.5;  // until every actuator has confirmed at the end
constexpr double kRelaxGone_s = 2.0;  // for a port that may be plugged in again
constexpr int kBadInARow = 20;

std::vector<RigChannel> channels_of(const ActuatorRig& rig, std::size_t port) {
    std::vector<RigChannel> channels;
    for (const RigChannel& channel : rig.channels) {
        if (channel.port == port) channels.push_back(channel);
    }
    return channels;
}

std::unique_ptr<LineProtocol> make_protocol(const RigPort& port, std::span<const RigChannel> channels) {
    switch (port.protocol) {
        case Protocol::dynamixel:
            return make_dynamixel_line(port, channels);
        case Protocol::alicat:
            return make_alicat_line(port, channels);
        default:
            return make_framed_line(port, channels);
    }
}

}  // namespace

struct ActuatorLine::Works {
    Works(const RigPort& where, std::vector<RigChannel> own)
        : port_info(where),
          channels(std::move(own)),
          protocol(make_protocol(where, channels)),
          port(std::make_unique<platform::SerialPort>(where.path, where.baud)) {
        for (auto& value : measured) value.store(std::numeric_limits<double>::quiet_NaN());
        protocol->measured.fill(std::numeric_limits<double>::quiet_NaN());
    }

    RigPort port_info;
    std::vector<RigChannel> channels;
    std::array<std::atomic<double>, kMostChannels> wanted{};    // counts
    std::array<std::atomic<double>, kMostChannels> measured{};  // counts
    std::atomic<bool> relaxed{true};
    std::atomic<double> sent_s{-1e9};  // when send() was called last
    std::atomic<bool> ending{false};
    mutable std::mutex copy_guard;  // guards the copy below; locked once an exchange
    LineHealth copy;

    // of the thread alone
    std::unique_ptr<LineProtocol> protocol;
    std::unique_ptr<platform::SerialPort> port;  // null while it is unplugged
    PinState state = PinState::proving;
    double tried_s = 0.0;
    std::int64_t reconnects = 0;
    std::thread thread;

    void run();
    void prove();
    void reopen();
    void exchange(bool resting);
    void publish(PinState now);
    void end();
};

void ActuatorLine::Works::publish(PinState now) {
    state = now;
    for (std::size_t i = 0; i < channels.size(); ++i) measured[i].store(protocol->measured[i]);
    const std::lock_guard<std::mutex> guard(copy_guard);
    copy = protocol->health;
    copy.state = now;
    copy.reconnects = reconnects;
}

// Until it is proved, a line that was in trouble stays so: a fault lasts until the actuators are driven again.
void ActuatorLine::Works::prove() {
    protocol->bad_in_a_row = 0;
    protocol->health.relaxed = false;
    publish(state);
    tried_s = steady_s();
    publish(protocol->prove(*port));
}

// Also for devices that did not answer or are not safe: a garbled reply may have been the reason.
void ActuatorLine::Works::reopen() {
    const double due_s = tried_s + kLineAgain_s - steady_s();
    if (due_s > 0.0) return pause(std::min(due_s, 0.01));
    tried_s = steady_s();
    try {
        port.reset();
        port = std::make_unique<platform::SerialPort>(port_info.path, port_info.baud);
    } catch (const std::exception&) {
        return publish(PinState::gone);  // still
    }
    reconnects += state == PinState::gone;
    prove();
}

void ActuatorLine::Works::exchange(bool resting) {
    LineTargets targets;
    targets.relaxed = resting;
    for (std::size_t i = 0; i < channels.size(); ++i) targets.counts[i] = wanted[i].load(std::memory_order_relaxed);
    PinState now = protocol->exchange(targets, *port);
    if (now == PinState::gone) port.reset();
    if (now == PinState::driving && protocol->bad_in_a_row >= kBadInARow) now = PinState::faulty;
    publish(now);
}

void ActuatorLine::Works::end() {
    const double began_s = steady_s();
    for (double now_s = began_s; now_s - began_s < (port ? kRelaxHere_s : kRelaxGone_s); now_s = steady_s()) {
        if (!port) {
            reopen();
            continue;
        }
        exchange(true);
        if (protocol->health.relaxed) return;
    }
}

void ActuatorLine::Works::run() {
    // where it is granted; else a busy computer may let the watchdogs fire
    platform::set_real_time(true, platform::kGuardPriority);
    prove();
    for (double due_s = steady_s(); !ending.load();) {
        if (state == PinState::driving) {
            exchange(relaxed.load() || steady_s() - sent_s.load() > kLineUnsent_s);
        } else {
            reopen();
        }
        due_s = std::max(due_s + protocol->period_s, steady_s() - protocol->period_s);
        pause(due_s - steady_s());
    }
    end();
}

ActuatorLine::ActuatorLine(const ActuatorRig& rig, std::size_t port) : rig_(rig), port_(port) {
    if (rig.ports[port].protocol == Protocol::maestro) {
        pins_ = std::make_unique<PinDriver>(pins_of(rig, port));
        return;
    }
    works_ = std::make_unique<Works>(rig.ports[port], channels_of(rig, port));
    works_->thread = std::thread([works = works_.get()] { works->run(); });
}

ActuatorLine::~ActuatorLine() {
    if (!works_) return;
    works_->ending.store(true);
    works_->thread.join();
}

void ActuatorLine::send(std::span<const double> values, bool relaxed) noexcept {
    const RigPort& port = rig_.ports[port_];
    std::array<double, kMostChannels> heights_m{};
    std::size_t own = 0;
    for (std::size_t i = 0; i < rig_.channels.size(); ++i) {
        const RigChannel& channel = rig_.channels[i];
        if (channel.port != port_) continue;
        const double value = relaxed || i >= values.size() ? channel.relaxed : values[i];
        if (works_) works_->wanted[own].store(counts_of(port, channel, value), std::memory_order_relaxed);
        heights_m[own++] = value - channel.lower;
    }
    if (pins_) return pins_->send(std::span(heights_m).first(own));
    works_->relaxed.store(relaxed);
    works_->sent_s.store(steady_s());
}

LineHealth ActuatorLine::health() const {
    if (works_) {
        const std::lock_guard<std::mutex> guard(works_->copy_guard);
        return works_->copy;
    }
    const PinHealth pins = pins_->health();
    LineHealth health;
    health.state = pins.state;
    health.relaxed = pins.resting;
    health.exchanges = pins.frames;
    health.malformed = pins.malformed;
    health.reconnects = pins.reconnects;
    for (std::size_t i = 0; i < pins.boards; ++i) {
        health.missing += pins.board[i].missing;
        health.errors += pins.board[i].error_replies;
    }
    return health;
}

double ActuatorLine::measured(std::size_t channel) const noexcept {
    double counts = std::numeric_limits<double>::quiet_NaN();
    std::size_t own = 0;
    for (std::size_t i = 0; i < channel; ++i) own += rig_.channels[i].port == port_;
    if (works_ && rig_.channels[channel].port == port_) counts = works_->measured[own].load();
    return value_of(rig_.channels[channel], counts);
}

}  // namespace palpa::devices
