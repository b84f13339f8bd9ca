#pragma once
// The devices of a study's trial: which tools the trial takes, and whether one of them is connected.

#include <vector>

#include "platform/window.h"
#include "study/protocol.h"

namespace palpa::app {

bool tool_allowed(study::Modality modality, platform::Tool tool);

// True if one of these devices is one that a trial of this modality is done with. It is also true for a mouse, which is
// always there, and for modalities that name no tool.
bool device_here(study::Modality modality, const std::vector<platform::PointerDevice>& devices);

}  // namespace palpa::app
