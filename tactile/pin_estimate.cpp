#include "tactile/pin_estimate.h"

#include <algorithm>
#include <cmath>

namespace palpa::tactile {

void estimate_pins(const PinDynamics& dynamics, double rest_m, double time_s, std::span<const double> commanded_m,
                   PinEstimate& estimate) noexcept {
    const std::size_t n = std::min(commanded_m.size(), estimate.height_m.size());
    if (!estimate.begun) {
        estimate.begun = true;
        estimate.time_s = estimate.frame_due_s = time_s;
        estimate.height_m.fill(rest_m);
        estimate.target_m.fill(rest_m);
    }
    const double dt_s = std::max(0.0, time_s - estimate.time_s);
    const double nearer = 1.0 - std::exp(-dt_s / dynamics.lag_s);
    const double most_m = dynamics.speed_m_per_s * dt_s;
    for (std::size_t i = 0; i < n; ++i) {
        const double wish_m = nearer * (estimate.target_m[i] - estimate.height_m[i]);
        estimate.height_m[i] += std::clamp(wish_m, -most_m, most_m);
    }
    estimate.time_s = std::max(estimate.time_s, time_s);
    if (estimate.time_s < estimate.frame_due_s) return;
    std::copy_n(commanded_m.begin(), n, estimate.target_m.begin());
    const double frames = std::floor((estimate.time_s - estimate.frame_due_s) / dynamics.frame_s) + 1.0;
    estimate.frame_due_s += frames * dynamics.frame_s;
}

}  // namespace palpa::tactile
