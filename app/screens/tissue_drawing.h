#pragma once
// A run's state as something to draw.

#include "render/tissue.h"
#include "scene/scene.h"
#include "scene/state.h"

namespace palpa {

// As the scene maps it; an indirect scene is drawn tilted, since no pen has to lie on it.
TissueView tissue_view(const Scene& scene, const State& state, float window_width_px, float window_height_px);

Dent dent_of(const SurfaceCurve& curve, const Avatar& avatar);

// A linear tissue's surface, moved with the avatar; smoothed by 1-2-1 over the nodes, which takes out the zig-zag that
// forces on single nodes leave in it.
Relief relief_of(const LinearTissue& tissue, const Eigen::VectorXd& sink_m, const Avatar& avatar);

// The indenter at the avatar's place; while nothing touches it hovers, half transparent.
Ball ball_of(const Plan& plan, const State& state, const Avatar& avatar);

}  // namespace palpa
