#include "platform/timeline.h"

#include <algorithm>
#include <cmath>

namespace palpa::platform {
namespace {

constexpr double kClockJump_s = 1.0;
constexpr double kLate_s = 0.1;
constexpr double kFall = 0.1;
constexpr double kDrift = 2e-4;

double time_of(const Sample& sample, Timeline& timeline) {
    if (std::isnan(sample.t_device_s)) return sample.t_host_s;
    const double difference_s = sample.t_host_s - sample.t_device_s;
    const double off_s = difference_s - timeline.offset_s;
    if (!timeline.has_offset || std::abs(off_s) > kClockJump_s) {
        timeline.clock_jumps += timeline.has_offset;
        timeline.has_offset = true;
        timeline.offset_s = difference_s;
    } else {
        const double passed_s = std::max(0.0, sample.t_device_s - timeline.device_s);
        timeline.offset_s += std::clamp(off_s, -kFall * passed_s, kDrift * passed_s);
    }
    timeline.device_s = sample.t_device_s;
    // events that queued up behind a stall arrive at one moment, and none of them is from after it
    return std::min(sample.t_device_s + timeline.offset_s, sample.t_host_s + kLate_s);
}

}  // namespace

bool move_to(const Sample& sample, Timeline& timeline) {
    // samples of a held button are stamped by the host, so that after a slow frame those of the device itself are behind them
    const bool goes_on = timeline.has_offset && sample.t_device_s >= timeline.device_s;
    const double t_s = time_of(sample, timeline);
    const bool behind = timeline.started && t_s < timeline.now_s - kLate_s;
    if (!std::isfinite(t_s) || (behind && !goes_on)) {
        ++timeline.backwards;
        return false;
    }
    if (timeline.started && t_s < timeline.now_s) {
        ++timeline.late;
        return true;
    }
    timeline.duplicates += timeline.started && t_s == timeline.now_s;
    timeline.now_s = t_s;
    timeline.started = true;
    return true;
}

}  // namespace palpa::platform
