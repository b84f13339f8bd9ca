#pragma once
// A soft device as it is deformed now, seen from the front and a little from above and from the side.

#include "app/screens/gui.h"
#include "session/tangible_moment.h"

struct ImDrawList;  // imgui.h

namespace palpa::app {

// Draws the surface of the body with these nodes (as many as body.rest_m), its bearings, cables with their guides, and the
// two forces at the effector: the wanted one as an outline, the rendered one filled. Nothing if the body has no nodes.
void draw_soft_body(const PanelArea& area, const session::TangibleBody& body, const session::PointOfDevice* node_m,
                    const session::TangibleMoment& moment, float mm, ImDrawList& draw);

}  // namespace palpa::app
