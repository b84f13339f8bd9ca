#pragma once
// A run's state as something to draw.

#include "render/tissue.h"
#include "scene/scene.h"
#include "scene/state.h"

namespace palpa::app {

// As the scene maps it; an indirect scene is drawn tilted, since no pen has to lie on it.
render::TissueView tissue_view(const scene::Scene& scene, const scene::State& state, float window_width_px,
                               float window_height_px);

render::Dent dent_of(const avatar::SurfaceCurve& curve, const scene::Avatar& avatar);

// A linear tissue's surface, moved with the avatar; smoothed by 1-2-1 over the nodes, which takes out the zig-zag that
// forces on single nodes leave in it.
render::Relief relief_of(const scene::LinearTissue& tissue, const Eigen::VectorXd& sink_m, const scene::Avatar& avatar);

// The indenter at the avatar's place; while nothing touches it hovers, half transparent.
render::Ball ball_of(const scene::Plan& plan, const scene::State& state, const scene::Avatar& avatar);

}  // namespace palpa::app
