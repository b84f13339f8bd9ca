#pragma once
// The state of a run as a row of its log, and as the settings beside it.

#include <filesystem>
#include <string>

#include "files/json.h"
#include "platform/sample.h"
#include "scene/scene.h"
#include "scene/state.h"
#include "study/sample_log.h"

namespace palpa::session {

// Returns the row of a sample, after advance() with it. Where the stages did not run for the sample, only what the
// device reported is filled.
study::SampleRow row_of(const platform::Sample& sample, const scene::Scene& scene, const scene::Plan& plan,
                        const scene::State& state);

// Returns what readers of the log need to know of the run: scene, map, profile, screen. Every replay gives the same.
files::Json settings_json(const scene::Scene& scene, const scene::Plan& plan, const scene::State& state);

}  // namespace palpa::session
