#pragma once
// What a study's trial is done with: which tools it takes, and whether one of them is connected.

#include <vector>

#include "platform/window.h"
#include "study/protocol.h"

namespace palpa::app {

bool tool_allowed(study::Modality modality, platform::Tool tool);

// Whether one of these devices is what such a trial is done with. A mouse is always there, and other modalities name no tool.
bool device_here(study::Modality modality, const std::vector<platform::PointerDevice>& devices);

}  // namespace palpa::app
