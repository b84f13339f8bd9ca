#include "app/study/study_device.h"

#include <algorithm>

namespace palpa::app {

bool tool_allowed(study::Modality modality, platform::Tool tool) {
    switch (modality) {
        case study::Modality::pen:
            return tool == platform::Tool::pen;
        case study::Modality::finger:
            return tool == platform::Tool::finger;
        case study::Modality::mouse:
            return tool == platform::Tool::mouse || tool == platform::Tool::keyboard;
        default:
            return true;  // a touchpad may report any of them
    }
}

PressureVerdict pressure_verdict(study::Modality modality, bool reads_area,
                                 const std::vector<platform::PointerDevice>& devices, bool devices_listed,
                                 const platform::PressureWatch& pressure) {
    const bool finger = modality == study::Modality::finger;
    if (modality != study::Modality::pen && !finger) return PressureVerdict::not_needed;
    const platform::Tool tool = finger ? platform::Tool::finger : platform::Tool::pen;
    if (reads_area) return has_constant_size(pressure, tool) ? PressureVerdict::same_area : PressureVerdict::not_needed;
    switch (platform::pressure_kind(pressure, tool)) {
        case platform::PressureKind::varies:
            return PressureVerdict::ready;
        case platform::PressureKind::constant:
        case platform::PressureKind::missing:
            return PressureVerdict::no_pressure;
        case platform::PressureKind::unknown:
            break;
    }
    const auto measures = [&](const platform::PointerDevice& d) { return d.tool == tool && d.has_pressure; };
    const bool none =
        devices_listed && device_here(modality, devices) && std::none_of(devices.begin(), devices.end(), measures);
    return none ? PressureVerdict::no_pressure : PressureVerdict::untried;
}

bool device_here(study::Modality modality, const std::vector<platform::PointerDevice>& devices) {
    const auto any = [&](platform::Tool tool) {
        return std::any_of(devices.begin(), devices.end(),
                           [&](const platform::PointerDevice& d) { return d.tool == tool; });
    };
    if (modality == study::Modality::pen) return any(platform::Tool::pen);
    return modality != study::Modality::finger || any(platform::Tool::finger);
}

}  // namespace palpa::app
