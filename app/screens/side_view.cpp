// The section through the contact, in a corner of the tissue's part of the window: tip, surface and depth as seen from the
// side, in the same scale along both axes.

#include <algorithm>
#include <array>
#include <cmath>
#include <glm/common.hpp>

#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "scene/surface.h"

namespace palpa::app {
namespace {

constexpr float kWide_mm = 52.0f;  // on the screen
constexpr float kHigh_mm = 29.0f;
constexpr float kLeastWide_mm = 36.0f;
constexpr double kSection_m = 44e-3;   // of the tissue, along the screen's x; more where the contact is deep
constexpr double kBelow_m = 3e-3;      // of the tissue under the deepest point
constexpr double kAbove_m = 10e-3;     // the undisturbed surface is this far below the upper edge
constexpr double kDimension_m = 8e-3;  // the line that measures the depth is this far from the contact

struct Section {
    ImVec2 corner;  // upper left
    ImVec2 size_px;
    double span_m = kSection_m;
    float px_per_m = 1.0f;
    ImVec2 at(double along_m, double up_m) const {
        return {corner.x + 0.5f * size_px.x + px_per_m * static_cast<float>(along_m),
                corner.y + px_per_m * static_cast<float>(kAbove_m - up_m)};
    }
};

// The lower right corner, as large as fits beside or below the tissue. Where little room is left there, it covers the
// tissue's lower right corner, or the lower left one while the contact is near that.
Section place_section(const Shown& shown, double depth_m, float mm) {
    const scene::ScreenArea& area = shown.state.screen;
    const float gap_px = 2.0f * mm;
    const auto right = static_cast<float>(area.x_px + area.width_px);
    const auto bottom = static_cast<float>(area.y_px + area.height_px);
    const auto half_px = 0.5f * shown.view.px_per_m * glm::abs(shown.view.axes * shown.view.size_m);
    const float beside_px = right - shown.view.centre_px.x - half_px.x - 2.0f * gap_px;
    const float below_px = bottom - shown.view.centre_px.y - half_px.y - 2.0f * gap_px;
    const float room_px = std::max(beside_px, below_px * kWide_mm / kHigh_mm);
    const float wide_px = std::clamp(room_px, kLeastWide_mm * mm, kWide_mm * mm);
    Section section;
    section.size_px = ImVec2(wide_px, wide_px * kHigh_mm / kWide_mm);
    section.span_m = std::max(kSection_m, (kAbove_m + depth_m + kBelow_m) * static_cast<double>(kWide_mm / kHigh_mm));
    section.px_per_m = wide_px / static_cast<float>(section.span_m);
    section.corner = ImVec2(right - wide_px - gap_px, bottom - section.size_px.y - gap_px);
    if (room_px >= wide_px) return section;
    const ImVec2 contact = on_screen(shown.view, shown.avatar.p_m.x(), shown.avatar.p_m.y());
    const float near_px = 14.0f * mm;
    if (contact.x > section.corner.x - near_px && contact.y > section.corner.y - near_px)
        section.corner.x = static_cast<float>(area.x_px) + gap_px;
    return section;
}

constexpr int kSectionColumns = 72;
using Heights = std::array<double, kSectionColumns + 1>;  // of the surface, downwards

double along_of(const Section& section, int i) {
    return section.span_m * (static_cast<double>(i) / kSectionColumns - 0.5);
}

Heights sinks_of(const Shown& shown, const Section& section) {
    // the surface lies around the pen, and is drawn around the avatar
    const Eigen::Vector2d along = shown.state.view.axes.transpose() * Eigen::Vector2d(1.0, 0.0);
    Heights sink_m{};
    if (!shown.state.touch.down) return sink_m;
    for (int i = 0; i <= kSectionColumns; ++i)
        sink_m[static_cast<std::size_t>(i)] =
            scene::sink_at_m(shown.shape, shown.state.touch.p_m + along_of(section, i) * along);
    return sink_m;
}

void draw_tissue(const Section& section, const Heights& sink_m, scene::SurfaceMaterial material, float mm,
                 ImDrawList& draw) {
    const bool skin = material == scene::SurfaceMaterial::skin;
    const ImU32 flesh = skin ? IM_COL32(178, 112, 98, 255) : IM_COL32(196, 152, 134, 255);
    const ImU32 top = skin ? IM_COL32(236, 190, 172, 255) : IM_COL32(242, 216, 200, 255);
    const float floor = section.corner.y + section.size_px.y;
    const ImDrawListFlags flags = draw.Flags;
    draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // neighbours would show seams
    for (std::size_t i = 0; i < kSectionColumns; ++i) {
        const ImVec2 left = section.at(along_of(section, static_cast<int>(i)), -sink_m[i]);
        const ImVec2 right = section.at(along_of(section, static_cast<int>(i) + 1), -sink_m[i + 1]);
        draw.AddQuadFilled(left, right, ImVec2(right.x, floor), ImVec2(left.x, floor), flesh);
    }
    draw.Flags = flags;
    std::array<ImVec2, kSectionColumns + 1> line;
    for (std::size_t i = 0; i <= kSectionColumns; ++i)
        line[i] = section.at(along_of(section, static_cast<int>(i)), -sink_m[i]);
    draw.AddPolyline(line.data(), kSectionColumns + 1, top, 0, 0.7f * mm);
}

void draw_tip(const Shown& shown, const Section& section, double depth_m, ImDrawList& draw) {
    const double radius_m = shown.plan.indenter_radius_m;
    const double hover_m = shown.state.touch.down ? 0.0 : 2e-3;
    const ImVec2 at = section.at(0.0, radius_m - depth_m + hover_m);
    const float radius_px = section.px_per_m * static_cast<float>(radius_m);
    const bool finger = shown.plan.indenter == scene::DrawnIndenter::fingertip;
    const ImU32 body = finger ? IM_COL32(222, 170, 146, 255) : IM_COL32(150, 164, 180, 255);
    const float shaft_px = finger ? radius_px : 0.34f * radius_px;
    draw.PushClipRect(section.corner,
                      ImVec2(section.corner.x + section.size_px.x, section.corner.y + section.size_px.y), true);
    draw.AddRectFilled(ImVec2(at.x - shaft_px, section.corner.y), ImVec2(at.x + shaft_px, at.y), body);
    draw.AddCircleFilled(at, radius_px, body, 32);
    draw.AddCircle(at, radius_px, kDark, 32, 1.0f);
    draw.PopClipRect();
}

// A line at the height of the undisturbed surface, and the depth below it.
void draw_depth(const Shown& shown, const Section& section, double depth_m, float mm, ImDrawList& draw) {
    const ImVec2 rest = section.at(-0.5 * section.span_m, 0.0);
    const ImVec2 end = section.at(0.5 * section.span_m, 0.0);
    for (float x = rest.x; x < end.x; x += 2.0f * mm)
        draw.AddLine(ImVec2(x, rest.y), ImVec2(std::min(x + mm, end.x), rest.y), kInk, 0.2f * mm);
    const StudyRun* study = study_of(shown.doing);
    if (!(depth_m > 0.0) || (study != nullptr && due_compares(*study))) return;
    const ImVec2 top = section.at(kDimension_m, 0.0);
    const ImVec2 low = section.at(kDimension_m, -depth_m);
    draw.AddLine(top, low, kInk, 0.4f * mm);
    draw.AddLine(ImVec2(section.at(0.0, 0.0).x, low.y), ImVec2(low.x + mm, low.y), kInk, 0.2f * mm);
    const std::string beyond = shown.state.contact.saturated ? "> " : "";
    const std::string text = beyond + fixed(1e3 * depth_m, 1) + " mm";
    const float last_px = section.corner.x + section.size_px.x - ImGui::CalcTextSize(text.c_str()).x - mm;
    plated_text(draw, ImVec2(std::min(low.x + mm, last_px), 0.5f * (top.y + low.y - ImGui::GetFontSize())), kInk, text);
}

}  // namespace

void draw_side_view(const Shown& shown, const Gui& gui) {
    // in a study the protocol's scene decides, not what somebody switched off before
    const bool wanted = shown.settings.side_view || study_of(shown.doing) != nullptr;
    if (!shown.scene.surface || !shown.scene.cues.side_view || !wanted) return;
    const float mm = gui.mm();
    const double depth_m = shown.state.touch.down ? shown.state.contact.depth_m : 0.0;
    const Section section = place_section(shown, depth_m, mm);
    if (section.size_px.x > 0.5f * static_cast<float>(shown.state.screen.width_px)) return;  // too small a window
    const ImVec2 end(section.corner.x + section.size_px.x, section.corner.y + section.size_px.y);
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddRectFilled(section.corner, end, IM_COL32(28, 31, 34, 255));
    draw_tissue(section, sinks_of(shown, section), shown.scene.surface->material, mm, draw);
    draw_tip(shown, section, depth_m, draw);
    draw_depth(shown, section, depth_m, mm, draw);
    plated_text(draw, ImVec2(section.corner.x + mm, end.y - ImGui::GetFontSize() - 0.6f * mm), kInk, words::kSideView);
    draw.AddRect(section.corner, end, kPale, 0.0f, 0, 0.3f * mm);
}

}  // namespace palpa::app
