#include "tactile/motion.h"

#include <algorithm>

namespace palpa::tactile {
namespace {

// The sample before the last one by `back`.
const MotionSample& latest(const Motion& motion, std::size_t back) {
    return motion.sample[(motion.next + Motion::kMost - 1 - back) % Motion::kMost];
}

// How many of the latest samples the lines are fitted to.
std::size_t fitted(const Motion& motion) {
    std::size_t n = std::min<std::size_t>(motion.n, 2);
    while (n < motion.n && latest(motion, 0).time_s - latest(motion, n).time_s <= kFitted_s) ++n;
    return n;
}

}  // namespace

void remember(const MotionSample& sample, Motion& motion) noexcept {
    if (motion.n > 0) {
        const double elapsed_s = sample.time_s - latest(motion, 0).time_s;
        if (elapsed_s > kForgotten_s) motion.n = 0;
        if (elapsed_s <= 0.0) {
            const double time_s = latest(motion, 0).time_s;
            motion.sample[(motion.next + Motion::kMost - 1) % Motion::kMost] = sample;
            motion.sample[(motion.next + Motion::kMost - 1) % Motion::kMost].time_s = time_s;
            return;
        }
    }
    motion.sample[motion.next] = sample;
    motion.next = (motion.next + 1) % Motion::kMost;
    motion.n = std::min(motion.n + 1, Motion::kMost);
}

MotionSample ahead(const Motion& motion, double lead_s) noexcept {
    if (motion.n == 0) return {};
    MotionSample out = latest(motion, 0);
    const double last_s = out.time_s;
    out.time_s += lead_s;
    const std::size_t n = fitted(motion);
    if (n < 2) return out;
    // times count from the last sample, so that a long run loses no digits
    double mean_s = 0.0, mean_x_m = 0.0, mean_y_m = 0.0, mean_value = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const MotionSample& s = latest(motion, i);
        mean_s += s.time_s - last_s;
        mean_x_m += s.x_m;
        mean_y_m += s.y_m;
        mean_value += s.value;
    }
    const double share = 1.0 / static_cast<double>(n);
    mean_s *= share, mean_x_m *= share, mean_y_m *= share, mean_value *= share;
    double tt = 0.0, tx = 0.0, ty = 0.0, tv = 0.0;
    for (std::size_t i = 0; i < n; ++i) {
        const MotionSample& s = latest(motion, i);
        const double t_s = s.time_s - last_s - mean_s;
        tt += t_s * t_s;
        tx += t_s * (s.x_m - mean_x_m);
        ty += t_s * (s.y_m - mean_y_m);
        tv += t_s * (s.value - mean_value);
    }
    if (!(tt > 0.0)) return out;
    const double from_mean_s = lead_s - mean_s;
    out.x_m = mean_x_m + tx / tt * from_mean_s;
    out.y_m = mean_y_m + ty / tt * from_mean_s;
    out.value = std::max(0.0, mean_value + tv / tt * from_mean_s);
    return out;
}

}  // namespace palpa::tactile
