#pragma once
// The road from a sample to the avatar. None of these allocates or throws.

#include "scene/scene.h"
#include "scene/state.h"

namespace palpa::scene {

inline constexpr double kGrid_Hz = 240.0;

// `screen`: where the tissue is drawn and pressed. A sample of action `resize` changes it.
State start(const Scene& scene, const Plan& plan, const ScreenArea& screen);

// Goes exactly to the sample's time. The gap since the last sample is walked on the 240 Hz grid, which begins with the
// first sample and goes on whether or not something touches; gaps of more than a minute are cut and the steps counted
// as dropped.
void advance(const Scene& scene, const Plan& plan, const platform::Sample& sample, State& state);

// What to draw at a time after the last sample (the avatar goes on moving while the pen rests).
Avatar avatar_at(const Scene& scene, const State& state, double t_s);

// The frame stage of the scene's surface, which must be there. `shape` may be used again for the next frame.
void surface_now(const Scene& scene, const Plan& plan, State& state, SurfaceShape& shape);

}  // namespace palpa::scene
