#pragma once
// Converts the state of a run into something to draw.

#include "render/tissue.h"
#include "scene/scene.h"
#include "scene/state.h"

namespace palpa::app {

// Returns the view of the tissue as the scene maps it. An indirect scene is drawn tilted, since no pen has to lie on
// it.
render::TissueView tissue_view(const scene::Scene& scene, const scene::State& state, float window_width_px,
                               float window_height_px);

// Adds to the view by how much the texture is dragged along with a finger.
void drag_texture(const scene::Avatar& avatar, render::TissueView& view);

render::Dent dent_of(const avatar::SurfaceCurve& curve, const scene::Avatar& avatar);

// Returns a surface of nodes, moved with the avatar and smoothed by 1-2-1 over the nodes, which removes the zig-zag
// that forces on single nodes leave.
render::Relief relief_of(const scene::SurfaceShape& shape, const scene::Avatar& avatar);

// Returns the indenter at the avatar's position. While nothing touches, it hovers and is translucent.
render::Ball ball_of(const scene::Plan& plan, const scene::State& state, const scene::Avatar& avatar);

}  // namespace palpa::app
