#pragma once
// The outline of a nodule: a disc, or a rod with round ends that lies along its angle, as study::Target judges it.

#include <Eigen/Core>
#include <array>
#include <imgui.h>

#include "app/screens/widgets.h"
#include "stiffnessmaps/map.h"

namespace palpa::app {

inline constexpr std::size_t kOutlinePoints = 96;
using Outline = std::array<Eigen::Vector2d, kOutlinePoints>;  // closed, counter-clockwise, in even steps
using OutlinePx = std::array<ImVec2, kOutlinePoints>;

// All lengths in one unit, which is the result's; up to the diameter the length makes a disc.
Outline outline_of(const Eigen::Vector2d& centre, double diameter, double length, double angle_deg);

// In metres. A nodule without a diameter is drawn 4 mm across.
Outline outline_of(const stiffnessmaps::Nodule& nodule);

// Draws it where `px` puts each of its points, and returns the x of its right-most one.
template <typename ToPx>
float draw_outline(const Outline& outline, const ToPx& px, const RimmedLine& line, ImDrawList& draw);

float draw_outline(const OutlinePx& points, const RimmedLine& line, ImDrawList& draw);

template <typename ToPx>
float draw_outline(const Outline& outline, const ToPx& px, const RimmedLine& line, ImDrawList& draw) {
    OutlinePx points;
    for (std::size_t i = 0; i < kOutlinePoints; ++i) points[i] = px(outline[i].x(), outline[i].y());
    return draw_outline(points, line, draw);
}

}  // namespace palpa::app
