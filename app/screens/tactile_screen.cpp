#include "app/screens/tactile_screen.h"

#include <algorithm>
#include <cmath>

#include "app/screens/pins_drawing.h"
#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "mechanics/linear_range.h"

namespace palpa::app {
namespace {

using session::ReachedBy;
using session::TactileMoment;

constexpr double kGreatestDamping = 8.0;  // N s/m: above it a stiff tissue and a slow loop begin to swing

const char* range_words(double linearity) {
    switch (mechanics::linear_range(linearity)) {
        case mechanics::LinearRange::red:
            return words::kBeyondLinear;
        case mechanics::LinearRange::amber:
            return words::kLeavingLinear;
        case mechanics::LinearRange::fine:
            break;
    }
    return words::kWithinLinear;
}

// The state in one sentence, with a mark in front that is not only a colour.
void draw_state(const TactileShown& tactile) {
    const TactileMoment& moment = tactile.moment;
    if (!tactile.problem.empty()) return warning_paragraph(tactile.problem);
    if (tactile.opening) return paragraph(words::kDevicesOpening);
    // after a stop no trial opens the devices, until they are released
    if (moment.stopped) return warning_paragraph(words::filled(words::kStoppedBy, {moment.fault}));
    if (tactile.devices.empty()) return paragraph(moment.rows > 0 ? words::kPinsOnlyDrawn : words::kNoTactile);
    if (*moment.fault != '\0') return warning_paragraph(words::filled(words::kRestsSince, {moment.fault}));
    if (!tactile.runs) return paragraph(words::kTactileRests);
    wrapped_text(moment.held ? words::kHolds : words::kTactileRuns);
}

void draw_force_lines(const TactileShown& tactile, float column_px) {
    const TactileMoment& moment = tactile.moment;
    const std::string limit = in_unit(tactile.force_limit_N, 1.0, 1, "N");
    value_line(words::kForce,
               words::filled(words::kOfLimit, {in_unit(session::force_now_N(moment), 1.0, 2, "N"), limit}), column_px);
    if (std::isfinite(moment.sensor_N))
        value_line(words::kForceSensor, in_unit(moment.sensor_N, 1.0, 2, "N"), column_px);
    value_line(words::kDepth, in_unit(moment.depth_m, 1e3, 2, "mm"), column_px);
    value_line(words::kHoldLine, moment.held ? words::kHeldNow : "-", column_px);
    // 0 at rest, and for tissues that are no linear ones
    value_line(words::kLinearRange, moment.linearity > 0.0 ? range_words(moment.linearity) : "-", column_px);
    if (moment.over_edge) warning_paragraph(words::kOverEdge);
}

void draw_pin_lines(const TactileMoment& moment, float column_px) {
    if (moment.rows <= 0) return;
    value_line(words::kMismatch, in_unit(moment.mismatch_m, 1e3, 3, "mm"), column_px);
    value_line(words::kPinsBehind, in_unit(moment.mismatch_s, 1e3, 0, "ms"), column_px);
    const std::string scale = moment.shape_scale < 1.0 ? fixed(moment.shape_scale, 2) + " x" : "-";
    value_line(words::kClippedPins, std::to_string(moment.clipped), column_px);
    value_line(words::kShapeScale, scale, column_px);
}

void draw_loop_lines(const TactileShown& tactile, float column_px) {
    const TactileMoment& moment = tactile.moment;
    if (!tactile.runs) return;
    if (moment.arm) {
        value_line(words::kLink, link_text(moment), column_px);
        value_line(words::kSwing, in_unit(moment.stiffness_delay_N_s_per_m, 1.0, 1, "N s/m"), column_px);
    }
    value_line(words::kLoopSteps,
               words::filled(words::kLoopTimes, {fixed(1e6 * moment.step_p50_s, 0), fixed(1e6 * moment.step_p99_s, 0),
                                                 std::to_string(moment.late_steps)}),
               column_px);
    if (moment.stiffness_delay_N_s_per_m > kGreatestDamping) warning_paragraph(words::kMaySwing);
}

void draw_buttons(const TactileShown* tactile, const Gui& gui, Wishes& wishes) {
    const float width_px = std::min(52.0f * gui.mm(), share_of_line_px(2));
    if (big_button(words::kBack, words::kEscape, {width_px, kTarget_mm, true, false}, gui))
        wishes.screen = Screen::trial;
    if (tactile == nullptr || (tactile->devices.empty() && !tactile->moment.stopped)) return;
    ImGui::SameLine();
    draw_stop_or_release(*tactile, tactile->moment.stopped, width_px, kTarget_mm, gui, wishes);
}

void draw_values(const Shown& shown, Gui& gui, Wishes& wishes) {
    draw_buttons(shown.tactile, gui, wishes);
    if (shown.tactile == nullptr) return paragraph(words::kNoTactile);
    const float column_px = ImGui::CalcTextSize(words::kSwing).x + 2.0f * gui.mm();  // the longest name
    draw_state(*shown.tactile);
    ImGui::Separator();
    ImGui::BeginChild("values");  // this part may scroll, since there may be any number of devices
    draw_force_lines(*shown.tactile, column_px);
    draw_pin_lines(shown.tactile->moment, column_px);
    draw_loop_lines(*shown.tactile, column_px);
    draw_devices(shown.tactile->devices);
    ImGui::EndChild();
}

const char* reached_title(ReachedBy reached) {
    return reached == ReachedBy::simulator ? words::kPinsReachedTrue : words::kPinsReachedEstimate;
}

// Both fields side by side, or one below the other in a tall area, and below them the middle row of both.
void draw_fields(const PanelArea& area, const TactileMoment& moment, float mm) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    const float text_px = 1.5f * ImGui::GetFontSize();
    const bool both = moment.reached != ReachedBy::nothing;
    const float section_px = std::min(36.0f * mm, 0.25f * area.height());
    const float gap_px = 4.0f * mm;
    const float width_px = both ? 0.5f * (area.width() - gap_px) : area.width();
    const float height_px = area.height() - section_px - 2.0f * text_px - gap_px;
    const float top = area.y0 + text_px;
    const PinField wanted{moment.rows, moment.columns, moment.stroke_m, moment.wanted_m.data()};
    const PinField reached{moment.rows, moment.columns, moment.stroke_m, moment.reached_m.data()};
    draw.AddText(ImVec2(area.x0, area.y0), kInk, words::kPinsWanted);
    PanelArea used = draw_pin_field({area.x0, top, area.x0 + width_px, top + height_px}, wanted, mm, draw);
    if (both) {
        const float x0 = used.x1 + gap_px;
        draw.AddText(ImVec2(x0, area.y0), kInk, reached_title(moment.reached));
        used.x1 = draw_pin_field({x0, top, x0 + width_px, top + height_px}, reached, mm, draw).x1;
    }
    const float section_top = used.y1 + gap_px;
    draw.AddText(ImVec2(area.x0, section_top), kPale, both ? words::kMiddleRowBoth : words::kMiddleRow);
    draw_pin_section({area.x0, section_top + text_px, used.x1, section_top + text_px + section_px}, wanted,
                     both ? moment.reached_m.data() : nullptr, mm, draw);
}

}  // namespace

std::string link_text(const TactileMoment& moment) {
    if (std::isfinite(moment.silent_s))
        return words::filled(words::kLinkSilent, {in_unit(moment.silent_s, 1.0, 1, "s")});
    return words::filled(words::kLinkTimes, {fixed(1e3 * moment.round_trip_p50_s, 2),
                                             fixed(1e3 * moment.round_trip_p99_s, 2), std::to_string(moment.lost)});
}

void draw_tactile_screen(const Shown& shown, Gui& gui, Wishes& wishes) {
    const HalfScreen halves = halves_of(gui);
    cover_window(gui);
    if (shown.tactile != nullptr && shown.tactile->moment.rows > 0)
        draw_fields(halves.rest, shown.tactile->moment, gui.mm());
    begin_panel("tactile", halves.panel, gui);
    draw_values(shown, gui, wishes);
    end_panel("tactile", gui);
}

}  // namespace palpa::app
