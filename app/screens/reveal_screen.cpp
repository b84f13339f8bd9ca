// The screen after a trial: what was there, what was found, where the pen was and how deep it pressed.

#include <algorithm>
#include <cmath>

#include "app/screens/coverage_drawing.h"
#include "app/screens/nodule_outline.h"
#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

void draw_path(const Shown& shown, float mm, ImDrawList& draw) {
    const std::vector<session::PathPoint>& path = shown.trial.path;
    for (std::size_t i = 1; i < path.size(); ++i) {
        if (path[i].begins) continue;
        draw.AddLine(on_screen(shown.view, path[i - 1].p_m.x(), path[i - 1].p_m.y()),
                     on_screen(shown.view, path[i].p_m.x(), path[i].p_m.y()), IM_COL32(20, 22, 24, 200), 0.3f * mm);
    }
}

// Returns the areas of the names.
std::vector<PanelArea> draw_nodules(const Shown& shown, const session::Debrief& debrief, float mm, ImDrawList& draw) {
    std::vector<PanelArea> names;
    for (std::size_t i = 0; i < shown.plan.nodules.size(); ++i) {
        const stiffnessmaps::Nodule& nodule = shown.plan.nodules[i];
        const ImVec2 at = on_screen(shown.view, nodule.x_m, nodule.y_m);
        const auto px = [&](double x_m, double y_m) { return on_surface(shown.picture, x_m, y_m); };
        const bool found = debrief.findings[i] == session::Finding::found;
        const float right_px = draw_outline(outline_of(nodule), px, {0.7f * mm, 0.5f * mm, !found}, draw);
        const std::string text = nodule.id + ": " + name_of(debrief.findings[i]);
        const float width_px = ImGui::CalcTextSize(text.c_str()).x;
        const bool fits = right_px + mm + width_px < ImGui::GetIO().DisplaySize.x;
        const float left_px = fits ? right_px + mm : 2.0f * at.x - right_px - mm - width_px;
        names.push_back(plated_text(draw, ImVec2(left_px, at.y + 0.3f * ImGui::GetFontSize()), kInk, text));
    }
    return names;
}

void draw_marks(const Shown& shown, const session::Debrief& debrief, const std::vector<PanelArea>& names, float mm,
                ImDrawList& draw) {
    std::vector<Label> labels;
    for (std::size_t i = 0; i < shown.trial.marks.size(); ++i) {
        const session::Mark& mark = shown.trial.marks[i];
        const ImVec2 at = on_screen(shown.view, mark.p_m.x(), mark.p_m.y());
        const study::MarkKind kind = debrief.score.marks[i].kind;
        if (debrief.scored && kind == study::MarkKind::false_mark) {
            cross(draw, at, 1.7f * mm, kDark, 1.8f * mm);
            cross(draw, at, 1.7f * mm, kInk, 0.7f * mm);
        } else {
            draw.AddCircleFilled(at, 1.7f * mm, kDark);
            if (kind == study::MarkKind::hit) draw.AddCircleFilled(at, 1.3f * mm, kInk);
        }
        const char* pattern = !debrief.scored || kind == study::MarkKind::hit ? "{}"
                              : kind == study::MarkKind::again                ? words::kMarkDuplicate
                                                                              : words::kMarkFalse;
        std::string word = words::filled(pattern, {std::to_string(i + 1)});
        if (mark.confidence > 0) word += words::filled(words::kConfidenceOf, {std::to_string(mark.confidence)});
        labels.push_back({at, word});
    }
    place_labels(labels, names, static_cast<float>(shown.state.screen.x_px), mm, draw);
}

// A little is not nothing, and nearly all not all.
std::string percent(double share) {
    if (!std::isfinite(share)) return "-";
    if (share > 0.0 && share <= 0.005) return "< 1 %";
    if (share < 1.0 && share >= 0.995) return "> 99 %";
    return fixed(100.0 * share, 0) + " %";
}

void gap_before_results(const Gui& gui) {
    ImGui::Dummy(ImVec2(0.0f, 0.5f * gui.mm()));
    ImGui::Separator();
}

void result_lines(const Shown& shown, const Reviewing& reviewing, const Gui& gui) {
    const session::Debrief& debrief = reviewing.debrief;
    if (!reviewing.advice.empty()) {
        wrapped_text(reviewing.advice);
        gap_before_results(gui);
    }
    const study::Score& s = debrief.score;
    const float column_px = 34.0f * gui.mm();
    const auto share = [](double value, int count, int of) {
        return words::filled(words::kShareOf, {percent(value), std::to_string(count), std::to_string(of)});
    };
    if (debrief.scored) {
        value_line(words::kSensitivity, share(s.sensitivity, s.true_positives, s.true_positives + s.false_negatives),
                   column_px);
        hint_for_last(words::kHintSensitivity);
        value_line(words::kPpv, share(s.ppv, s.true_positives, s.true_positives + s.false_positives), column_px);
        hint_for_last(words::kHintPpv);
        value_line(words::kFalsePositives, std::to_string(s.false_positives), column_px);
    } else {
        value_line(words::kMarksMade, std::to_string(shown.trial.marks.size()), column_px);
    }
    value_line(words::kTime, clock_text(shown.trial_s), column_px);
    for (std::size_t i = 0; i < shown.plan.nodules.size(); ++i) {
        std::string text = shown.plan.nodules[i].id + ": " + name_of(debrief.findings[i]);
        const int by = s.found_by[i];
        const int sure = by < 0 ? 0 : shown.trial.marks[static_cast<std::size_t>(by)].confidence;
        if (sure > 0) text += words::filled(words::kConfidenceOf, {std::to_string(sure)});
        // what is deeper than the tissue is known for reads as the depth that it is known for
        if (debrief.depth_m[i] > 0.0)
            text +=
                words::filled(words::kDownTo, {(debrief.beyond[i] ? "> " : "") + fixed(1e3 * debrief.depth_m[i], 1)});
        wrapped_text(text);
    }
}

void legend(const session::Debrief& debrief, const Gui& gui) {
    ImGui::TextDisabled(words::kCoverageAtLeast);
    constexpr const char* kNames[study::kPalpationLevels] = {words::kNotTouched, words::kLight, words::kMedium,
                                                             words::kDeep};
    float column_px = 0.0f;
    for (const char* name : kNames) column_px = std::max(column_px, ImGui::CalcTextSize(name).x);
    column_px += 2.0f * gui.mm();
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    for (int level = study::kPalpationLevels - 1; level >= 0; --level) {
        const ImVec2 at = ImGui::GetCursorScreenPos();
        const float side_px = ImGui::GetFontSize();
        const ImVec2 end(at.x + side_px, at.y + side_px);
        if (level > 0) draw.AddRectFilled(at, end, kAreaTints[level - 1]);
        for (float s = 0.0f; level == 0 && s < 0.99f; s += 0.25f) {  // hatched
            draw.AddLine(ImVec2(at.x + s * side_px, end.y), ImVec2(end.x, at.y + s * side_px), kPale);
            draw.AddLine(ImVec2(at.x, end.y - s * side_px), ImVec2(end.x - s * side_px, at.y), kPale);
        }
        ImGui::Dummy(ImVec2(side_px, side_px));
        ImGui::SameLine();
        value_line(kNames[level], percent(debrief.area.at_least[level]), column_px);
        hint_for_last(words::kHintCoverage);
    }
}

void buttons(const Gui& gui, bool menu, Wishes& wishes) {
    const float width_px = share_of_line_px(2);
    if (big_button(words::kRestart, words::kKeyAgain, {width_px, kMark_mm, true, false, words::kHintRestart}, gui))
        wishes.again = true;
    ImGui::SameLine();
    if (big_button(words::kNext, words::kKeyNext, {width_px, kMark_mm, true, false, words::kHintNext}, gui))
        wishes.next = true;
    if (big_button(words::kSavePicture, words::kKeyPicture, {width_px, kTarget_mm, true, false}, gui))
        wishes.save_picture = true;
    ImGui::SameLine();
    if (big_button(menu ? words::kClose : words::kMenu, "F10", {width_px, kTarget_mm, true, menu}, gui))
        wishes.menu = !menu;
}

void messages(const Shown& shown, const Gui& gui, Wishes& wishes) {
    draw_problems(shown, gui, wishes);
    if (!shown.notices.note.empty()) paragraph(shown.notices.note);
    if (!shown.notices.trials_note.empty()) paragraph(shown.notices.trials_note);
}

}  // namespace

void draw_reveal_on_tissue(const Shown& shown, const Gui& gui, const session::Debrief& debrief) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    draw_coverage(shown.view, shown.trial.coverage, gui.mm(), draw);
    draw_path(shown, gui.mm(), draw);
    draw_marks(shown, debrief, draw_nodules(shown, debrief, gui.mm(), draw), gui.mm(), draw);
}

void draw_reveal_panel(const Shown& shown, const Layout& layout, const Reviewing& reviewing, Gui& gui, Wishes& wishes) {
    if (!layout.controls) return;
    begin_panel("reveal", layout.controls_px, gui);
    if (layout.column) {
        buttons(gui, reviewing.menu, wishes);
        ImGui::BeginChild("rest", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);  // messages scroll
        ImGui::PushStyleVar(ImGuiStyleVar_ItemSpacing, ImVec2(ImGui::GetStyle().ItemSpacing.x, 0.5f * gui.mm()));
        result_lines(shown, reviewing, gui);
        legend(reviewing.debrief, gui);
        const bool fits = ImGui::GetCursorPosY() <= ImGui::GetWindowHeight() + 1.0f;
        if (!fits) gui.note_overflow("result");
        messages(shown, gui, wishes);
        ImGui::PopStyleVar();
        ImGui::EndChild();
    } else {
        ImGui::BeginChild("results", ImVec2(share_of_line_px(2), 0.0f), false, ImGuiWindowFlags_NavFlattened);
        result_lines(shown, reviewing, gui);
        ImGui::EndChild();
        ImGui::SameLine();
        ImGui::BeginChild("legend", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
        buttons(gui, reviewing.menu, wishes);
        legend(reviewing.debrief, gui);
        messages(shown, gui, wishes);
        ImGui::EndChild();
    }
    end_panel("reveal", gui);
}

}  // namespace palpa::app
