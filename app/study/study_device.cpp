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

PenVerdict pen_verdict(study::Modality modality, bool reads_pressure,
                       const std::vector<platform::PointerDevice>& devices, bool devices_listed,
                       const platform::PressureWatch& pressure) {
    if (modality != study::Modality::pen || !reads_pressure) return PenVerdict::not_needed;
    switch (platform::pressure_kind(pressure, platform::Tool::pen)) {
        case platform::PressureKind::varies:
            return PenVerdict::ready;
        case platform::PressureKind::constant:
        case platform::PressureKind::missing:
            return PenVerdict::no_pressure;
        case platform::PressureKind::unknown:
            break;
    }
    const auto measures = [](const platform::PointerDevice& d) {
        return d.tool == platform::Tool::pen && d.has_pressure;
    };
    const bool none =
        devices_listed && device_here(modality, devices) && std::none_of(devices.begin(), devices.end(), measures);
    return none ? PenVerdict::no_pressure : PenVerdict::untried;
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
