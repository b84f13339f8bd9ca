#pragma once
// How far pins are from the shape that is wanted of them, in height and in time.

#include <array>
#include <cstdint>
#include <span>
#include <vector>

#include "devices/pins.h"

namespace palpa::tactile {

// Filled by add(), once per step of 1 ms.
struct MismatchMeter {
    static constexpr int kEarliest = -30;  // steps by which the pins may be ahead
    static constexpr int kLatest = 150;    // and behind
    std::int64_t steps = 0;                // in which the finger pressed
    double sum_m2 = 0.0;                   // over the steps: mean square over the pins
    double max_m = 0.0;
    // Sum of squares of (reached now - wanted before), for each time between.
    std::array<double, kLatest - kEarliest + 1> by_lag_m2{};
    std::vector<float> wanted_m;  // the last kLatest - kEarliest + 1 shapes, then the last -kEarliest + 1 reached ones
    std::vector<float> reached_m;
    std::int64_t seen = 0;
};

// Adds a step: heights of all pins (the same number each time), wanted and reached at one moment. Steps without a press
// count for the time only. Not for a loop: the comparison of times takes 20 us for 36 pins.
void add(std::span<const double> wanted_m, std::span<const double> reached_m, bool pressed, MismatchMeter& meter);

double rms_m(const MismatchMeter& meter);  // over steps and pins; NaN without a press
// How long the reached heights are behind the wanted ones: the shift in time that leaves the smallest difference, in s
// (negative: ahead). NaN as long as the pins have moved too little to tell.
double lag_s(const MismatchMeter& meter);

}  // namespace palpa::tactile
