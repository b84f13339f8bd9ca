// The screen on which a person palpates: force bar, numbers, mark and confidence, time.

#include <algorithm>
#include <cmath>
#include <utility>

#include "app/screens/force_bar.h"
#include "app/screens/nodule_outline.h"
#include "app/screens/pins_drawing.h"
#include "app/screens/screens.h"
#include "app/screens/tactile_screen.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "mechanics/linear_range.h"

namespace palpa::app {
namespace {

// A surface that a study gives to the finger alone: the screen shows nothing of it, and its force only in practice.
bool hides_tissue(const Shown& shown) { return study_of(shown.doing) != nullptr && device_leads(shown); }
bool hides_force(const Shown& shown) { return hides_tissue(shown) && !due_trial(*study_of(shown.doing)).practice; }

// True for an interval of a forced choice: there is nothing to mark, and no number may tell how soft the surface is.
bool is_interval(const Doing& doing) {
    const StudyRun* study = study_of(doing);
    return study != nullptr && due_compares(*study);
}

void draw_numbers(const Shown& shown, const Gui& gui) {
    const float column_px = 13.5f * gui.mm();
    const scene::Contact& contact = shown.state.contact;
    ImGui::BeginGroup();
    value_line(words::kForce, fixed(felt_force_N(shown), 2) + " N", column_px);
    const std::string depth_mm = fixed(1e3 * felt_depth_m(shown), 2);
    const std::string depth = contact.saturated ? words::filled(words::kMoreThan, {depth_mm}) : depth_mm + " mm";
    if (!is_interval(shown.doing)) value_line(words::kDepth, depth, column_px);
    // in a test the eye has to judge the lag, so no number shows it
    if (shown.trial.mode == session::TrialMode::practice) {
        value_line(words::kLag, fixed(1e3 * scene::seen_lag_m(shown.avatar), 2) + " mm", column_px);
        if (shown.scene.delay) value_line(words::kDelay, fixed(1e3 * shown.avatar.delay_s, 0) + " ms", column_px);
    }
    if (shown.scene.force_scale != 1.0)
        value_line(words::kPhantom, fixed(shown.scene.force_scale, 2) + " x", column_px);
    ImGui::EndGroup();
}

// Draws one line that takes up its space even if it is empty, so that nothing moves when it fills.
void draw_contact_note(const Shown& shown) {
    const bool held = shown.tactile != nullptr && shown.tactile->moment.held;
    // force and shape hold at the limit of force, or where the tissue is not known deeper, which soft tissue is below it
    const bool of_force = held && shown.tactile->moment.force_N > 0.98 * shown.tactile->force_limit_N;
    const bool leads = device_leads(shown);
    const char* note = of_force                       ? words::kPressLightly
                       : held                         ? words::kNoDeeper
                       : leads && !device_runs(shown) ? words::kNoDevicePresses
                       : leads                        ? (shown.state.touch.down ? words::kDevicePresses : "")
                                                      : contact_note(shown.state.contact, shown.experimenter);
    ImGui::TextColored(ImVec4(1.0f, 0.84f, 0.35f, 1.0f), "%s", note);
}

// Draws the header for a participant, who has no menu and sees which trial this is and the time that is left.
void draw_study_header(const Shown& shown, const StudyRun& run) {
    const double limit_s = due_limit_s(run);
    const double left_s = limit_s > 0.0 ? std::max(0.0, std::ceil(limit_s - shown.trial_s)) : shown.trial_s;
    const char* what = due_trial(run).practice ? words::kPractice : "";
    ImGui::SetWindowFontScale(1.3f);
    ImGui::Text("%s  %s", clock_text(left_s).c_str(), what);
    ImGui::SetWindowFontScale(1.0f);
    if (due_compares(run)) {
        wrapped_text(run.interval == 0 ? words::kFirstSurface : words::kSecondSurface);
        paragraph(words::filled(words::kPairOf, {progress_text(run)}));
    } else {
        paragraph(words::filled(words::kTrialOf, {progress_text(run)}));
    }
}

void draw_header(const Shown& shown, const Gui& gui, ViewState& view, Wishes& wishes) {
    if (const StudyRun* study = study_of(shown.doing)) return draw_study_header(shown, *study);
    const bool* has_menu = menu_of(shown.doing);
    const bool menu = has_menu != nullptr && *has_menu;
    const float line_px = kTarget_mm * gui.mm();
    const float right_px = ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x;
    if (big_button(menu ? words::kClose : words::kMenu, "",
                   {20.0f * gui.mm(), kTarget_mm, true, menu, words::kHintMenu}, gui))
        wishes.menu = !menu;
    ImGui::SameLine();
    const float top_px = ImGui::GetCursorPosY();
    ImGui::SetCursorPosY(top_px + 0.5f * (line_px - 1.2f * ImGui::GetFontSize()));
    ImGui::SetWindowFontScale(1.2f);
    ImGui::TextUnformatted(clock_text(shown.trial_s).c_str());
    ImGui::SetWindowFontScale(1.0f);
    ImGui::SameLine();
    ImGui::SetCursorPos(ImVec2(right_px - 2.0f * line_px - ImGui::GetStyle().ItemSpacing.x, top_px));
    const bool paused = shown.trial.paused_at_s.has_value();
    if (icon_button(paused ? Icon::play : Icon::pause, paused ? words::kHintContinue : words::kHintPause, gui))
        wishes.action = paused ? platform::Action::resume : platform::Action::pause;
    ImGui::SameLine();
    if (icon_button(Icon::question, words::kHintHelp, gui)) view.help = true;
    const char* mode = shown.trial.mode == session::TrialMode::practice ? words::kPractice : words::kTest;
    one_line(words::filled(words::kSceneAndMode, {mode, shown.scene.name}));
}

// While the clock is stopped, or once the trial is, nothing is marked and nothing is finished.
bool may_act(const Shown& shown) { return !shown.trial.paused_at_s && !shown.notices.trial_stopped; }

void draw_confidence(const Shown& shown, const Gui& gui, Wishes& wishes) {
    const int said = shown.trial.marks.empty() ? 0 : shown.trial.marks.back().confidence;
    ImGui::TextDisabled(words::kUnsure);
    const char* sure = words::kSure;
    ImGui::SameLine();
    ImGui::SetCursorPosX(ImGui::GetCursorPosX() + ImGui::GetContentRegionAvail().x - ImGui::CalcTextSize(sure).x);
    ImGui::TextDisabled("%s", sure);
    const float width_px = share_of_line_px(5);
    constexpr const char* kDigits[5] = {"1", "2", "3", "4", "5"};
    for (int i = 0; i < 5; ++i) {
        if (i > 0) ImGui::SameLine();
        if (big_button(kDigits[i], "",
                       {width_px, kTarget_mm, may_act(shown) && !shown.trial.marks.empty(), said == i + 1,
                        words::kHintConfidence},
                       gui)) {
            wishes.action = static_cast<platform::Action>(static_cast<int>(platform::Action::confidence_1) + i);
        }
    }
}

void draw_actions(const Shown& shown, const Gui& gui, Wishes& wishes) {
    if (is_interval(shown.doing)) {
        const bool enter = gui.pressed(platform::key::enter) || gui.pressed(platform::key::pad_enter);
        if (big_button(words::kDone, words::kEnter, {0.0f, kMark_mm, true, false}, gui) || enter)
            wishes.action = platform::Action::finish;  // which says so if nothing was touched yet
        return;
    }
    // a participant reads no keys: nothing on the screen should need an explanation
    const bool keys = study_of(shown.doing) == nullptr;
    const std::size_t marks = shown.trial.marks.size();
    const std::string mark =
        (marks == 0 ? words::kMarkFirst : words::filled(words::kMarks, {std::to_string(marks)})) + "###mark";
    const bool may = may_act(shown);
    if (big_button(mark.c_str(), keys ? words::kKeyMark : "",
                   {0.0f, kMark_mm, may && shown.trial.last_px.has_value(), false, words::kHintMark}, gui))
        wishes.action = platform::Action::mark;
    draw_confidence(shown, gui, wishes);
    const float width_px = share_of_line_px(2);
    if (big_button(words::kUndo, keys ? words::kKeyUndo : "",
                   {width_px, kTarget_mm, may && marks > 0, false, words::kHintUndo}, gui))
        wishes.action = platform::Action::undo;
    ImGui::SameLine();
    if (big_button(words::kFinish, keys ? words::kKeyFinish : "",
                   {width_px, kTarget_mm, may, false, keys ? words::kHintFinish : words::kHintFinishStudy}, gui))
        wishes.action = platform::Action::finish;
}

void draw_messages(const Shown& shown, const Gui& gui, Wishes& wishes) {
    const Notices& notices = shown.notices;
    draw_problems(shown, gui, wishes);
    if (shown.state.without_level) {
        warning_paragraph(words::filled(words::kWithoutLevel,
                                        {std::string(name_of(shown.plan.profile.level)), shown.plan.profile.id}));
    }
    if (notices.offer_hold && big_button(words::kPressByHolding, "H", {}, gui)) wishes.press_by_hold = true;
    if (!notices.note.empty()) paragraph(notices.note);
    if (!notices.trials_note.empty()) paragraph(notices.trials_note);
    for (const std::string& note : notices.pressure_notes) warning_paragraph(note);
    // what was to be read before the first press makes room for what comes after it
    if (shown.trial.touched_s && !shown.experimenter) return;
    for (const std::string& note : notices.device_notes) paragraph(note);
    if (study_of(shown.doing) != nullptr) return;  // a participant need not know what the tissue is made of
    if (shown.plan.source == stiffnessmaps::SourceKind::analytic) paragraph(words::kAnalyticTissue);
    if (shown.plan.source == stiffnessmaps::SourceKind::simulated) paragraph(words::kSimulatedTissue);
    if (std::isfinite(shown.state.view.scale) && shown.scene.mapping.kind == scene::MappingKind::direct &&
        std::abs(shown.state.view.scale - 1.0) > 0.005) {
        paragraph(words::filled(words::kShownAt, {fixed(100.0 * shown.state.view.scale, 0)}));
    }
}

void column_panel(const Shown& shown, Gui& gui, ViewState& view, Wishes& wishes) {
    draw_header(shown, gui, view, wishes);
    // the space that the other parts leave, within limits
    const float rest_px = 62.0f * gui.mm() + 3.0f * ImGui::GetFontSize();
    const float bar_px = std::clamp(ImGui::GetContentRegionAvail().y - rest_px, 16.0f * gui.mm(), 55.0f * gui.mm());
    const float left_px = ImGui::GetCursorPosX();
    if (!hides_force(shown)) {
        draw_force_bar(shown, bar_px, gui);
        ImGui::SameLine();
        ImGui::SetCursorPosX(left_px + 26.0f * gui.mm());
        draw_numbers(shown, gui);
    }
    if (!is_interval(shown.doing) || device_leads(shown)) draw_contact_note(shown);
    draw_actions(shown, gui, wishes);
    ImGui::BeginChild("messages", ImVec2(0.0f, 0.0f), false,
                      ImGuiWindowFlags_NavFlattened);  // long messages scroll in the rest of the panel
    draw_messages(shown, gui, wishes);
    ImGui::EndChild();
}

void strip_panel(const Shown& shown, Gui& gui, ViewState& view, Wishes& wishes) {
    const float mm = gui.mm();
    const float right_px = 58.0f * mm;
    const float wide_px = ImGui::GetContentRegionAvail().x;
    const float height_px = ImGui::GetContentRegionAvail().y;
    const float left_px = ImGui::GetCursorPosX();
    const float top_px = ImGui::GetCursorPosY();
    const float gap_px = ImGui::GetStyle().ItemSpacing.x;
    const float left_wide_px = wide_px - right_px - gap_px;
    ImGui::BeginChild("left", ImVec2(left_wide_px, height_px), false, ImGuiWindowFlags_NavFlattened);
    if (!hides_force(shown) && left_wide_px >= 58.0f * mm) {  // else the numbers, which say as much, get the room
        draw_force_bar(shown, std::max(16.0f * mm, height_px - 2.0f * mm), gui);
        ImGui::SameLine();
        ImGui::SetCursorPosX(30.0f * mm);
    }
    ImGui::BeginChild("beside", ImVec2(0.0f, height_px - 2.0f * mm), false,
                      ImGuiWindowFlags_NavFlattened);  // long messages scroll
    if (!hides_force(shown)) draw_numbers(shown, gui);
    if (!is_interval(shown.doing) || device_leads(shown)) draw_contact_note(shown);
    draw_messages(shown, gui, wishes);
    ImGui::EndChild();
    ImGui::EndChild();
    ImGui::SetCursorPos(ImVec2(left_px + wide_px - right_px, top_px));
    ImGui::BeginChild("right", ImVec2(right_px, height_px), false, ImGuiWindowFlags_NavFlattened);
    draw_header(shown, gui, view, wishes);
    draw_actions(shown, gui, wishes);
    if (ImGui::GetScrollMaxY() > 1.0f) gui.note_overflow("actions");
    ImGui::EndChild();
}

// Covers the tissue's part of the window, and says what to do.
void draw_cover(const Shown& shown, const Gui& gui, ImDrawList& draw) {
    const scene::ScreenArea& area = shown.state.screen;
    const ImVec2 low(static_cast<float>(area.x_px), static_cast<float>(area.y_px));
    const ImVec2 high(static_cast<float>(area.x_px + area.width_px), static_cast<float>(area.y_px + area.height_px));
    draw.AddRectFilled(low, high, kDark);
    const char* text = study_of(shown.doing)->interval == 0 ? words::kFeelFirstOn : words::kFeelSecondOn;
    const float wrap_px = std::max(20.0f, high.x - low.x - 8.0f * gui.mm());
    const ImVec2 size = ImGui::CalcTextSize(text, nullptr, false, wrap_px);
    draw.AddText(ImGui::GetFont(), ImGui::GetFontSize(),
                 ImVec2(0.5f * (low.x + high.x - size.x), 0.5f * (low.y + high.y - size.y)), kInk, text, nullptr,
                 wrap_px);
}

ImVec2 at_height(const render::TissueView& view, const Eigen::Vector2d& p_m, float height_m) {
    const glm::vec2 px = render::project_px(view, glm::vec3(p_m.x(), p_m.y(), height_m));
    return {px.x, px.y};
}

void draw_pen(const Shown& shown, const Gui& gui, ImDrawList& draw) {
    if (!shown.state.touch.down) {  // shows where a mark would go
        if (!shown.trial.last_px) return;
        const Eigen::Vector2d p_m = scene::tissue_of_px(shown.state.view, *shown.trial.last_px);
        const ImVec2 at = on_screen(shown.view, p_m.x(), p_m.y());
        draw.AddCircle(at, 2.2f * gui.mm(), kDark, 32, 0.9f * gui.mm());
        dashed_circle(draw, at, 2.2f * gui.mm(), kInk, 0.3f * gui.mm());
        return;
    }
    // beside an avatar that does not lag the pen needs no mark
    const auto lag_m = static_cast<float>(shown.avatar.lag_m.norm());
    const float strength = std::clamp((lag_m - 0.1e-3f) / 0.4e-3f, 0.0f, 1.0f);
    if (!(strength > 0.0f)) return;
    const auto faded = [&](ImU32 colour) {
        const auto alpha = static_cast<ImU32>(255.0f * strength);
        return (colour & ~IM_COL32_A_MASK) | (alpha << IM_COL32_A_SHIFT);
    };
    const Eigen::Vector2d& pen_m = shown.state.touch.p_m;
    // where a pen lies on the glass, its mark stays under it; a tilted tissue is seen from the side, and the pen with it
    const float height_m = shown.view.tilt_rad > 0.0f ? shown.picture.indenter.height_m : 0.0f;
    const ImVec2 pen = at_height(shown.view, pen_m, height_m);
    const ImVec2 avatar = at_height(shown.view, shown.avatar.p_m, height_m);
    draw.AddLine(avatar, pen, faded(kDark), 1.3f * gui.mm());
    draw.AddCircle(pen, 1.6f * gui.mm(), faded(kDark), 24, 1.1f * gui.mm());
    draw.AddLine(avatar, pen, faded(kLag), 0.7f * gui.mm());
    draw.AddCircle(pen, 1.6f * gui.mm(), faded(kLag), 24, 0.6f * gui.mm());
}

}  // namespace

const char* contact_note(const scene::Contact& contact, bool experimenter) {
    if (contact.saturated) return words::kBeyondKnownDepth;
    if (!contact.measured) return words::kNotMeasuredHere;
    if (!experimenter) return "";
    if (contact.inexact) return words::kNotSettled;
    switch (mechanics::linear_range(contact.linearity)) {
        case mechanics::LinearRange::red:
            return words::kBeyondLinear;
        case mechanics::LinearRange::amber:
            return words::kLeavingLinear;
        default:
            return "";
    }
}

void draw_on_tissue(const Shown& shown, const Gui& gui) {
    ImDrawList& draw = *ImGui::GetBackgroundDrawList();
    if (hides_tissue(shown)) return draw_cover(shown, gui, draw);
    std::vector<PanelArea> names;
    if (shown.trial.mode == session::TrialMode::practice) {
        for (const stiffnessmaps::Nodule& nodule : shown.plan.nodules) {
            const auto px = [&](double x_m, double y_m) { return on_surface(shown.picture, x_m, y_m); };
            const float right_px = draw_outline(outline_of(nodule), px, {0.45f * gui.mm(), 0.5f * gui.mm()}, draw);
            names.push_back(
                plated_text(draw, ImVec2(right_px + gui.mm(), px(nodule.x_m, nodule.y_m).y), kInk, nodule.id));
        }
    }
    std::vector<Label> labels;
    for (std::size_t i = 0; i < shown.trial.marks.size(); ++i) {
        const session::Mark& mark = shown.trial.marks[i];
        const ImVec2 at = on_surface(shown.picture, mark.p_m.x(), mark.p_m.y());
        cross(draw, at, 1.6f * gui.mm(), kDark, 1.7f * gui.mm());
        cross(draw, at, 1.6f * gui.mm(), kInk, 0.6f * gui.mm());
        const std::string sure = mark.confidence > 0 ? " (" + std::to_string(mark.confidence) + ")" : "";
        labels.push_back({at, std::to_string(i + 1) + sure});
    }
    place_labels(labels, names, static_cast<float>(shown.state.screen.x_px), gui.mm(), draw);
    draw_pen(shown, gui, draw);
    draw_side_view(shown, gui);
    draw_pins_inset(shown, gui);
}

void draw_problems(const Shown& shown, const Gui& gui, Wishes& wishes) {
    const Notices& notices = shown.notices;
    const auto count = static_cast<int>(notices.problems.size());
    const int before = std::exchange(*ImGui::GetStateStorage()->GetIntRef(ImGui::GetID("problems")), count);
    if (count == 0) {
        if (notices.trial_stopped) warning_paragraph(words::kTrialStopped);
        return;
    }
    const ImVec2 from = ImGui::GetCursorScreenPos();
    for (const std::string& problem : notices.problems) warning_paragraph(problem);
    const bool seen = ImGui::IsRectVisible(from, ImVec2(from.x + 1.0f, ImGui::GetCursorScreenPos().y));
    const bool* menu = menu_of(shown.doing);
    const bool by_key = seen && gui.pressed(platform::key::escape) && !(menu != nullptr && *menu);
    if (big_button(words::kDismiss, words::kEscape, {}, gui) || by_key) wishes.understood = true;
    if (count > before) ImGui::SetScrollHereY(1.0f);  // below what fits, a new problem is scrolled to, once
}

void draw_trial_panel(const Shown& shown, const Layout& layout, Gui& gui, ViewState& view, Wishes& wishes) {
    if (!layout.controls) {
        draw_too_small();
        return;
    }
    begin_panel("trial", layout.controls_px, gui);
    if (layout.column) {
        column_panel(shown, gui, view, wishes);
    } else {
        strip_panel(shown, gui, view, wishes);
    }
    end_panel("trial", gui);
}

void draw_progress(const std::string& what, double share) {
    const ImVec2 screen = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(0.5f * screen.x, 0.5f * screen.y), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    ImGui::SetNextWindowSize(ImVec2(std::min(0.8f * screen.x, 30.0f * ImGui::GetFontSize()), 0.0f));
    ImGui::Begin("progress", nullptr, ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoSavedSettings);
    paragraph(words::filled(what, {fixed(100.0 * share, 0)}));
    ImGui::ProgressBar(static_cast<float>(share), ImVec2(-1.0f, 0.0f), "");
    ImGui::End();
}

}  // namespace palpa::app
