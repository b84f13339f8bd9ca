#pragma once
// The devices of a study's trial: which tools the trial accepts, and whether such a device is connected.

#include <vector>

#include "platform/pressure.h"
#include "platform/window.h"
#include "study/protocol.h"

namespace palpa::app {

bool tool_allowed(study::Modality modality, platform::Tool tool);

// What the device check says of the pressure of a trial's pen, or finger; or of a finger's contact area, if the profile reads
// that.
enum class PressureVerdict : std::uint8_t {
    not_needed,  // the trial is not done with a pen or a finger, or its profile reads an area that is not known to be constant
    untried,      // a pen or finger that may measure pressure has not pressed yet
    ready,        // its pressure varies
    no_pressure,  // none measures pressure; many screens send the same number for every touch
    same_area     // the contact area is read, and all touches have the same
};
inline bool refuses(PressureVerdict verdict) {
    return verdict == PressureVerdict::no_pressure || verdict == PressureVerdict::same_area;
}
// reads_area: the trial's profile reads the contact area, not the pressure.
PressureVerdict pressure_verdict(study::Modality modality, bool reads_area,
                                 const std::vector<platform::PointerDevice>& devices, bool devices_listed,
                                 const platform::PressureWatch& pressure);

// True if one of these devices serves a trial of this modality. Also true for a mouse, which is always there, and for
// modalities that name no tool.
bool device_here(study::Modality modality, const std::vector<platform::PointerDevice>& devices);

}  // namespace palpa::app
