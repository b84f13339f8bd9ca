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

// Weights of the fitted samples in the value of the fitted polynomial at a time: with orthogonal polynomials p_j over the
// samples' times, w_i = sum_j p_j(t) p_j(t_i) / sum_k p_j(t_k)^2.
struct Weights {
    std::array<double, Motion::kMost> of{};
    std::size_t n = 0;
};

Weights weights_at(const Motion& motion, double lead_s) {
    Weights out;
    out.n = fitted(motion);
    const double last_s = latest(motion, 0).time_s;  // times count from here, so that a long run loses no digits
    std::array<double, Motion::kMost> t_s{};
    double mean_s = 0.0;
    for (std::size_t i = 0; i < out.n; ++i) mean_s += t_s[i] = latest(motion, i).time_s - last_s;
    const auto count = static_cast<double>(out.n);
    mean_s /= count;
    double tt = 0.0, ttt = 0.0;
    for (std::size_t i = 0; i < out.n; ++i) {
        t_s[i] -= mean_s;
        tt += t_s[i] * t_s[i];
        ttt += t_s[i] * t_s[i] * t_s[i];
    }
    // p_0 = 1, p_1 = t, p_2 = t^2 - (ttt / tt) t - tt / n
    const auto bend = [&](double at_s) { return at_s * at_s - ttt / tt * at_s - tt / count; };
    double bends = 0.0;
    for (std::size_t i = 0; i < out.n; ++i) bends += bend(t_s[i]) * bend(t_s[i]);
    const double at_s = lead_s - mean_s;
    const bool bent = out.n >= kFewestBent && bends > 0.0;
    for (std::size_t i = 0; i < out.n; ++i) {
        out.of[i] = 1.0 / count + at_s * t_s[i] / tt;
        if (bent) out.of[i] += bend(at_s) * bend(t_s[i]) / bends;
    }
    return out;
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
    out.time_s += lead_s;
    if (motion.n < 2) return out;
    const Weights weights = weights_at(motion, lead_s);
    out.x_m = out.y_m = out.value = 0.0;
    for (std::size_t i = 0; i < weights.n; ++i) {
        const MotionSample& sample = latest(motion, i);
        out.x_m += weights.of[i] * sample.x_m;
        out.y_m += weights.of[i] * sample.y_m;
        out.value += weights.of[i] * sample.value;
    }
    out.value = std::max(0.0, out.value);
    return out;
}

}  // namespace palpa::tactile
