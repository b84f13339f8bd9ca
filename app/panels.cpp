#include "app/panels.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <limits>

#include "mechanics/linear_range.h"

namespace palpa {
namespace {

constexpr ImU32 kInk = IM_COL32(235, 238, 240, 255);
constexpr ImU32 kPale = IM_COL32(150, 158, 165, 255);
constexpr ImU32 kLag = IM_COL32(255, 214, 90, 255);
constexpr ImU32 kBarBack = IM_COL32(60, 64, 68, 255);
constexpr ImU32 kBar = IM_COL32(120, 190, 235, 255);
constexpr ImU32 kSaturated = IM_COL32(245, 170, 80, 255);

ImVec2 on_screen(const TissueView& view, const Eigen::Vector2d& p_m) {
    ImVec2 out;
    project_px(view, static_cast<float>(p_m.x()), static_cast<float>(p_m.y()), 0.0f, out.x, out.y);
    return out;
}

// A vertical bar from 0 to the map's greatest force, ticks every newton.
void draw_force_bar(const Plan& plan, const State& state, float scale) {
    const double full_N = std::max(1.0, force_range(plan.map).highest_N);
    const ImVec2 size(26.0f * scale, 200.0f * scale);
    const ImVec2 at = ImGui::GetCursorScreenPos();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 end(at.x + size.x, at.y + size.y);
    draw.AddRectFilled(at, end, kBarBack, 4.0f * scale);
    const double share = std::min(1.0, state.contact.normal_N / full_N);
    const float top = end.y - static_cast<float>(share) * size.y;
    draw.AddRectFilled(ImVec2(at.x, top), end, state.contact.saturated ? kSaturated : kBar, 4.0f * scale);
    const int step = full_N > 12.0 ? 5 : 1;
    for (int newton = 0; newton <= static_cast<int>(full_N); newton += step) {
        const float y = end.y - static_cast<float>(newton / full_N) * size.y;
        draw.AddLine(ImVec2(end.x, y), ImVec2(end.x + 6.0f * scale, y), kPale);
        char text[16];
        std::snprintf(text, sizeof text, "%d", newton);
        draw.AddText(ImVec2(end.x + 10.0f * scale, y - 0.5f * ImGui::GetFontSize()), kPale, text);
    }
    ImGui::Dummy(ImVec2(size.x, size.y));
}

void number_line(const char* name, double value, const char* unit, int digits) {
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine(ImGui::GetFontSize() * 4.0f);
    ImGui::Text("%.*f %s", digits, value, unit);
}

void cost_lines(const Plan& plan, const State& state, const FrameTimes& times) {
    ImGui::Separator();
    ImGui::TextDisabled("cost, median");
    for (const auto* stages : {&plan.sample_stages, &plan.frame_stages}) {
        for (const Stage& stage : *stages) {
            const Meter& meter = state.meters[static_cast<std::size_t>(stage.id)];
            ImGui::Text("%-13s %6.2f us", name_of(stage.id), 1e-3 * meter.quantile_ns(0.5));
        }
    }
    ImGui::Text("sample to frame %.1f ms", 1e-6 * times.latency.quantile_ns(0.5));
    ImGui::Text("frame, CPU %.2f ms", 1e-6 * times.cpu.quantile_ns(0.5));
    ImGui::Text("%.0f frames/s, %lld dropped", times.frames_per_s, static_cast<long long>(state.counters.dropped_steps));
}

void paragraph(const std::string& text) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled("%s", text.c_str());
    ImGui::PopTextWrapPos();
}

// A simulation in small strains says where the depth has left them behind.
void draw_gauge(const Plan& plan, const State& state) {
    if (plan.map.source.kind != SourceKind::simulated) return;
    constexpr double kDeep_m = std::numeric_limits<double>::infinity();  // a map does not say how thick the tissue is
    const double depth_m = state.contact.depth_m;
    const double width_m = 2.0 * std::sqrt(plan.map.indenter_radius_m * std::min(depth_m, plan.map.indenter_radius_m));
    const double ratio = mechanics::linearity_ratio(depth_m, kDeep_m, width_m);
    const mechanics::LinearRange range = mechanics::linear_range(ratio);
    if (range == mechanics::LinearRange::fine) return;
    const bool red = range == mechanics::LinearRange::red;
    ImGui::TextColored(red ? ImVec4(0.8f, 0.1f, 0.1f, 1.0f) : ImVec4(0.8f, 0.5f, 0.0f, 1.0f), "beyond the linear range (%s)",
                       red ? "red" : "amber");
}

}  // namespace

void draw_marks(const TissueView& view, const Plan& plan, const State& state, const Avatar& avatar, bool nodules,
                float scale) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    if (nodules) {
        for (const Nodule& nodule : plan.map.nodules) {
            const ImVec2 at = on_screen(view, {nodule.x_m, nodule.y_m});
            const auto radius = static_cast<float>(0.5 * nodule.diameter_m.value_or(4e-3)) * view.px_per_m;
            draw.AddCircle(at, radius, kInk, 48, 2.0f * scale);
            draw.AddText(ImVec2(at.x + radius + 4.0f * scale, at.y), kInk, nodule.id.c_str());
        }
    }
    if (!state.touch.down) return;
    const ImVec2 pen = on_screen(view, state.touch.p_m);
    draw.AddLine(on_screen(view, avatar.p_m), pen, kLag, 3.0f * scale);
    draw.AddCircle(pen, 6.0f * scale, kLag, 24, 2.5f * scale);
}

void draw_panel(const Scene& scene, const Plan& plan, const State& state, const Avatar& avatar,
                const FrameTimes& times, Gui& gui, PanelOptions& options) {
    const float scale = gui.scale();
    const float margin = 12.0f * scale;
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(margin, margin));
    ImGui::SetNextWindowSize(ImVec2(std::min(236.0f * scale, screen.x - 2.0f * margin), 0.0f));
    ImGui::SetNextWindowBgAlpha(0.75f);
    constexpr ImGuiWindowFlags kFixed = ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove |
                                        ImGuiWindowFlags_NoSavedSettings | ImGuiWindowFlags_AlwaysAutoResize;
    ImGui::Begin("palpa", nullptr, kFixed);
    paragraph(scene.name);
    draw_force_bar(plan, state, scale);
    number_line("Force", state.contact.normal_N, "N", 2);
    number_line("Depth", 1e3 * state.contact.depth_m, "mm", 2);
    number_line("Lag", 1e3 * avatar.lag_m.norm(), "mm", 2);
    if (scene.delay) number_line("Delay", 1e3 * avatar.delay_s, "ms", 0);
    if (scene.force_scale != 1.0) number_line("Phantom", scene.force_scale, "x force", 2);
    if (state.contact.saturated) ImGui::Text("deeper than recorded");
    if (!state.contact.measured) ImGui::Text("not measured here");
    ImGui::Checkbox("Nodules", &options.show_nodules);
    ImGui::Checkbox("Cost", &options.show_cost);
    if (options.show_cost) cost_lines(plan, state, times);
    for (const std::string& message : options.messages) paragraph(message);
    if (plan.map.source.kind == SourceKind::analytic) paragraph("analytic stand-in, no recording");
    if (plan.map.source.kind == SourceKind::simulated) paragraph("simulated, no recording");
    draw_gauge(plan, state);
    const ImVec2 at = ImGui::GetWindowPos();
    const ImVec2 size = ImGui::GetWindowSize();
    gui.claim({at.x, at.y, at.x + size.x, at.y + size.y});
    ImGui::End();
}

}  // namespace palpa
