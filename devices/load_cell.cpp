#include "devices/load_cell.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <chrono>
#include <cmath>
#include <exception>
#include <thread>

#include "platform/serial_port.h"

namespace palpa::devices {
namespace {

bool parse(const std::string& line, LoadCellLine& out) {
    const char* end = line.data() + line.size();
    const auto time = std::from_chars(line.data(), end, out.t_us);
    if (time.ec != std::errc() || time.ptr == end || *time.ptr != ',') return false;
    const auto raw = std::from_chars(time.ptr + 1, end, out.raw);
    if (raw.ec != std::errc() || raw.ptr != end) return false;
    return out.raw >= -(1 << 23) && out.raw < (1 << 23);
}

class LoadCell : public ForceSensor {
  public:
    explicit LoadCell(const LoadCellOptions& options)
        : options_(options), port_(std::make_unique<platform::SerialPort>(options.path, options.baud)) {}

    void read(double wait_s, std::vector<ForceReading>& out) override {
        std::array<std::uint8_t, 4096> bytes;
        const int n = port_ ? port_->read(wait_s, bytes.data(), bytes.size()) : reopen(wait_s);
        if (n < 0) {
            port_.reset();
            parser_ = {};
            tried_s_ = steady_s();
        }
        for (int i = 0; i < n; ++i) {
            LoadCellLine line;
            if (feed(bytes[static_cast<std::size_t>(i)], parser_, health_, line)) take(line, out);
        }
        constexpr double kSilence_s = 0.5;
        if (health_.alive && steady_s() - last_s_ > kSilence_s) {
            health_.alive = false;
            ++health_.stalls;
        }
    }

    const SensorHealth& health() const override { return health_; }
    std::string name() const override { return "load cell at " + options_.path; }

  private:
    // After the port was unplugged, tries to open it twice a second.
    int reopen(double wait_s) {
        constexpr double kAgain_s = 0.5;
        const double due_s = tried_s_ + kAgain_s - steady_s();
        std::this_thread::sleep_for(std::chrono::duration<double>(std::min(wait_s, std::max(due_s, 0.0))));
        if (due_s > wait_s) return 0;
        tried_s_ = steady_s();
        try {
            port_ = std::make_unique<platform::SerialPort>(options_.path, options_.baud);
            clock_ = {};
            ++health_.reconnects;
        } catch (const std::exception&) {
            // still gone
        }
        return 0;
    }

    void take(const LoadCellLine& line, std::vector<ForceReading>& out) {
        last_s_ = steady_s();
        health_.alive = true;
        if (!take_time(line.t_us, clock_, health_)) return;
        ForceReading reading;
        reading.t_host_s = last_s_;
        reading.t_device_s = 1e-6 * static_cast<double>(clock_.total_us);
        reading.raw = line.raw;
        reading.force_N = options_.N_per_count * line.raw;
        out.push_back(reading);
        ++health_.received;
    }

    LoadCellOptions options_;
    std::unique_ptr<platform::SerialPort> port_;
    LineParser parser_;
    LoadCellClock clock_;
    SensorHealth health_;
    double last_s_ = 0.0;
    double tried_s_ = 0.0;
};

}  // namespace

bool feed(std::uint8_t byte, LineParser& parser, SensorHealth& health, LoadCellLine& out) {
    constexpr std::size_t kLongest = 32;  // "4294967295,-8388608\r" has 20
    if (byte == '\n') {
        const bool whole = !parser.skipping;
        if (!parser.line.empty() && parser.line.back() == '\r') parser.line.pop_back();
        const bool good = whole && parse(parser.line, out);
        if (whole && !good) ++health.malformed;
        parser.line.clear();
        parser.skipping = false;
        return good;
    }
    if (parser.skipping) return false;
    parser.line.push_back(static_cast<char>(byte));
    if (parser.line.size() > kLongest) {
        ++health.malformed;
        parser.line.clear();
        parser.skipping = true;
    }
    return false;
}

bool take_time(std::uint32_t t_us, LoadCellClock& clock, SensorHealth& health) {
    if (!clock.started) {
        clock.started = true;
        clock.last_us = t_us;
        return true;
    }
    const auto step_us = static_cast<std::int32_t>(t_us - clock.last_us);  // across the wrap-around
    if (step_us == 0) {
        ++health.duplicate;
        return false;
    }
    if (step_us < 0) {
        constexpr std::int32_t kRestart_us = -2'000'000;
        if (step_us > kRestart_us) {
            ++health.reordered;
            if (health.lost > 0) --health.lost;  // it had been counted as lost
            return false;
        }
        clock.total_us += 1;  // the board was reset and its clock restarted
        clock.last_us = t_us;
        return true;
    }
    clock.last_us = t_us;
    clock.total_us += step_us;
    ++clock.steps;
    constexpr std::int64_t kLearn = 16;
    if (clock.period_us == 0.0) clock.period_us = step_us;
    if (step_us < 1.5 * clock.period_us) clock.period_us += (step_us - clock.period_us) / 8.0;  // follows a slow drift
    if (step_us < 0.7 * clock.period_us) clock.period_us = step_us;
    if (clock.steps > kLearn && step_us > 1.5 * clock.period_us)
        health.lost += std::lround(step_us / clock.period_us) - 1;
    return true;
}

std::unique_ptr<ForceSensor> open_load_cell(const LoadCellOptions& options) {
    return std::make_unique<LoadCell>(options);
}

}  // namespace palpa::devices
