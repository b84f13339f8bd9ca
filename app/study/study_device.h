#pragma once
// The devices of a study's trial: which tools the trial accepts, and whether such a device is connected.

#include <vector>

#include "platform/window.h"
#include "study/protocol.h"

namespace palpa::app {

bool tool_allowed(study::Modality modality, platform::Tool tool);

// True if one of these devices serves a trial of this modality. Also true for a mouse, which is always there, and for
// modalities that name no tool.
bool device_here(study::Modality modality, const std::vector<platform::PointerDevice>& devices);

}  // namespace palpa::app
