#include "devices/shape_guard.h"

#include <algorithm>

#include "devices/device_json.h"
#include "devices/force_sensor.h"

namespace palpa::devices {

files::Json shape_rig_json(const ShapeRig& rig) {
    files::Json json{{"force_limit_N", rig.force_limit_N}};
    if (rig.arm) json["arm"] = arm_device_json(*rig.arm);
    if (rig.pins) json["pins"] = pin_device_json(*rig.pins);
    return json;
}

ShapeRig read_shape_rig(files::JsonReader reader) {
    ShapeRig rig;
    rig.force_limit_N = reader.number("force_limit_N", files::kNotNegative);
    if (reader.has("arm")) rig.arm = parse_arm_device(reader.any("arm"), reader.file());
    if (reader.has("pins")) rig.pins = parse_pin_device(reader.any("pins"), reader.file());
    reader.finish();
    return rig;
}

Limits limits_of(const ShapeRig& rig) {
    return limits_of(rig.arm ? &*rig.arm : nullptr, rig.pins ? &*rig.pins : nullptr, rig.force_limit_N);
}

ShapeGuard::ShapeGuard(const ShapeRig& rig, const std::string& program)
    : link_(program, files::Json{{"kind", "shape"}, {"shape", shape_rig_json(rig)}}.dump()) {}

void ShapeGuard::send(const ArmCommand& arm, std::span<const double> pins_m) noexcept {
    std::array<double, kArmValues + kMostPins> values{arm.force_N, arm.feedforward_N, arm.depth_m, arm.mode};
    const std::size_t pins = std::min(pins_m.size(), kMostPins);
    std::copy_n(pins_m.begin(), pins, values.begin() + kArmValues);
    link_.send(GuardWord::command, std::span(values).first(kArmValues + pins));
}

bool ShapeGuard::poll() noexcept {
    ShapeReport report;
    bool fresh = false;
    int n = link_.receive(&report, sizeof report);
    for (; n > 0; n = link_.receive(&report, sizeof report)) {
        if (n != static_cast<int>(sizeof report)) continue;
        if (report.arm_readings > newest_.arm_readings) link_health_.round_trip.add(report.arm.round_trip_s);
        newest_ = report;
        fresh = true;
    }
    const double now_s = steady_s();
    if (fresh) reported_s_ = now_s;
    if (reported_s_ > 0.0 && now_s - reported_s_ > kGuardSilence_s && newest_.fault == Fault::none) {
        ++newest_.count[static_cast<std::size_t>(Fault::guard_silent)];
        newest_.fault = Fault::guard_silent;
    }
    if (n < 0) {
        if (newest_.fault != Fault::guard_gone) ++newest_.count[static_cast<std::size_t>(Fault::guard_gone)];
        newest_.fault = Fault::guard_gone;
        newest_.ready = false;
    }
    link_health_.sent = newest_.sent;
    link_health_.unsent = newest_.unsent;
    link_health_.arm_rested = newest_.arm_rested;
    link_health_.feedback = newest_.arm_feedback;
    return fresh;
}

}  // namespace palpa::devices
