#pragma once
// The road from a sample to the avatar. None of these allocates or throws.

#include "scene/scene.h"
#include "scene/state.h"

namespace palpa::scene {

inline constexpr double kGrid_Hz = 240.0;

// A station of the path costs five contact solves on a linear tissue, and 0.1 us on a map, which has room for a few
// thousand at most and needs no limit. 4,000 a second are a stroke of 200 mm/s.
inline constexpr avatar::StationLimit kStationsOnLinear{4000.0, 4, 64};

// `screen`: where the tissue is drawn and pressed. A sample of action `resize` changes it.
State start(const Scene& scene, const Plan& plan, const ScreenArea& screen);

// Goes exactly to the sample's time. The gap since the last sample is walked on the 240 Hz grid of the touch;
// gaps of more than a minute are cut and the steps counted as dropped.
void advance(const Scene& scene, const Plan& plan, const platform::Sample& sample, State& state);

// What to draw at a time after the last sample (the avatar goes on moving while the pen rests).
Avatar avatar_at(const Scene& scene, const State& state, double t_s);

// The frame stage of the scene's surface, on a map: scene.surface must be there.
avatar::SurfaceCurve surface_now(const Scene& scene, const Plan& plan, State& state);

// The same on a linear tissue: sink of its n_x * n_y surface nodes, metres.
void surface_now(const LinearTissue& tissue, State& state, Eigen::VectorXd& sink_m);

}  // namespace palpa::scene
