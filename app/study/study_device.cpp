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

bool device_here(study::Modality modality, const std::vector<platform::PointerDevice>& devices) {
    const auto any = [&](platform::Tool tool) {
        return std::any_of(devices.begin(), devices.end(),
                           [&](const platform::PointerDevice& d) { return d.tool == tool; });
    };
    if (modality == study::Modality::pen) return any(platform::Tool::pen);
    return modality != study::Modality::finger || any(platform::Tool::finger);
}

}  // namespace palpa::app
