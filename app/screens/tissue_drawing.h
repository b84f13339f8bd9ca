#pragma once
// Converts the state of a run into something to draw.

#include "render/tissue.h"
#include "scene/scene.h"
#include "scene/state.h"

namespace palpa::app {

// Returns the view of the tissue as the scene maps it, with the eye above the avatar. An indirect scene is drawn tilted,
// since no pen has to lie on it.
render::TissueView tissue_view(const scene::Scene& scene, const scene::State& state, const scene::Avatar& avatar,
                               const glm::vec2& window_px);

// Adds the surface to the picture, moved with the avatar. A surface of nodes is smoothed by 1-2-1 over the nodes, which
// removes the zig-zag that forces on single nodes leave.
void add_surface(const scene::SurfaceShape& shape, const scene::DrawnCues& cues, const scene::Avatar& avatar,
                 render::TissuePicture& picture);

// Adds the indenter at the avatar's position, and what it does to the look of the surface around it. Without a drawn
// depth, which no scene without a surface has, it lies on top. While nothing touches, it hovers and is translucent.
void add_indenter(const scene::Plan& plan, const scene::State& state, const scene::CueValues& cues,
                  const scene::Avatar& avatar, render::TissuePicture& picture);

}  // namespace palpa::app
