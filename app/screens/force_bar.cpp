// A bullet graph of the force: one bar before three tints of one hue, light, medium and deep, named beside it.

#include "app/screens/force_bar.h"

#include <algorithm>
#include <cmath>

#include "app/screens/tactile_screen.h"
#include "app/screens/tangible_screen.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

// How far the force bar reaches beyond the greatest force at the known depth.
constexpr double kBarOver = 1.25;

bool arm_leads(const Shown& shown) { return shown.tactile != nullptr && shown.tactile->arm_leads; }
bool soft_device_leads(const Shown& shown) { return shown.tangible != nullptr && shown.tangible->device_leads; }

double force_limit_N(const Shown& shown) {
    return shown.tactile != nullptr ? shown.tactile->force_limit_N : session::TactileMoment::kNone;
}

// Hatches the part of the bar beyond the known depth, where the tissue's answer is not known.
void draw_beyond(ImVec2 low, ImVec2 high, float mm, ImDrawList& draw) {
    draw.AddRectFilled(low, high, kDark);
    draw.PushClipRect(low, high, true);
    const float width_px = high.x - low.x;
    for (float y = low.y; y < high.y + width_px; y += 1.6f * mm)
        draw.AddLine(ImVec2(low.x, y), ImVec2(high.x, y - width_px), kPale, 0.25f * mm);
    draw.PopClipRect();
    draw.AddRect(low, high, kPale);
}

// The force above which force and shape hold.
void draw_limit(ImVec2 at, float width_px, double limit_N, float mm, ImDrawList& draw) {
    const ImVec2 left(at.x - mm, at.y);
    const ImVec2 right(at.x + width_px + mm, at.y);
    draw.AddLine(left, right, kDark, 1.2f * mm);
    draw.AddLine(left, right, kLag, 0.6f * mm);
    const float text_px = ImGui::GetFontSize();
    const std::string text = fixed(limit_N, 1) + " N " + words::kForceLimit;
    draw.AddText(ImGui::GetFont(), 0.75f * text_px, ImVec2(right.x + 0.5f * mm, at.y - 0.9f * text_px), kLag,
                 text.c_str());
}

}  // namespace

bool device_leads(const Shown& shown) { return arm_leads(shown) || soft_device_leads(shown); }

bool device_runs(const Shown& shown) {
    return (arm_leads(shown) && shown.tactile->runs) || (soft_device_leads(shown) && shown.tangible->runs);
}

double felt_force_N(const Shown& shown) {
    if (arm_leads(shown)) return session::force_now_N(shown.tactile->moment);
    if (soft_device_leads(shown)) return shown.tangible->moment.wanted_N;
    return shown.state.contact.normal_N;
}

double felt_depth_m(const Shown& shown) {
    if (arm_leads(shown)) return shown.tactile->moment.depth_m;
    if (soft_device_leads(shown)) return shown.tangible->moment.world_depth_m;
    return shown.state.contact.depth_m;
}

void draw_force_bar(const Shown& shown, float height_px, const Gui& gui) {
    const double greatest_N = std::max(0.1, shown.plan.greatest_force_N);
    const double known_N = std::clamp(shown.plan.known_N, 0.1, greatest_N);
    const double limit_N = force_limit_N(shown);
    const double full_N = std::max(kBarOver * greatest_N, std::isfinite(limit_N) ? kBarOver * limit_N : 0.0);
    const float mm = gui.mm();
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const float width_px = 8.0f * mm;
    const auto y_of = [&](double force_N) {
        return at.y + height_px * (1.0f - static_cast<float>(std::clamp(force_N / full_N, 0.0, 1.0)));
    };
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const double bounds_N[4] = {0.0, shown.plan.zone_N[0], shown.plan.zone_N[1], known_N};
    constexpr const char* kZones[3] = {words::kLight, words::kMedium, words::kDeep};
    const float text_px = ImGui::GetFontSize();
    for (std::size_t zone = 0; zone < 3; ++zone) {
        const float top = y_of(bounds_N[zone + 1]);
        const float bottom = y_of(bounds_N[zone]);
        draw.AddRectFilled(ImVec2(at.x, top), ImVec2(at.x + width_px, bottom), kForceTints[zone]);
        if (bottom - top < 0.75f * text_px) continue;
        const bool room =
            bottom - top >= 1.1f * text_px &&
            width_px + 1.5f * mm + ImGui::CalcTextSize(kZones[zone]).x <= ImGui::GetContentRegionAvail().x;
        const float name_px = room ? text_px : 0.75f * text_px;
        // below the limit's own text, where both would stand at one height
        const float middle = 0.5f * (top + bottom - name_px);
        const float limit = std::isfinite(limit_N) ? y_of(limit_N) : -1e6f;
        const bool meets = middle + name_px > limit - text_px && middle < limit;
        draw.AddText(ImGui::GetFont(), name_px, ImVec2(at.x + width_px + 1.5f * mm, meets ? limit : middle), kPale,
                     kZones[zone]);
        if (bottom - top < 2.0f * text_px) continue;
        const std::string bound = fixed(bounds_N[zone + 1], 1) + (zone == 2 ? " N" : "");
        const bool covered = top + 0.7f * text_px > limit - text_px && top < limit;  // by the limit's text
        draw.AddText(ImGui::GetFont(), 0.7f * text_px,
                     ImVec2(at.x + width_px + 1.5f * mm, covered ? top - 0.75f * text_px : top), kPale, bound.c_str());
        draw.AddLine(ImVec2(at.x + width_px, top), ImVec2(at.x + width_px + mm, top), kPale);
    }
    draw_beyond(ImVec2(at.x, at.y), ImVec2(at.x + width_px, y_of(known_N)), mm, draw);
    if (y_of(known_N) - at.y >= 1.1f * text_px) {
        draw.AddText(ImGui::GetFont(), 0.75f * text_px,
                     ImVec2(at.x + width_px + 1.5f * mm, 0.5f * (at.y + y_of(known_N) - 0.75f * text_px)), kPale,
                     words::kBeyond);
    }
    if (std::isfinite(limit_N)) draw_limit(ImVec2(at.x, y_of(limit_N)), width_px, limit_N, mm, draw);
    const float top = y_of(felt_force_N(shown));
    draw.AddRectFilled(ImVec2(at.x + 0.3f * width_px, top), ImVec2(at.x + 0.7f * width_px, at.y + height_px), kInk);
    if (shown.state.contact.saturated) {  // a cap on top, not only a colour
        draw.AddRectFilled(ImVec2(at.x - 0.5f * mm, top - 0.8f * mm), ImVec2(at.x + width_px + 0.5f * mm, top), kLag);
    }
    ImGui::Dummy(ImVec2(width_px, height_px));
}

}  // namespace palpa::app
