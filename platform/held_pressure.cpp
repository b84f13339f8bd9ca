#include "platform/held_pressure.h"

#include <algorithm>
#include <cmath>

namespace palpa::platform {

double held_share(double held_s, double hold_s) { return hold_s <= 0.0 ? 1.0 : std::clamp(held_s / hold_s, 0.0, 1.0); }

double pressure_at(const HeldPressure& held, double t_host_s) {
    if (held.by_level) return held.level;
    return held.down ? held_share(t_host_s - held.down_s, held.hold_s) : 0.0;
}

void turn_level(double t_host_s, double notches, HeldPressure& held) {
    held.level = std::clamp(pressure_at(held, t_host_s) + kLevelStep * notches, 0.0, 1.0);
    held.by_level = held.down || held.level > 0.0;
}

std::int64_t last_grid_point(double t_s) { return static_cast<std::int64_t>(std::floor(t_s * kHoldGrid_Hz)); }

double grid_time_s(std::int64_t point) { return static_cast<double>(point) / kHoldGrid_Hz; }

std::int64_t first_grid_point(std::int64_t done, std::int64_t now) {
    constexpr auto kMost = static_cast<std::int64_t>(60.0 * kHoldGrid_Hz);
    return std::max(done, now - kMost) + 1;
}

}  // namespace palpa::platform
