// Lines of Alicat pressure controllers.

#include <algorithm>
#include <cmath>

#include "devices/alicat.h"
#include "devices/line_io.h"

namespace palpa::devices {
namespace {

constexpr double kAlicatReply_s = 0.06;
constexpr double kEchoShare = 2e-3;  // a unit rounds the set point to the digits that it shows
constexpr double kBitsPerByte = 10.0;

class AlicatLine : public LineProtocol {
  public:
    AlicatLine(const RigPort& port, std::span<const RigChannel> channels)
        : port_(port), channels_(channels.begin(), channels.end()), resting_(channels.size(), false) {
        // question and answer of about 40 bytes, and the silence between them
        period_s = std::max(0.01, 60.0 * kBitsPerByte / port.baud);
    }

    PinState prove(platform::SerialPort& port) override {
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            AlicatFrame frame;
            Answer answer = Answer::none;
            for (int k = 0; k < 3 && answer == Answer::none; ++k)
                answer = command(encode_alicat_cancel_hold(unit(i)), i, port, frame);
            if (answer != Answer::good) return state_of(answer);
            answer = set(i, relaxed_counts(i), port);
            if (answer != Answer::good) return state_of(answer);
            if (!resting_[i]) return PinState::faulty;  // it does not take set points from the line
        }
        return PinState::driving;
    }

    // One unit in each exchange: they share the line.
    PinState exchange(const LineTargets& targets, platform::SerialPort& port) override {
        asked_ = (asked_ + 1) % channels_.size();
        const double counts = targets.relaxed ? relaxed_counts(asked_) : targets.counts[asked_];
        const Answer answer = set(asked_, counts, port);
        ++health.exchanges;
        health.relaxed =
            targets.relaxed && std::all_of(resting_.begin(), resting_.end(), [](bool rests) { return rests; });
        return answer == Answer::gone ? PinState::gone : PinState::driving;
    }

  private:
    char unit(std::size_t i) const { return static_cast<char>('A' + channels_[i].id); }
    double relaxed_counts(std::size_t i) const {
        return channels_[i].zero_counts + channels_[i].counts_per_unit * channels_[i].relaxed;
    }

    Answer command(const AlicatCommand& text, std::size_t i, platform::SerialPort& port, AlicatFrame& frame) {
        pause(4.0 * kBitsPerByte / port_.baud);  // it acts after 3.5 bytes of silence
        const auto fields = static_cast<std::size_t>(std::max(port_.pressure_field, port_.set_point_field)) + 1;
        const std::string_view view = text.view();
        return ask({reinterpret_cast<const std::uint8_t*>(view.data()), view.size()}, kAlicatReply_s, port, parser_,
                   *this, frame,
                   [&](const AlicatFrame& found) { return found.unit == unit(i) && found.values >= fields; });
    }

    Answer set(std::size_t i, double counts, platform::SerialPort& port) {
        AlicatFrame frame;
        const Answer answer = command(encode_alicat_set_point(unit(i), counts, port_.spaced), i, port, frame);
        if (answer != Answer::good) return answer;
        const double echo = frame.value[static_cast<std::size_t>(port_.set_point_field)];
        const double range = std::abs(channels_[i].counts_per_unit * (channels_[i].upper - channels_[i].lower));
        const bool taken = std::abs(echo - counts) <= kEchoShare * range + 0.0051 * (range >= 1.0);
        judge(!taken, *this);
        resting_[i] = taken && counts == relaxed_counts(i);
        measured[i] = frame.value[static_cast<std::size_t>(port_.pressure_field)];
        return answer;
    }

    RigPort port_;
    std::vector<RigChannel> channels_;
    std::vector<bool> resting_;
    std::size_t asked_ = 0;
    AlicatParser parser_;
};

}  // namespace

std::unique_ptr<LineProtocol> make_alicat_line(const RigPort& port, std::span<const RigChannel> channels) {
    return std::make_unique<AlicatLine>(port, channels);
}

}  // namespace palpa::devices
