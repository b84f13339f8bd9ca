#include "app/panels.h"

#include <imgui.h>

#include <algorithm>
#include <cstdio>

#include "mechanics/linear_range.h"

namespace palpa {
namespace {

constexpr ImU32 kInk = IM_COL32(235, 238, 240, 255);
constexpr ImU32 kPale = IM_COL32(150, 158, 165, 255);
constexpr ImU32 kLag = IM_COL32(255, 214, 90, 255);
constexpr ImU32 kBarBack = IM_COL32(60, 64, 68, 255);
constexpr ImU32 kBar = IM_COL32(120, 190, 235, 255);
constexpr ImU32 kSaturated = IM_COL32(245, 170, 80, 255);

const ImVec4 kAmber(1.0f, 0.75f, 0.25f, 1.0f);
const ImVec4 kRed(1.0f, 0.45f, 0.40f, 1.0f);

ImVec2 on_screen(const TissueView& view, const Eigen::Vector2d& p_m) {
    const glm::vec2 px = project_px(view, glm::vec3(p_m.x(), p_m.y(), 0.0));
    return {px.x, px.y};
}

// A vertical bar from 0 to the map's greatest force, ticks every newton.
void draw_force_bar(const Plan& plan, const State& state, float scale) {
    ImGui::Dummy(ImVec2(1.0f, 0.4f * ImGui::GetFontSize()));  // room for the topmost number
    const double full_N = std::max(1.0, plan.greatest_force_N);
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
    ImGui::Text("frame %.2f ms, GL %.1f ms", 1e-6 * times.cpu.quantile_ns(0.5), 1e-6 * times.gl.quantile_ns(0.5));
    ImGui::Text("%.0f frames/s, %lld dropped", times.frames_per_s, static_cast<long long>(state.counters.dropped_steps));
}

void paragraph(const std::string& text) {
    ImGui::PushTextWrapPos(0.0f);
    ImGui::TextDisabled("%s", text.c_str());
    ImGui::PopTextWrapPos();
}

}  // namespace

void draw_marks(const TissueView& view, const Plan& plan, const State& state, const Avatar& avatar, bool nodules,
                float scale) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    if (nodules) {
        for (const Nodule& nodule : plan.nodules) {
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

void draw_progress(const std::string& what, double share) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * screen.x, 0.5f * screen.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(std::min(0.8f * screen.x, 30.0f * ImGui::GetFontSize()), 0.0f));
    ImGui::Begin("progress", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings);
    paragraph(what);
    ImGui::ProgressBar(static_cast<float>(share), ImVec2(-1.0f, 0.0f));
    ImGui::End();
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
    switch (mechanics::linear_range(state.contact.linearity)) {
        case mechanics::LinearRange::fine: break;
        case mechanics::LinearRange::amber: ImGui::TextColored(kAmber, "leaving the linear range"); break;
        case mechanics::LinearRange::red: ImGui::TextColored(kRed, "beyond the linear range"); break;
    }
    if (state.without_level) {
        paragraph("This device reports no " + std::string(name_of(plan.profile.level)) + ", which profile " +
                  plan.profile.id + " reads: choose another device or profile.");
    }
    ImGui::Checkbox("Nodules", &options.show_nodules);
    ImGui::Checkbox("Cost", &options.show_cost);
    if (options.show_cost) cost_lines(plan, state, times);
    for (const std::string& message : options.messages) paragraph(message);
    if (plan.source == SourceKind::analytic) paragraph("analytic stand-in, no recording");
    if (plan.source == SourceKind::simulated) paragraph("simulated, no recording");
    const ImVec2 at = ImGui::GetWindowPos();
    const ImVec2 size = ImGui::GetWindowSize();
    gui.claim({at.x, at.y, at.x + size.x, at.y + size.y});
    ImGui::End();
}

}  // namespace palpa
