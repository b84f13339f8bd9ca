#pragma once
// From a sample to the avatar: runs the stages of a plan. start() allocates the state; after that nothing here throws,
// and nothing allocates once `shape` has its size.

#include "scene/scene.h"
#include "scene/state.h"

namespace palpa::scene {

inline constexpr double kGrid_Hz = 240.0;

// Returns a state at rest. `screen`: where the tissue is drawn and pressed, until a sample of action `resize` changes
// it.
State start(const Scene& scene, const Plan& plan, const ScreenArea& screen);

// Puts the tissue on another part of the window, as a sample of action `resize` does. Ignores an area that is none.
void put_on_screen(const Scene& scene, const Plan& plan, const ScreenArea& screen, State& state);

// Takes one sample and moves the state to its time. Before that, the steps of the 240 Hz grid since the last sample are
// taken; the grid begins with the first sample and goes on whether or not something touches. Of a gap longer than a
// minute only the last minute is stepped through; the steps before it count as dropped if something touched meanwhile.
void advance(const Scene& scene, const Plan& plan, const platform::Sample& sample, State& state);

// Returns the avatar at a time after the last sample; it goes on moving while the pen rests.
Avatar avatar_at(const Scene& scene, const State& state, double t_s);

// Runs the stages that a frame needs: the surface under the last contact, and the cues that are drawn with it. The scene
// must have a surface (assert).
// `shape` may be used again for the next frame.
void surface_now(const Scene& scene, const Plan& plan, State& state, SurfaceShape& shape);

}  // namespace palpa::scene
