#pragma once
// A serial line of actuators, driven from a thread of its own.

#include <memory>
#include <span>

#include "devices/rig.h"

namespace palpa::platform {
class SerialPort;
}

namespace palpa::devices {

struct LineHealth {
    PinState state = PinState::proving;
    bool relaxed = false;         // every actuator of the line has confirmed that it is at rest, where it can
    std::int64_t exchanges = 0;   // targets written
    std::int64_t replies = 0;     // good ones
    std::int64_t missing = 0;     // questions without one
    std::int64_t malformed = 0;   // replies that were garbled
    std::int64_t errors = 0;      // replies that report an error
    std::int64_t timeouts = 0;    // watchdogs of the devices that fired while they were driven
    std::int64_t reconnects = 0;  // of an unplugged port
};

// Proves the devices (they answer; their watchdogs fire when the line is silent, where the protocol has any), then writes the
// targets again and again and reads what comes back. If send() is not called for 100 ms, the actuators rest. Twice a second a
// port that was unplugged is opened again, and devices that do not answer are proved again.
class ActuatorLine {
  public:
    // Throws std::runtime_error with the system's reason if the port cannot be opened.
    ActuatorLine(const ActuatorRig& rig, std::size_t port);
    // The actuators rest: it waits until they have confirmed it, for half a second at most, and two if the port is unplugged.
    ~ActuatorLine();
    ActuatorLine(const ActuatorLine&) = delete;
    ActuatorLine& operator=(const ActuatorLine&) = delete;

    // Values of all channels of the rig, of which the line takes its own. Never waits.
    void send(std::span<const double> values, bool relaxed) noexcept;
    LineHealth health() const;
    // The latest reading of a channel of this line, in its unit; NaN if there is none. dynamixel by force: of the current.
    double measured(std::size_t channel) const noexcept;

  private:
    struct Works;
    std::unique_ptr<Works> works_;
    std::unique_ptr<PinDriver> pins_;
    ActuatorRig rig_;
    std::size_t port_;
};

// What a line's thread does by protocol.
struct LineTargets {
    std::array<double, kMostChannels> counts{};  // by channel of the line
    bool relaxed = true;
};

class LineProtocol {
  public:
    virtual ~LineProtocol() = default;
    // Makes the devices ready, at rest. Returns driving, or what keeps them from being driven.
    virtual PinState prove(platform::SerialPort& port) = 0;
    // Writes the targets, asks one device. Returns gone, or driving.
    virtual PinState exchange(const LineTargets& targets, platform::SerialPort& port) = 0;

    double period_s = 0.005;
    LineHealth health;
    int bad_in_a_row = 0;                          // questions without a good answer
    std::array<double, kMostChannels> measured{};  // counts
};

// `channels`: of the line.
std::unique_ptr<LineProtocol> make_framed_line(const RigPort& port, std::span<const RigChannel> channels);
std::unique_ptr<LineProtocol> make_dynamixel_line(const RigPort& port, std::span<const RigChannel> channels);
std::unique_ptr<LineProtocol> make_alicat_line(const RigPort& port, std::span<const RigChannel> channels);

}  // namespace palpa::devices
