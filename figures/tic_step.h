#pragma once

#include <algorithm>
#include <cmath>

namespace palpa::figures {

// Returns a round step between the tics of an axis (1, 2 or 5 times a power of ten) that divides `range` into at most
// `about` pieces.
inline double tic_step(double range, double about) {
    const double rough = std::max(range / std::max(1.0, about), 1e-12);
    const double power = std::pow(10.0, std::floor(std::log10(rough)));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (step * power >= rough) return step * power;
    }
    return 10.0 * power;
}

}  // namespace palpa::figures
