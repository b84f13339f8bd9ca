#include "platform/pressure.h"

#include <algorithm>
#include <cmath>

namespace palpa::platform {
namespace {

constexpr double kLongEnough_s = 0.5;
constexpr std::int64_t kEnough = 30;
constexpr double kLongEnoughForSize_s = 5.0;
constexpr std::int64_t kEnoughForSize = 300;

void watch_size(const Sample& sample, ToolPressure& tool) {
    if (sample.phase == Phase::down || std::isnan(sample.width_px) || std::isnan(sample.height_px)) return;
    const double size_px[2] = {sample.width_px, sample.height_px};
    if (tool.with_size++ == 0) std::copy_n(size_px, 2, tool.first_size_px);
    tool.size_changed = tool.size_changed || !std::equal(size_px, size_px + 2, tool.first_size_px);
}

const ToolPressure& of(const PressureWatch& watch, Tool tool) { return watch.tools[static_cast<std::size_t>(tool)]; }

}  // namespace

void watch(const Sample& sample, PressureWatch& watch) {
    if (sample.phase == Phase::ui) return;
    ToolPressure& tool = watch.tools[static_cast<std::size_t>(sample.tool)];
    if (sample.phase != Phase::down && sample.phase != Phase::move) {
        tool.last_s = kMissing;
        return;
    }
    if (sample.t_host_s > tool.last_s) tool.touching_s += sample.t_host_s - tool.last_s;
    tool.last_s = sample.t_host_s;
    watch_size(sample, tool);
    if (std::isnan(sample.pressure)) {
        ++tool.without;
        return;
    }
    if (sample.phase == Phase::down) return;
    if (tool.with == 0) tool.first = sample.pressure;
    ++tool.with;
    tool.changed = tool.changed || sample.pressure != tool.first;
}

PressureKind pressure_kind(const PressureWatch& watch, Tool tool) {
    const ToolPressure& seen = of(watch, tool);
    if (seen.changed) return PressureKind::varies;
    if (seen.with == 0) return seen.without > 0 ? PressureKind::missing : PressureKind::unknown;
    const bool enough = seen.with >= kEnough && seen.touching_s >= kLongEnough_s;
    return enough ? PressureKind::constant : PressureKind::unknown;
}

bool has_constant_size(const PressureWatch& watch, Tool tool) {
    const ToolPressure& seen = of(watch, tool);
    return !seen.size_changed && seen.with_size >= kEnoughForSize && seen.touching_s >= kLongEnoughForSize_s;
}

double constant_pressure(const PressureWatch& watch, Tool tool) {
    return pressure_kind(watch, tool) == PressureKind::constant ? of(watch, tool).first : kMissing;
}

}  // namespace palpa::platform
