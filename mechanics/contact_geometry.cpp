#include "mechanics/contact_geometry.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

// Returns the radius of the circle, or half the width of the strip, in which the tool is below the surface plane.
double reach_radius_m(const Tool& tool) {
    const double R = tool.indenter.radius_m;
    const double d = std::min(tool.pose.depth_m, R);
    return d > 0.0 ? std::sqrt(d * (2.0 * R - d)) : 0.0;
}

}  // namespace

Reach reach(const Tool& tool, double x_m, double y_m) {
    const bool cylinder = tool.indenter.shape == IndenterShape::cylinder;
    const double R = tool.indenter.radius_m;
    const double dx = x_m - tool.pose.x_m;
    const double dy = y_m - tool.pose.y_m;
    if (cylinder && 2.0 * std::abs(dy) > tool.indenter.length_m) return {};
    const double height2 = R * R - dx * dx - (cylinder ? 0.0 : dy * dy);
    if (height2 <= 0.0) return {};
    const double height = std::sqrt(height2);
    return {tool.pose.depth_m - (R - height), dx / height, cylinder ? 0.0 : dy / height};
}

namespace {

using Footprint = std::array<double, 4>;  // x_min, x_max, y_min, y_max

// Returns a rectangle that holds every node whose delta can exceed -margin times its tool's depth. No node
// lies more than highest_m above the surface plane, so that only nodes under the lowest (1 + margin) depth + highest_m of
// a tool can.
Footprint box_of_reach(std::span<const Tool> tools, double margin, double highest_m) {
    constexpr double kRoundOff = 1.0 + 1e-9;  // widens the rectangle a little, since a node too many costs nothing
    constexpr double kFar_m = std::numeric_limits<double>::infinity();
    Footprint box_m{kFar_m, -kFar_m, kFar_m, -kFar_m};
    for (const Tool& tool : tools) {
        const Pose& pose = tool.pose;
        if (!(pose.depth_m > 0.0)) continue;
        const double R = tool.indenter.radius_m;
        const double below_axis_m = std::max(0.0, R - (1.0 + margin) * pose.depth_m - highest_m);
        const double rx = std::sqrt(kRoundOff * R * R - below_axis_m * below_axis_m);
        const bool cylinder = tool.indenter.shape == IndenterShape::cylinder;
        const double ry = cylinder ? 0.5 * kRoundOff * tool.indenter.length_m : rx;
        box_m = {std::min(box_m[0], pose.x_m - rx), std::max(box_m[1], pose.x_m + rx),
                 std::min(box_m[2], pose.y_m - ry), std::max(box_m[3], pose.y_m + ry)};
    }
    return box_m;
}

bool overlap(const Footprint& a, const Footprint& b) {
    return a[0] <= b[1] && a[1] >= b[0] && a[2] <= b[3] && a[3] >= b[2];
}

// Adds the node to the candidates if a tool is near it. If several are, the node belongs to the one that reaches
// deepest.
void add_if_near(const Compliance& compliance, std::span<const Tool> tools, double margin, int touch,
                 ContactWork& work) {
    const double x_m = compliance.position_m(0, touch);
    const double y_m = compliance.position_m(1, touch);
    const double below_m = compliance.surface_z_m - compliance.position_m(2, touch);
    Reach deepest;
    int which = -1;
    for (std::size_t t = 0; t < tools.size(); ++t) {
        const double depth = tools[t].pose.depth_m;
        if (!(depth > 0.0)) continue;
        Reach here = reach(tools[t], x_m, y_m);
        here.delta_m -= below_m;
        if (here.delta_m <= -margin * depth || here.delta_m <= deepest.delta_m) continue;
        deepest = here;
        which = static_cast<int>(t);
    }
    if (which < 0) return;
    work.candidate.push_back(touch);
    work.tool_of.push_back(which);
    work.delta_m.push_back(deepest.delta_m);
    work.slope_x.push_back(deepest.slope_x);
    work.slope_y.push_back(deepest.slope_y);
}

}  // namespace

void find_candidates(const Compliance& compliance, std::span<const Tool> tools, double margin, ContactWork& work) {
    for (auto* list : {&work.delta_m, &work.slope_x, &work.slope_y}) list->clear();
    work.candidate.clear();
    work.tool_of.clear();
    const Footprint within_m = box_of_reach(tools, margin, work.highest_m);
    for (std::size_t run = 0; run < work.run_box_m.size(); ++run) {
        if (!overlap(within_m, work.run_box_m[run])) continue;
        const int first = static_cast<int>(run) * kRunLength;
        const int end = std::min(first + kRunLength, compliance.n_touch);
        for (int touch = first; touch < end; ++touch) add_if_near(compliance, tools, margin, touch, work);
    }
    work.p_N.assign(work.candidate.size(), 0.0);
    work.gap_m.assign(work.candidate.size(), 0.0);
    work.in_contact.assign(work.candidate.size(), 0);
}

bool reaches_beyond(const Tool& tool, const std::array<double, 4>& box_m) {
    if (!(tool.pose.depth_m > 0.0)) return false;
    const double rx = reach_radius_m(tool);
    const double ry = tool.indenter.shape == IndenterShape::cylinder ? 0.5 * tool.indenter.length_m : rx;
    const Pose& p = tool.pose;
    return p.x_m - rx < box_m[0] || p.x_m + rx > box_m[1] || p.y_m - ry < box_m[2] || p.y_m + ry > box_m[3];
}

void check_tool(const Compliance& compliance, const Tool& tool) {
    const Pose& p = tool.pose;
    if (!(tool.indenter.radius_m > 0.0) || !std::isfinite(tool.indenter.radius_m) || !(tool.indenter.length_m > 0.0)) {
        throw LoadError(text("indenter: radius ", tool.indenter.radius_m, " m, length ", tool.indenter.length_m,
                             " m; wanted a finite radius > 0 and a length > 0"));
    }
    if (!std::isfinite(p.x_m) || !std::isfinite(p.y_m) || !std::isfinite(p.depth_m)) {
        throw LoadError(text("indenter: at ", p.x_m, ", ", p.y_m, " m, depth ", p.depth_m, " m: not finite"));
    }
    if (p.depth_m >= compliance.thickness_m) {
        throw LoadError(
            text("indenter: depth ", p.depth_m, " m, but the tissue is ", compliance.thickness_m, " m thick"));
    }
    const auto touched = compliance.position_m.leftCols(compliance.n_touch);
    const auto low = touched.rowwise().minCoeff();
    const auto high = touched.rowwise().maxCoeff();
    if (p.x_m < low(0) || p.x_m > high(0) || p.y_m < low(1) || p.y_m > high(1)) {
        throw LoadError(text("indenter: at ", p.x_m, ", ", p.y_m, " m, beside the touchable surface x ", low(0), "..",
                             high(0), ", y ", low(1), "..", high(1), " m"));
    }
}

}  // namespace palpa::mechanics
