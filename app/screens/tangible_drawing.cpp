#include "app/screens/tangible_drawing.h"

#include <algorithm>
#include <cmath>
#include <glm/glm.hpp>
#include <utility>
#include <vector>

#include "app/screens/widgets.h"

namespace palpa::app {
namespace {

using session::PointOfDevice;
using session::TangibleBody;
using session::TangibleMoment;

constexpr ImU32 kSilicone = IM_COL32(214, 170, 140, 255);
constexpr ImU32 kMetal = IM_COL32(120, 130, 138, 255);
constexpr ImU32 kCable = IM_COL32(236, 239, 241, 255);

glm::vec3 vec(const PointOfDevice& p) { return {p[0], p[1], p[2]}; }

// Orthographic: right and up of the screen, and towards the eye, in the frame of the device.
struct DeviceView {
    glm::vec3 right{1.0f, 0.0f, 0.0f};
    glm::vec3 up{0.0f, 0.0f, 1.0f};
    glm::vec3 eye{0.0f, -1.0f, 0.0f};
    glm::vec2 middle_px{0.0f};
    glm::vec2 middle_m{0.0f};
    float px_per_m = 1.0f;

    glm::vec2 flat(const glm::vec3& p) const { return {glm::dot(p, right), glm::dot(p, up)}; }
    ImVec2 px(const glm::vec3& p) const {
        const glm::vec2 off = px_per_m * (flat(p) - middle_m);
        return {middle_px.x + off.x, middle_px.y - off.y};
    }
};

// All that must fit into the picture.
std::vector<glm::vec3> corners_of(const TangibleBody& body) {
    std::vector<glm::vec3> corners;
    for (const PointOfDevice& p : body.rest_m) corners.push_back(vec(p));
    for (const session::TangibleActuator& actuator : body.actuators) {
        for (const PointOfDevice& p : actuator.guides) corners.push_back(vec(p));
    }
    for (const session::TangibleBearing& bearing : body.bearings) {
        for (const PointOfDevice& p : {bearing.from_m, bearing.to_m})
            corners.push_back(vec(p) + static_cast<float>(bearing.radius_m) * vec(body.direction));
    }
    return corners;
}

// Looks across the longer side of the body, 20 degrees from above and 25 from the side; what lies against the finger's
// direction is up.
void turn_view(const TangibleBody& body, DeviceView& view) {
    const glm::vec3 up = -glm::normalize(vec(body.direction));
    const glm::vec3 any = std::abs(up.x) < 0.9f ? glm::vec3(1.0f, 0.0f, 0.0f) : glm::vec3(0.0f, 1.0f, 0.0f);
    glm::vec3 along = glm::normalize(any - glm::dot(any, up) * up);
    glm::vec3 across = glm::cross(up, along);
    const auto extent = [&](const glm::vec3& axis) {
        float low = 1e9f, high = -1e9f;
        for (const PointOfDevice& p : body.rest_m) {
            low = std::min(low, glm::dot(vec(p), axis));
            high = std::max(high, glm::dot(vec(p), axis));
        }
        return high - low;
    };
    if (extent(across) > 1.01f * extent(along)) along = std::exchange(across, -along);
    constexpr float kAside = 0.4363f, kAbove = 0.3491f;
    const glm::vec3 level = -std::cos(kAside) * across + std::sin(kAside) * along;
    view.right = std::cos(kAside) * along + std::sin(kAside) * across;
    view.eye = std::cos(kAbove) * level + std::sin(kAbove) * up;
    view.up = std::cos(kAbove) * up - std::sin(kAbove) * level;
}

void fit_view(const PanelArea& area, const TangibleBody& body, float margin_px, DeviceView& view) {
    glm::vec2 low(1e9f), high(-1e9f);
    for (const glm::vec3& corner : corners_of(body)) {
        low = glm::min(low, view.flat(corner));
        high = glm::max(high, view.flat(corner));
    }
    const glm::vec2 size = glm::max(high - low, glm::vec2(1e-3f));
    view.middle_m = 0.5f * (low + high);
    view.middle_px = {0.5f * (area.x0 + area.x1), 0.5f * (area.y0 + area.y1)};
    view.px_per_m = std::max(
        1.0f, std::min((area.width() - 2.0f * margin_px) / size.x, (area.height() - 2.0f * margin_px) / size.y));
}

ImU32 shaded(ImU32 colour, float light) {
    const auto part = [&](int shift) {
        return static_cast<int>(std::lround(light * static_cast<float>((colour >> shift) & 0xFF)));
    };
    return IM_COL32(part(IM_COL32_R_SHIFT), part(IM_COL32_G_SHIFT), part(IM_COL32_B_SHIFT), 255);
}

// The faces from the farthest to the nearest, shaded by how they stand.
void draw_faces(const TangibleBody& body, const PointOfDevice* node_m, const DeviceView& view, ImDrawList& draw) {
    struct Face {
        float near;
        const std::array<std::int32_t, 4>* corner;
    };
    const auto node = [&](std::int32_t i) { return vec(node_m[i]); };
    std::vector<Face> faces;
    faces.reserve(body.faces.size());
    for (const auto& corner : body.faces) {
        const glm::vec3 middle = 0.25f * (node(corner[0]) + node(corner[1]) + node(corner[2]) + node(corner[3]));
        faces.push_back({glm::dot(middle, view.eye), &corner});
    }
    std::sort(faces.begin(), faces.end(), [](const Face& a, const Face& b) { return a.near < b.near; });
    const glm::vec3 lamp = glm::normalize(view.eye + view.up + 0.4f * view.right);
    const ImDrawListFlags before = draw.Flags;
    draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // or gaps between neighbours would shine through
    for (const Face& face : faces) {
        const auto& c = *face.corner;
        const glm::vec3 a = node(c[0]), b = node(c[1]), d = node(c[2]), e = node(c[3]);
        const glm::vec3 normal = glm::cross(d - a, e == d ? b - a : e - b);
        const float length = glm::length(normal);
        if (!(length > 0.0f)) continue;  // a NaN is drawn nowhere
        const float light = 0.45f + 0.55f * std::abs(glm::dot(normal, lamp)) / length;
        draw.AddQuadFilled(view.px(a), view.px(b), view.px(d), view.px(e), shaded(kSilicone, light));
    }
    draw.Flags = before;
}

void draw_bearings(const TangibleBody& body, const DeviceView& view, ImDrawList& draw) {
    for (const session::TangibleBearing& bearing : body.bearings) {
        const bool near_first = glm::dot(vec(bearing.from_m) - vec(bearing.to_m), view.eye) > 0.0f;
        const ImVec2 near = view.px(vec(near_first ? bearing.from_m : bearing.to_m));
        const ImVec2 far = view.px(vec(near_first ? bearing.to_m : bearing.from_m));
        const float radius_px = view.px_per_m * static_cast<float>(bearing.radius_m);
        draw.AddLine(far, near, kMetal, 2.0f * radius_px);
        draw.AddCircleFilled(far, radius_px, kMetal);
        draw.AddCircleFilled(near, radius_px, shaded(kMetal, 0.8f));
    }
}

// A cable from its anchor through its guides; dashed while it is slack at its lower limit.
void draw_cables(const TangibleBody& body, const PointOfDevice* node_m, const DeviceView& view, float mm,
                 ImDrawList& draw) {
    for (const session::TangibleActuator& actuator : body.actuators) {
        if (actuator.cavity || actuator.guides.empty()) continue;
        ImVec2 last = view.px(vec(actuator.guides.front()));
        if (actuator.anchor >= 0) {
            const ImVec2 anchor = view.px(vec(node_m[actuator.anchor]));
            draw.AddLine(anchor, last, kCable, 0.4f * mm);
            draw.AddCircleFilled(anchor, 0.6f * mm, kCable);
        }
        for (const PointOfDevice& guide : actuator.guides) {
            const ImVec2 at = view.px(vec(guide));
            draw.AddLine(last, at, kCable, 0.4f * mm);
            draw.AddCircle(at, mm, kCable, 0, 0.4f * mm);
            last = at;
        }
    }
}

// An arrow against the finger: as long as a fifth of the picture at the greatest force of these two.
void draw_force(ImVec2 at, float length_px, bool filled, float mm, ImDrawList& draw) {
    if (!(length_px > 0.0f)) return;
    const float half_px = 1.2f * mm;
    const ImVec2 low(at.x - half_px, at.y - length_px), high(at.x + half_px, at.y);
    if (filled)
        draw.AddRectFilled(low, high, kLag);
    else
        draw.AddRect(low, high, kInk, 0.0f, 0, 0.4f * mm);
}

}  // namespace

void draw_soft_body(const PanelArea& area, const TangibleBody& body, const PointOfDevice* node_m,
                    const TangibleMoment& moment, float mm, ImDrawList& draw) {
    if (body.rest_m.empty() || area.width() < 10.0f * mm || area.height() < 10.0f * mm) return;
    DeviceView view;
    turn_view(body, view);
    const float arrow_px = 0.2f * area.height();
    fit_view({area.x0, area.y0 + arrow_px, area.x1, area.y1}, body, 2.0f * mm, view);
    draw.PushClipRect(ImVec2(area.x0, area.y0), ImVec2(area.x1, area.y1), true);
    draw_bearings(body, view, draw);
    draw_faces(body, node_m, view, draw);
    draw_cables(body, node_m, view, mm, draw);
    const glm::vec3 effector = vec(body.effector_m) + static_cast<float>(moment.depth_m) * vec(body.direction);
    const ImVec2 at = view.px(effector);
    const double most_N = std::max({0.5, moment.wanted_N, std::isfinite(moment.rendered_N) ? moment.rendered_N : 0.0});
    const auto length = [&](double force_N) {
        return std::isfinite(force_N) ? arrow_px * static_cast<float>(std::max(0.0, force_N) / most_N) : 0.0f;
    };
    draw_force(ImVec2(at.x - 1.4f * mm, at.y), length(moment.wanted_N), false, mm, draw);
    draw_force(ImVec2(at.x + 1.4f * mm, at.y), length(moment.rendered_N), true, mm, draw);
    draw.AddCircleFilled(at, 0.8f * mm, kDark);
    draw.PopClipRect();
}

}  // namespace palpa::app
