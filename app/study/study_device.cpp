#include "app/study/study_device.h"

#include <algorithm>

namespace palpa {

bool tool_allowed(Modality modality, Tool tool) {
    switch (modality) {
        case Modality::pen: return tool == Tool::pen;
        case Modality::finger: return tool == Tool::finger;
        case Modality::mouse: return tool == Tool::mouse || tool == Tool::keyboard;
        default: return true;  // a touchpad may speak as any of them
    }
}

bool device_here(Modality modality, const std::vector<PointerDevice>& devices) {
    const auto any = [&](Tool tool) {
        return std::any_of(devices.begin(), devices.end(), [&](const PointerDevice& d) { return d.tool == tool; });
    };
    if (modality == Modality::pen) return any(Tool::pen);
    return modality != Modality::finger || any(Tool::finger);
}

}  // namespace palpa
