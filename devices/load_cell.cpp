#include "devices/load_cell.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <iterator>
#include <utility>

#include "devices/counts_stream.h"

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

double usual_step_us(const LoadCellClock& clock) {
    auto steps = clock.recent_us;
    const auto quartile = steps.begin() + std::ssize(steps) / 4;
    std::nth_element(steps.begin(), quartile, steps.end());
    return *quartile;
}

class LoadCell : public ForceSensor {
  public:
    explicit LoadCell(const LoadCellOptions& options)
        : options_(options), stream_(CountsPlace{options.path, options.baud, "", 0}) {}

    void read(double wait_s, std::vector<ForceReading>& out) override {
        readings_.clear();
        stream_.read(wait_s, readings_);
        for (const CountsReading& from : readings_) {
            ForceReading reading;
            reading.t_host_s = from.t_host_s;
            reading.t_device_s = from.t_device_s;
            reading.raw = from.counts;
            reading.force_N = options_.N_per_count * from.counts;
            out.push_back(reading);
        }
    }

    const SensorHealth& health() const override { return stream_.health(); }
    std::string name() const override { return "load cell at " + options_.path; }

  private:
    LoadCellOptions options_;
    CountsStream stream_;
    std::vector<CountsReading> readings_;
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
        clock.malformed = health.malformed;
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
        clock.malformed = health.malformed;
        return true;
    }
    clock.last_us = t_us;
    clock.total_us += step_us;
    const std::size_t recent = clock.recent_us.size();
    const std::int32_t before_us = clock.recent_us[static_cast<std::size_t>(clock.steps - 1) % recent];
    clock.recent_us[static_cast<std::size_t>(clock.steps) % recent] = step_us;
    const bool known = ++clock.steps > static_cast<std::int64_t>(recent);
    const std::int64_t garbled = health.malformed - clock.malformed;
    clock.malformed = health.malformed;
    const std::int64_t lost_before = std::exchange(clock.lost_before, 0);
    if (!known) return true;
    const double period_us = usual_step_us(clock);
    const auto missing = [&](double us) { return std::lround(us / period_us); };
    if (step_us > 1.5 * period_us) {
        clock.lost_before = std::max<std::int64_t>(0, missing(step_us) - 1 - garbled);
        health.lost += clock.lost_before;
    } else if (step_us < 0.7 * period_us && lost_before > 0) {
        const std::int64_t lost = std::max<std::int64_t>(0, missing(static_cast<double>(before_us) + step_us) - 2);
        health.lost -= std::max<std::int64_t>(0, lost_before - lost);  // the reading before was late
    }
    return true;
}

std::unique_ptr<ForceSensor> open_load_cell(const LoadCellOptions& options) {
    return std::make_unique<LoadCell>(options);
}

}  // namespace palpa::devices
