// Lines of our own frames, and of SoftRobots' sketch frames.

#include <algorithm>
#include <cmath>
#include <limits>

#include "devices/framed.h"
#include "devices/line_io.h"

namespace palpa::devices {
namespace {

constexpr double kFramedReply_s = 0.03;

std::int32_t whole(double counts) { return static_cast<std::int32_t>(std::lround(counts)); }

class FramedLine : public LineProtocol {
  public:
    explicit FramedLine(std::span<const RigChannel> channels) : channels_(channels.begin(), channels.end()) {
        for (const RigChannel& channel : channels_)
            outputs_ = std::max(outputs_, static_cast<std::size_t>(channel.id) + 1);
    }

    PinState prove(platform::SerialPort& port) override {
        Frame is;
        Answer answer = Answer::none;
        for (int i = 0; i < 3 && answer == Answer::none; ++i) answer = tell(FrameKind::relax, {}, port, is);
        if (answer != Answer::good) return state_of(answer);
        LineTargets resting;
        for (std::size_t i = 0; i < channels_.size(); ++i)
            resting.counts[i] = channels_[i].zero_counts + channels_[i].counts_per_unit * channels_[i].relaxed;
        answer = tell(FrameKind::set, resting, port, is);
        if (answer != Answer::good) return state_of(answer);
        pause(1.5 * kFramedTimeout_s);
        answer = tell(FrameKind::ask, {}, port, is);
        if (answer != Answer::good) return state_of(answer);
        const bool fired = is.state == BoardState::timed_out;
        answer = tell(FrameKind::relax, {}, port, is);
        return answer != Answer::good ? state_of(answer) : fired ? PinState::driving : PinState::no_timeout;
    }

    PinState exchange(const LineTargets& targets, platform::SerialPort& port) override {
        Frame is;
        const Answer answer = tell(targets.relaxed ? FrameKind::relax : FrameKind::set, targets, port, is);
        ++health.exchanges;
        if (answer != Answer::good) return answer == Answer::gone ? PinState::gone : PinState::driving;
        health.relaxed = is.state == BoardState::relaxed;
        judge(is.state == BoardState::fault, *this);
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            const auto id = static_cast<std::size_t>(channels_[i].id);
            if (id < is.values) measured[i] = is.value[id];
        }
        if (is.state != BoardState::timed_out || targets.relaxed) return PinState::driving;
        ++health.timeouts;  // this process had no processor for so long; the next `set` drives again
        return tell(FrameKind::relax, targets, port, is) == Answer::gone ? PinState::gone : PinState::driving;
    }

  private:
    Answer tell(FrameKind kind, const LineTargets& targets, platform::SerialPort& port, Frame& is) {
        Frame frame;
        frame.kind = kind;
        frame.sequence = sequence_ = static_cast<std::uint8_t>((sequence_ + 1) & 0x7f);
        if (kind == FrameKind::set) {
            frame.values = outputs_;
            for (std::size_t i = 0; i < channels_.size(); ++i)
                frame.value[static_cast<std::size_t>(channels_[i].id)] = whole(targets.counts[i]);
        }
        return ask(encode_frame(frame).view(), kFramedReply_s, port, parser_, *this, is,
                   [&](const Frame& found) { return found.kind == FrameKind::is && found.sequence == sequence_; });
    }

    std::vector<RigChannel> channels_;
    std::size_t outputs_ = 0;
    std::uint8_t sequence_ = 0;
    FrameParser parser_;
};

// Nobody answers: that a board is there is all that can be known.
class SketchLine : public LineProtocol {
  public:
    explicit SketchLine(std::span<const RigChannel> channels) : channels_(channels.begin(), channels.end()) {
        measured.fill(std::numeric_limits<double>::quiet_NaN());
        for (const RigChannel& channel : channels_)
            outputs_ = std::max(outputs_, static_cast<std::size_t>(channel.id) + 1);
    }
    PinState prove(platform::SerialPort& port) override { return exchange({}, port); }
    PinState exchange(const LineTargets& targets, platform::SerialPort& port) override {
        std::array<std::int32_t, kMostChannels> counts{};
        for (std::size_t i = 0; i < channels_.size(); ++i) {
            const RigChannel& channel = channels_[i];
            const double resting = channel.zero_counts + channel.counts_per_unit * channel.relaxed;
            counts[static_cast<std::size_t>(channel.id)] = whole(targets.relaxed ? resting : targets.counts[i]);
        }
        std::array<std::uint8_t, 64> ignored;
        if (port.read(0.0, ignored.data(), ignored.size()) < 0) return PinState::gone;
        if (!put(encode_sketch_frame(std::span(counts).first(outputs_)).view(), port)) return PinState::gone;
        ++health.exchanges;
        health.relaxed = targets.relaxed;
        return PinState::driving;
    }

  private:
    std::vector<RigChannel> channels_;
    std::size_t outputs_ = 0;
};

}  // namespace

std::unique_ptr<LineProtocol> make_framed_line(const RigPort& port, std::span<const RigChannel> channels) {
    if (port.protocol == Protocol::sketch) return std::make_unique<SketchLine>(channels);
    return std::make_unique<FramedLine>(channels);
}

}  // namespace palpa::devices
