#include "app/screens/tangible_screen.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "app/screens/plot.h"
#include "app/screens/screens.h"
#include "app/screens/tangible_drawing.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

using session::TangibleActuator;
using session::TangibleMoment;

constexpr float kStop_mm = 18.0f;

// As value_line(), but a value that does not fit goes on below.
void soft_line(const char* name, const std::string& value, float column_px) {
    const float left_px = ImGui::GetCursorPosX();
    ImGui::TextDisabled("%s", name);
    ImGui::SameLine();
    ImGui::SetCursorPosX(left_px + column_px);
    wrapped_text(value);
}

// The state in one sentence, with a mark in front that is not only a colour.
void draw_soft_state(const TangibleShown& soft) {
    const TangibleMoment& moment = soft.moment;
    if (!soft.problem.empty()) return warning_paragraph(soft.problem);
    if (soft.opening) return paragraph(words::kSoftOpening);
    if (moment.stopped) return warning_paragraph(words::filled(words::kSoftStoppedBy, {moment.fault}));
    if (*moment.fault != '\0' && !moment.held)
        return warning_paragraph(words::filled(words::kSoftRestsSince, {moment.fault}));
    if (!soft.runs) return paragraph(words::kSoftRests);
    if (moment.held) return warning_paragraph(words::kSoftHeld);
    if (moment.limited_by >= 0 && moment.limited_by < static_cast<std::int32_t>(soft.body.actuators.size())) {
        const auto k = static_cast<std::size_t>(moment.limited_by);
        return warning_paragraph(words::filled(words::kLimitedBy, {soft.body.actuators[k].name}));
    }
    ImGui::TextUnformatted(words::kSoftRuns);
}

std::string rendered_title(const session::TangibleBody& body) {
    return words::filled(words::kRenderedForce, {body.rendered.empty() ? "-" : body.rendered});
}

void draw_force_values(const TangibleShown& soft, float column_px) {
    const TangibleMoment& moment = soft.moment;
    soft_line(words::kDepth, in_unit(moment.depth_m, 1e3, 2, "mm"), column_px);
    soft_line(words::kVirtualDepth,
              words::filled(words::kProxyDepth,
                            {in_unit(moment.world_depth_m, 1e3, 2, "mm"), in_unit(moment.proxy_m, 1e3, 2, "mm")}),
              column_px);
    soft_line(words::kWantedForce, in_unit(moment.wanted_N, 1.0, 3, "N"), column_px);
    soft_line(rendered_title(soft.body).c_str(), in_unit(moment.rendered_N, 1.0, 3, "N"), column_px);
    if (std::isfinite(moment.force_rms_percent))
        soft_line(words::kForceError, words::filled(words::kForceErrorIs, {fixed(moment.force_rms_percent, 2)}),
                  column_px);
}

std::string actuation_text(const TangibleActuator& actuator, double value) {
    return actuator.cavity ? in_unit(value, 1e-3, 2, "kPa") : in_unit(value, 1.0, 2, "N");
}

std::string limits_text(const TangibleActuator& actuator) {
    const double scale = actuator.cavity ? 1e-3 : 1.0;
    return fixed(scale * actuator.lower, 2) + " ... " + fixed(scale * actuator.upper, 2);
}

// Where the actuation stands between its limits, which are written on the bar; no place if it is not a number.
void draw_actuation_bar(const TangibleActuator& actuator, double value, bool at_limit, const Gui& gui) {
    const ImVec2 at = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, ImGui::GetTextLineHeight());
    const double span = actuator.upper - actuator.lower;
    const double share = std::isfinite(value) && span > 0.0 ? (value - actuator.lower) / span : 0.0;
    const float x = at.x + size.x * static_cast<float>(std::clamp(share, 0.0, 1.0));
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    draw.AddRectFilled(at, ImVec2(at.x + size.x, at.y + size.y), kForceTints[0]);
    if (std::isfinite(value)) {
        draw.AddRectFilled(at, ImVec2(x, at.y + size.y), kForceTints[1]);
        draw.AddLine(ImVec2(x, at.y), ImVec2(x, at.y + size.y), at_limit ? kLag : kInk, 0.6f * gui.mm());
    }
    const float small_px = 0.8f * ImGui::GetFontSize();
    draw.AddText(ImGui::GetFont(), small_px, ImVec2(at.x + gui.mm(), at.y + 0.1f * small_px), kInk,
                 limits_text(actuator).c_str());
    ImGui::Dummy(size);
}

void draw_actuators(const TangibleShown& soft, const Gui& gui) {
    if (soft.body.actuators.empty()) return;
    constexpr int kColumns = 4, kBar = 2;
    if (!ImGui::BeginTable("actuators", kColumns, ImGuiTableFlags_SizingFixedFit)) return;
    for (int column = 0; column < kColumns; ++column)
        ImGui::TableSetupColumn("", column == kBar ? ImGuiTableColumnFlags_WidthStretch : ImGuiTableColumnFlags_None);
    for (const char* title : {words::kActuator, words::kActuation, words::kLimits, words::kCommand}) {
        ImGui::TableNextColumn();
        ImGui::TextDisabled("%s", title);
    }
    const std::size_t count = std::min(soft.body.actuators.size(), session::kMostTangibleActuators);
    for (std::size_t k = 0; k < count; ++k) {
        const TangibleActuator& actuator = soft.body.actuators[k];
        const bool relaxed = is_relaxed(soft.moment);  // the actuation is no solution then
        const bool held = !relaxed && ((soft.moment.active >> k) & 1U) != 0;
        const double near = 0.01 * (actuator.upper - actuator.lower);
        const double a = relaxed ? std::numeric_limits<double>::quiet_NaN() : soft.moment.actuation[k];
        const bool at_limit = held && (a < actuator.lower + near || a > actuator.upper - near);
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(actuator.name.c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(actuation_text(actuator, a).c_str());
        ImGui::TableNextColumn();
        draw_actuation_bar(actuator, a, at_limit, gui);
        ImGui::TableNextColumn();
        const std::string command = relaxed              ? words::kRelaxedDrive
                                    : actuator.by_length ? in_unit(soft.moment.length[k], 1e3, 2, "mm")
                                                         : actuation_text(actuator, a);
        const char* said = at_limit ? words::kAtLimit : held ? words::kHeld : "{}";
        ImGui::TextUnformatted(words::filled(said, {command}).c_str());
    }
    ImGui::EndTable();
}

// What each part of the model adds to the gap between where the effector is and where it should be.
void draw_problem(const TangibleShown& soft, float column_px) {
    const TangibleMoment& moment = soft.moment;
    if (!soft.runs || moment.stopped) return;
    soft_line(words::kGap, in_unit(moment.gap_m, 1e3, 3, "mm"), column_px);
    soft_line(words::kGapByActuators, in_unit(moment.by_actuators_m, 1e3, 3, "mm"), column_px);
    std::string row;
    const std::size_t count = std::min(soft.body.actuators.size(), session::kMostTangibleActuators);
    for (std::size_t k = 0; k < count; ++k) {
        const bool cavity = soft.body.actuators[k].cavity;
        row += (row.empty() ? "" : ", ") + fixed((cavity ? 1e6 : 1e3) * moment.compliance[k], 3) +
               (cavity ? " mm/kPa" : " mm/N");
    }
    soft_line(words::kCompliance, row.empty() ? "-" : row, column_px);
    soft_line(words::kGapLeft, in_unit(moment.residual_m, 1e3, 4, "mm"), column_px);
    const std::string solved = words::filled(
        words::kSolvedIn, {soft.body.algorithm, std::to_string(moment.rank), std::to_string(moment.iterations)});
    soft_line(words::kSolve, solved + (moment.converged ? "" : std::string(", ") + words::kNotConverged), column_px);
}

void draw_loop(const TangibleShown& soft, float column_px) {
    const TangibleMoment& moment = soft.moment;
    if (!soft.runs) return;
    soft_line(words::kTicks,
              words::filled(words::kTicksMissed, {std::to_string(moment.ticks), std::to_string(moment.missed_ticks),
                                                  std::to_string(moment.saturated_ticks), fixed(moment.held_s, 1)}),
              column_px);
    soft_line(
        words::kPeriod,
        words::filled(words::kPeriodTimes, {fixed(1e3 * moment.period_p50_s, 1), fixed(1e3 * moment.period_p99_s, 1),
                                            fixed(1e3 * moment.step_p50_s, 2), fixed(1e3 * moment.step_p99_s, 2)}),
        column_px);
}

void draw_soft_values(const Shown& shown, Gui& gui, Wishes& wishes) {
    if (big_button(words::kBack, words::kEscape, {std::min(52.0f * gui.mm(), share_of_line_px(2)), kTarget_mm}, gui))
        wishes.screen = Screen::trial;
    if (shown.tangible == nullptr) return paragraph(words::kNoTangible);
    const TangibleShown& soft = *shown.tangible;
    draw_stop_or_release(soft, soft.moment.stopped, 0.0f, kStop_mm, gui, wishes);
    const float longest_px =
        std::max(ImGui::CalcTextSize(words::kGap).x, ImGui::CalcTextSize(rendered_title(soft.body).c_str()).x);
    const float column_px = longest_px + 2.0f * gui.mm();
    draw_soft_state(soft);
    ImGui::Separator();
    ImGui::BeginChild("soft values");  // this part may scroll, since there may be up to eight actuators
    draw_force_values(soft, column_px);
    ImGui::Separator();
    draw_actuators(soft, gui);
    ImGui::Separator();
    draw_problem(soft, column_px);
    draw_loop(soft, column_px);
    draw_devices(soft.devices);
    ImGui::EndChild();
}

// The least of 1, 2, 5 times a power of ten that is not below `value`: axes then seldom change.
double round_up(double value) {
    const double power = std::pow(10.0, std::floor(std::log10(std::max(value, 1e-9))));
    for (const double step : {1.0, 2.0, 5.0}) {
        if (step * power >= value) return step * power;
    }
    return 10.0 * power;
}

// Says in the plot's upper left corner, where a force that rises with depth leaves space, which marks are which.
void draw_legend(const PanelArea& area, const TangibleShown& soft, float mm, ImDrawList& draw) {
    const float small_px = 0.8f * ImGui::GetFontSize();
    const float x = area.x0 + 2.0f * mm;
    float y = area.y0 + 0.8f * mm + 0.5f * small_px;
    draw.AddCircle(ImVec2(x, y), 0.8f * mm, kInk, 12);
    draw.AddText(ImGui::GetFont(), small_px, ImVec2(x + 1.8f * mm, y - 0.5f * small_px), kInk, words::kWantedForce);
    y += 1.2f * small_px;
    draw.AddCircleFilled(ImVec2(x, y), 0.6f * mm, kLag);
    draw.AddText(ImGui::GetFont(), small_px, ImVec2(x + 1.8f * mm, y - 0.5f * small_px), kInk,
                 rendered_title(soft.body).c_str());
}

void draw_press(const PanelArea& area, const TangibleShown& soft, float mm) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    Plot plot;
    plot.area = data_area(area, mm);
    if (plot.area.width() < 10.0f * mm || plot.area.height() < 8.0f * mm) return;
    double depth_mm = 2.0, force_N = 0.5;
    for (const ForceAtDepth& at : soft.press) {
        depth_mm = std::max(depth_mm, 1e3 * at.depth_m);
        force_N = std::max({force_N, at.wanted_N, std::isfinite(at.rendered_N) ? at.rendered_N : 0.0});
    }
    plot.most_x = round_up(depth_mm);
    plot.most_y = round_up(force_N);
    draw_plot_axes(plot, {words::kForceOverDepth, words::kDepthAxis, words::kForceAxis}, mm, draw);
    draw_legend(plot.area, soft, mm, draw);
    for (const ForceAtDepth& at : soft.press) {
        if (!std::isfinite(at.depth_m)) continue;
        if (std::isfinite(at.rendered_N))
            draw.AddCircleFilled(plot.at(1e3 * at.depth_m, at.rendered_N), 0.6f * mm, kLag);
        if (std::isfinite(at.wanted_N)) draw.AddCircle(plot.at(1e3 * at.depth_m, at.wanted_N), 0.8f * mm, kInk, 12);
    }
}

// A section through the virtual tissue: the finger, and the proxy that stays on the surface.
void draw_world(const PanelArea& area, const TangibleMoment& moment, float mm) {
    const float text_px = ImGui::GetFontSize();
    const PanelArea box{area.x0, area.y0 + 1.3f * text_px, area.x1, area.y1 - 1.1f * text_px};
    if (box.width() < 12.0f * mm || box.height() < 8.0f * mm) return;
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw.AddText(ImVec2(area.x0, area.y0), kInk, words::kVirtualTissue);
    const double depth_m = std::isfinite(moment.world_depth_m) ? moment.world_depth_m : 0.0;
    const double proxy_m = std::isfinite(moment.proxy_m) ? moment.proxy_m : 0.0;
    const double span_m = 1e-3 * round_up(1e3 * std::max(8e-3, 1.3 * depth_m));
    const float surface = box.y0 + 0.2f * box.height();
    const auto y_of = [&](double below_m) {
        const double share = std::clamp(below_m / span_m, -0.2, 1.0);
        return surface + static_cast<float>(share) * 0.8f * box.height();
    };
    constexpr int kColumns = 48;
    const float middle = 0.5f * (box.x0 + box.x1);
    const auto top_at = [&](float x) {
        const float off = (x - middle) / (0.2f * box.width());
        return y_of(proxy_m / (1.0 + static_cast<double>(off * off * off * off)));
    };
    const ImDrawListFlags before = draw.Flags;
    draw.Flags &= ~ImDrawListFlags_AntiAliasedFill;  // or the columns would be told apart
    for (int i = 0; i < kColumns; ++i) {
        const float x0 = box.x0 + box.width() * static_cast<float>(i) / kColumns;
        const float x1 = box.x0 + box.width() * static_cast<float>(i + 1) / kColumns;
        draw.AddQuadFilled(ImVec2(x0, top_at(x0)), ImVec2(x1, top_at(x1)), ImVec2(x1, box.y1), ImVec2(x0, box.y1),
                           kForceTints[1]);
        draw.AddLine(ImVec2(x0, top_at(x0)), ImVec2(x1, top_at(x1)), kPale, 0.4f * mm);
    }
    draw.Flags = before;
    draw.AddLine(ImVec2(box.x0, surface), ImVec2(box.x1, surface), kPale);
    draw.AddCircleFilled(ImVec2(middle, y_of(depth_m)), mm, kLag);
    draw.AddCircle(ImVec2(middle, y_of(proxy_m)), 1.8f * mm, kInk, 0, 0.4f * mm);
    draw.AddText(ImGui::GetFont(), 0.8f * text_px, ImVec2(box.x0, box.y1 + 0.15f * text_px), kPale,
                 words::kProxyAndFinger);
}

void draw_pictures(const PanelArea& area, const TangibleShown& soft, float mm) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const float text_px = ImGui::GetFontSize();
    const float split = area.y0 + 0.52f * area.height();
    if (!soft.body.rest_m.empty()) {
        draw.AddText(ImVec2(area.x0, area.y0), kInk, words::filled(words::kSoftDeformed, {soft.body.device}).c_str());
        // while the device is relaxed, nothing is computed of its shape: it is drawn as it is without a finger
        const bool computed = soft.has_shape && !is_relaxed(soft.moment);
        const session::PointOfDevice* nodes = computed ? soft.shape->node_m.data() : soft.body.rest_m.data();
        draw_soft_body({area.x0, area.y0 + 1.4f * text_px, area.x1, split}, soft.body, nodes, soft.moment, mm, draw);
    }
    const float gap_px = 4.0f * mm;
    const float right = area.x0 + 0.66f * area.width();
    draw_press({area.x0, split + gap_px, right, area.y1}, soft, mm);
    draw_world({right + gap_px, split + gap_px, area.x1, area.y1}, soft.moment, mm);
}

}  // namespace

void draw_tangible_screen(const Shown& shown, Gui& gui, Wishes& wishes) {
    const HalfScreen halves = halves_of(gui);
    cover_window(gui);
    if (shown.tangible != nullptr) draw_pictures(halves.rest, *shown.tangible, gui.mm());
    begin_panel("tangible", halves.panel, gui);
    draw_soft_values(shown, gui, wishes);
    end_panel("tangible", gui);
}

}  // namespace palpa::app
