#include "tactile/mismatch.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace palpa::tactile {
namespace {

constexpr std::int64_t kShapes = MismatchMeter::kLatest - MismatchMeter::kEarliest + 1;
constexpr std::int64_t kReached = 1 - MismatchMeter::kEarliest;
constexpr std::int64_t kEvery = 4;  // steps from one comparison of times to the next

void store(std::span<const double> values, std::int64_t at, std::vector<float>& ring) {
    float* to = ring.data() + static_cast<std::size_t>(at) * values.size();
    for (const double value : values) *to++ = static_cast<float>(value);
}

// Compares what was reached kEarliest steps ago with what was wanted before and after.
void compare_times(std::size_t pins, MismatchMeter& meter) {
    const std::int64_t then = meter.seen - 1 + MismatchMeter::kEarliest;
    const float* reached = meter.reached_m.data() + static_cast<std::size_t>(then % kReached) * pins;
    for (std::int64_t lag = MismatchMeter::kEarliest; lag <= MismatchMeter::kLatest; ++lag) {
        const float* wanted = meter.wanted_m.data() + static_cast<std::size_t>((then - lag) % kShapes) * pins;
        double sum_m2 = 0.0;
        for (std::size_t i = 0; i < pins; ++i) {
            const double off_m = static_cast<double>(reached[i]) - static_cast<double>(wanted[i]);
            sum_m2 += off_m * off_m;
        }
        meter.by_lag_m2[static_cast<std::size_t>(lag - MismatchMeter::kEarliest)] += sum_m2;
    }
}

}  // namespace

void add(std::span<const double> wanted_m, std::span<const double> reached_m, bool pressed, MismatchMeter& meter) {
    assert(wanted_m.size() == reached_m.size());
    const std::size_t pins = wanted_m.size();
    if (pins == 0) return;
    if (meter.seen == 0) {
        meter.wanted_m.assign(static_cast<std::size_t>(kShapes) * pins, 0.0F);
        meter.reached_m.assign(static_cast<std::size_t>(kReached) * pins, 0.0F);
    }
    store(wanted_m, meter.seen % kShapes, meter.wanted_m);
    store(reached_m, meter.seen % kReached, meter.reached_m);
    ++meter.seen;
    if (meter.seen >= kShapes && meter.seen % kEvery == 0) compare_times(pins, meter);
    if (!pressed) return;
    double sum_m2 = 0.0;
    for (std::size_t i = 0; i < pins; ++i) {
        const double off_m = reached_m[i] - wanted_m[i];
        sum_m2 += off_m * off_m;
        meter.max_m = std::max(meter.max_m, std::abs(off_m));
    }
    ++meter.steps;
    meter.sum_m2 += sum_m2 / static_cast<double>(pins);
}

double rms_m(const MismatchMeter& meter) {
    if (meter.steps == 0) return std::numeric_limits<double>::quiet_NaN();
    return std::sqrt(meter.sum_m2 / static_cast<double>(meter.steps));
}

double lag_s(const MismatchMeter& meter) {
    const auto& sums = meter.by_lag_m2;
    const auto least = std::min_element(sums.begin(), sums.end());
    const auto most = std::max_element(sums.begin(), sums.end());
    constexpr double kLeast_m = 20e-6;  // in 25 comparisons, which are a tenth of a second
    const auto pins = static_cast<double>(meter.wanted_m.size()) / static_cast<double>(kShapes);
    if (!(*most - *least > 25.0 * pins * kLeast_m * kLeast_m)) return std::numeric_limits<double>::quiet_NaN();
    auto lag = static_cast<double>(least - sums.begin()) + MismatchMeter::kEarliest;
    if (least != sums.begin() && least + 1 != sums.end()) {  // the vertex of the parabola through three sums
        const double bend = least[-1] - 2.0 * least[0] + least[1];
        if (bend > 0.0) lag += 0.5 * (least[-1] - least[1]) / bend;
    }
    return 1e-3 * lag;
}

}  // namespace palpa::tactile
