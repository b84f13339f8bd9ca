#include "app/screens/nodule_outline.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa::app {

Outline outline_of(const Eigen::Vector2d& centre, double diameter, double length, double angle_deg) {
    const double radius = 0.5 * diameter;
    const double half = std::max(0.0, 0.5 * length - radius);
    const double turn = angle_deg * std::numbers::pi / 180.0;
    // even steps along the outline, so that dashes are alike on its ends and sides
    const double round = std::numbers::pi * radius;
    const double around = 2.0 * (round + 2.0 * half);
    Outline out;
    for (std::size_t k = 0; k < kOutlinePoints; ++k) {
        double s = around * static_cast<double>(k) / kOutlinePoints;
        const double side = s < 0.5 * around ? 1.0 : -1.0;
        if (side < 0.0) s -= 0.5 * around;
        // the end on that side comes first, then the long side
        const double a = s < round ? s / radius - 0.5 * std::numbers::pi : 0.0;
        const double along = side * (s < round ? half + radius * std::cos(a) : half - (s - round));
        const double across = side * (s < round ? radius * std::sin(a) : radius);
        out[k] = centre + Eigen::Vector2d(along * std::cos(turn) - across * std::sin(turn),
                                          along * std::sin(turn) + across * std::cos(turn));
    }
    return out;
}

Outline outline_of(const stiffnessmaps::Nodule& nodule) {
    return outline_of({nodule.x_m, nodule.y_m}, nodule.diameter_m.value_or(4e-3), nodule.length_m.value_or(0.0),
                      nodule.angle_deg.value_or(0.0));
}

float draw_outline(const OutlinePx& points, const RimmedLine& line, ImDrawList& draw) {
    constexpr std::size_t kDash = 3, kDashAndGap = 6;
    constexpr auto kPoints = static_cast<int>(kOutlinePoints);
    draw.AddPolyline(points.data(), kPoints, kDark, ImDrawFlags_Closed, line.core_px + 2.0f * line.rim_px);
    if (!line.dashed) draw.AddPolyline(points.data(), kPoints, kInk, ImDrawFlags_Closed, line.core_px);
    for (std::size_t i = 0; line.dashed && i < kOutlinePoints; i += kDashAndGap)
        draw.AddPolyline(&points[i], kDash + 1, kInk, 0, line.core_px);
    return std::max_element(points.begin(), points.end(), [](ImVec2 a, ImVec2 b) { return a.x < b.x; })->x;
}

}  // namespace palpa::app
