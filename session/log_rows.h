#pragma once
// A run's state as a row of the log, and the files that stand beside it.

#include <filesystem>
#include <string>

#include "files/json.h"
#include "platform/sample.h"
#include "scene/scene.h"
#include "scene/state.h"
#include "study/sample_log.h"

namespace palpa::session {

study::SampleRow row_of(const platform::Sample& sample, const scene::Plan& plan, const scene::State& state);

// What a replay needs to know and a reader wants to: scene, map, profile, screen. The same for every replay.
files::Json settings_json(const scene::Scene& scene, const scene::Plan& plan, const scene::State& state);

}  // namespace palpa::session
