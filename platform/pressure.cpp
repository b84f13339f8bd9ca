#include "platform/pressure.h"

#include <cmath>

namespace palpa::platform {
namespace {

constexpr double kLongEnough_s = 0.5;
constexpr std::int64_t kEnough = 30;

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

double constant_pressure(const PressureWatch& watch, Tool tool) {
    return pressure_kind(watch, tool) == PressureKind::constant ? of(watch, tool).first : kMissing;
}

}  // namespace palpa::platform
