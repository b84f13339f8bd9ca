// Lines of Dynamixel servos.

#include <algorithm>
#include <cmath>

#include "devices/dynamixel.h"
#include "devices/line_io.h"

namespace palpa::devices {
namespace {

constexpr double kDxlReply_s = 0.02;
constexpr std::int32_t kDxlTimeout = 5;                       // of the servos' watchdogs, in 20 ms
constexpr DynamixelItem kDxlState{kDxlWatchdog.address, 38};  // watchdog, goals and present values in one reading
constexpr std::size_t kDxlCurrentAt = kDxlPresent.address - kDxlWatchdog.address;
constexpr std::size_t kDxlPositionAt = kDxlCurrentAt + 6;
constexpr std::uint8_t kDxlAlert = 0x80;  // the servo has a hardware error

class DynamixelLine : public LineProtocol {
  public:
    explicit DynamixelLine(std::span<const RigChannel> channels) : channels_(channels.begin(), channels.end()) {
        period_s = 0.004;
    }

    PinState prove(platform::SerialPort& port) override {
        engaged_ = false;
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            const Answer answer = prepare(i, port);
            if (answer != Answer::good) return state_of(answer);
        }
        if (const Answer answer = engage(port); answer != Answer::good) return state_of(answer);
        pause((static_cast<double>(kDxlTimeout) + 2.0) * kDxlWatchdogUnit_s);
        bool fired = true;
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            DynamixelMessage status;
            const Answer answer = ask_servo(encode_dynamixel_read(channels_[i].id, kDxlWatchdog), i, 1, port, status);
            if (answer != Answer::good) return state_of(answer);
            fired = fired && status.parameter[1] == kDxlWatchdogFired;
        }
        const Answer answer = disengage(port);
        return answer != Answer::good ? state_of(answer) : fired ? PinState::driving : PinState::no_timeout;
    }

    PinState exchange(const LineTargets& targets, platform::SerialPort& port) override {
        Answer answer = Answer::good;
        if (targets.relaxed && (engaged_ || !health.relaxed)) answer = disengage(port);
        if (!targets.relaxed && !engaged_) answer = engage(port);
        if (answer == Answer::good && engaged_ && !write_goals(targets, port)) answer = Answer::gone;
        ++health.exchanges;
        if (answer == Answer::good) answer = read_state(port);
        return answer == Answer::gone ? PinState::gone : PinState::driving;
    }

  private:
    bool by_force(std::size_t i) const { return channels_[i].drive == Drive::force; }
    std::int32_t resting(std::size_t i) const {
        const RigChannel& channel = channels_[i];
        return static_cast<std::int32_t>(std::lround(channel.zero_counts + channel.counts_per_unit * channel.relaxed));
    }

    // `parameters`: behind the error of the status.
    Answer ask_servo(const DynamixelPacket& packet, std::size_t i, std::size_t parameters, platform::SerialPort& port,
                     DynamixelMessage& status) {
        return ask(packet.view(), kDxlReply_s, port, parser_, *this, status, [&](const DynamixelMessage& found) {
            return found.instruction == kDynamixelStatus && found.id == channels_[i].id &&
                   found.parameters == 1 + parameters;
        });
    }

    // Writes a value and asks again up to three times; a servo that refuses it has not taken it.
    Answer write(std::size_t i, DynamixelItem item, std::int32_t value, platform::SerialPort& port) {
        Answer answer = Answer::none;
        for (int k = 0; k < 3 && answer == Answer::none; ++k) {
            DynamixelMessage status;
            answer = ask_servo(encode_dynamixel_write(channels_[i].id, item, value), i, 0, port, status);
            const bool refused = answer == Answer::good && (status.parameter[0] & ~kDxlAlert) != 0;
            if (refused) answer = Answer::none;
            health.errors += refused;
        }
        return answer;
    }

    struct Value {
        DynamixelItem item;
        std::int32_t value;
    };
    Answer write_all(std::size_t i, std::initializer_list<Value> values, platform::SerialPort& port) {
        for (const Value& value : values) {
            const Answer answer = write(i, value.item, value.value, port);
            if (answer != Answer::good) return answer;
        }
        return Answer::good;
    }

    Answer prepare(std::size_t i, platform::SerialPort& port) {
        return write_all(
            i, {{kDxlTorque, 0}, {kDxlWatchdog, 0}, {kDxlMode, by_force(i) ? kDxlCurrent : kDxlPositionWithinCurrent}},
            port);
    }

    // From rest: the goals are at rest before the torque comes on.
    Answer engage(platform::SerialPort& port) {
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            const std::int32_t limit = static_cast<std::int32_t>(channels_[i].current_limit_counts);
            Answer answer =
                write_all(i, {{kDxlWatchdog, 0}, {kDxlGoalCurrent, by_force(i) ? resting(i) : limit}}, port);
            if (answer == Answer::good && !by_force(i)) answer = write(i, kDxlGoalPosition, resting(i), port);
            if (answer == Answer::good) answer = write_all(i, {{kDxlTorque, 1}, {kDxlWatchdog, kDxlTimeout}}, port);
            if (answer != Answer::good) return answer;
        }
        engaged_ = true;
        health.relaxed = false;
        return Answer::good;
    }

    // The torque goes off on every servo, whether the others answer or not.
    Answer disengage(platform::SerialPort& port) {
        Answer worst = Answer::good;
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            const Answer answer = write(i, kDxlTorque, 0, port);
            if (answer == Answer::gone) return answer;
            if (answer != Answer::good) worst = answer;
        }
        engaged_ = engaged_ && worst != Answer::good;
        health.relaxed = worst == Answer::good;
        return worst;
    }

    bool write_goals(const LineTargets& targets, platform::SerialPort& port) {
        for (const bool force : {true, false}) {
            std::array<int, kMostChannels> ids{};
            std::array<std::int32_t, kMostChannels> goals{};
            std::size_t n = 0;
            for (std::size_t i = 0; i < channels_.size(); ++i) {
                if (by_force(i) != force) continue;
                ids[n] = channels_[i].id;
                goals[n++] = static_cast<std::int32_t>(std::lround(targets.counts[i]));
            }
            const DynamixelPacket packet = encode_dynamixel_sync_write(
                force ? kDxlGoalCurrent : kDxlGoalPosition, std::span(ids).first(n), std::span(goals).first(n));
            if (n > 0 && !put(packet.view(), port)) return false;
        }
        return true;
    }

    // One servo in each exchange.
    Answer read_state(platform::SerialPort& port) {
        asked_ = (asked_ + 1) % channels_.size();
        DynamixelMessage status;
        const Answer answer =
            ask_servo(encode_dynamixel_read(channels_[asked_].id, kDxlState), asked_, kDxlState.bytes, port, status);
        if (answer != Answer::good) return answer;
        judge(status.parameter[0] != 0, *this);
        const std::span<const std::uint8_t> state = std::span(status.parameter).subspan(1, kDxlState.bytes);
        measured[asked_] = by_force(asked_) ? dynamixel_value(state.subspan(kDxlCurrentAt, 2))
                                            : dynamixel_value(state.subspan(kDxlPositionAt, 4));
        if (engaged_ && state[0] == kDxlWatchdogFired) {
            ++health.timeouts;  // this process had no processor for so long; the next exchange engages again
            return disengage(port);
        }
        return answer;
    }

    std::vector<RigChannel> channels_;
    bool engaged_ = false;
    std::size_t asked_ = 0;
    DynamixelParser parser_;
};

}  // namespace

std::unique_ptr<LineProtocol> make_dynamixel_line(const RigPort& /*port*/, std::span<const RigChannel> channels) {
    return std::make_unique<DynamixelLine>(channels);
}

}  // namespace palpa::devices
