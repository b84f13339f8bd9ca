// The menu over the tissue, the cost table, and the keys.

#include <algorithm>

#include "app/screens/map_screen.h"
#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"

namespace palpa::app {
namespace {

PanelArea menu_area(const Layout& layout, float mm) {
    const PanelArea& t = layout.tissue_px;
    PanelArea area = t;
    area.x1 = std::min(t.x1, t.x0 + 150.0f * mm);
    if (layout.column) area.y1 = std::max(t.y1, layout.controls_px.y1);
    return area;
}

void choices(const char* title, const std::vector<Choice>& list, const std::string& chosen, float height_px,
             const Gui& gui, std::optional<std::string>& wish) {
    ImGui::TextDisabled("%s", title);
    ImGui::BeginChild(title, ImVec2(0.0f, height_px), false, ImGuiWindowFlags_NavFlattened);
    for (const Choice& choice : list) {
        ImGui::PushID(choice.file.c_str());
        ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(0.0f, 0.5f));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(1.5f * gui.mm(), 0.0f));
        if (big_button(choice.name.c_str(), "", {0.0f, kTarget_mm, true, choice.file == chosen}, gui))
            wish = choice.file;
        if (choice.file == chosen) ImGui::SetItemDefaultFocus();  // where arrow keys start
        ImGui::PopStyleVar(2);
        ImGui::PopID();
    }
    ImGui::EndChild();
}

void pair_of_ways(const char* left, const char* right, const Gui& gui, bool& chose_left, bool& chose_right) {
    const float width_px = share_of_line_px(2);
    chose_left = big_button(left, "", {width_px, kTarget_mm, true, false}, gui);
    ImGui::SameLine();
    chose_right = big_button(right, "", {width_px, kTarget_mm, true, false}, gui);
}

void pair(const char* left, const char* right, bool right_chosen, const Gui& gui, bool& chose_left, bool& chose_right) {
    const float width_px = share_of_line_px(2);
    chose_left = big_button(left, "", {width_px, kTarget_mm, true, !right_chosen}, gui);
    ImGui::SameLine();
    chose_right = big_button(right, "", {width_px, kTarget_mm, true, right_chosen}, gui);
}

void right_side(const Shown& shown, const Gui& gui, ViewState& view, Wishes& wishes) {
    bool left = false;
    bool right = false;
    ImGui::TextDisabled(words::kTrial);
    pair(words::kPractice, words::kTest, shown.trial.mode == session::TrialMode::test, gui, left, right);
    if (left) wishes.mode = session::TrialMode::practice;
    if (right) wishes.mode = session::TrialMode::test;
    if (big_button(words::kBeginAnew, "R", {}, gui)) wishes.again = true;
    ImGui::TextDisabled(words::kDrawingHand);
    pair(words::kLeft, words::kRight, !shown.settings.left_handed, gui, left, right);
    if (left) wishes.left_handed = true;
    if (right) wishes.left_handed = false;
    ImGui::TextDisabled(words::kAvatarOfFinger);
    pair(words::kUnderIt, words::kAboveIt, shown.settings.above_finger, gui, left, right);
    if (left) wishes.above_finger = false;
    if (right) wishes.above_finger = true;
    if (shown.scene.cues.side_view &&
        big_button(words::kSideView, "V", {0.0f, kTarget_mm, true, shown.settings.side_view}, gui))
        wishes.side_view = !shown.settings.side_view;
    if (shown.notices.keeps_trials) {
        ImGui::TextDisabled(words::kOnThisTablet);
        left = right = false;
        pair_of_ways(words::kTrials, words::kStudies, gui, left, right);
        wishes.trials = wishes.trials || left;
        wishes.studies = wishes.studies || right;
    }
    ImGui::TextDisabled(words::kScreenAndDevices);
    if (big_button(words::kSizeOfScreen, "Z", {}, gui)) wishes.screen = Screen::scale;
    if (big_button(words::kDeviceCheck, "D", {}, gui)) wishes.screen = Screen::devices;
    if (big_button(words::kCalibratePressure, "P", {}, gui)) wishes.screen = Screen::calibrate;
    if (big_button(words::kMaps, "B", {0.0f, kTarget_mm, may_show_maps(shown.trial), false}, gui))
        wishes.screen = Screen::maps;
    if (big_button(words::kCost, "C", {0.0f, kTarget_mm, true, view.cost}, gui)) view.cost = !view.cost;
    if (big_button(words::kFullScreen, "F11", {0.0f, kTarget_mm, true, shown.settings.full_screen}, gui))
        wishes.full_screen = true;
    if (!shown.notices.keeps_trials && big_button(words::kQuit, words::kCtrlQ, {}, gui)) wishes.quit = true;
}

void stage_rows(const Shown& shown, const std::vector<scene::Stage>& stages) {
    for (const scene::Stage& stage : stages) {
        const scene::Meter& meter = shown.state.meters[static_cast<std::size_t>(stage.id)];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name_of(stage.id));
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", stage.fidelity.c_str());
        ImGui::TableNextColumn();
        ImGui::TextWrapped("%s", stage.error.c_str());
        ImGui::TableNextColumn();
        ImGui::Text("%.2f", 1e-3 * meter.quantile_ns(0.5));
        ImGui::TableNextColumn();
        ImGui::Text("%.2f", 1e-3 * meter.quantile_ns(0.99));
        ImGui::TableNextColumn();
        ImGui::Text("%lld", static_cast<long long>(meter.calls()));
    }
}

std::string frame_text(const Shown& shown) {
    const FrameTimes& t = shown.times;
    const scene::Counters& counters = shown.state.counters;
    const auto ms = [](const scene::Meter& meter, double q) { return 1e-6 * meter.quantile_ns(q); };
    return words::filled(
        words::kFrameTimes,
        {fixed(ms(t.latency, 0.5), 1), fixed(ms(t.latency, 0.99), 1), fixed(ms(t.ready, 0.5), 1),
         fixed(ms(t.cpu, 0.5), 2), fixed(ms(t.cpu, 0.99), 2), fixed(ms(t.gl, 0.5), 1), fixed(t.frames_per_s, 0),
         std::to_string(counters.samples), std::to_string(counters.dropped_steps),
         std::to_string(counters.skipped_stations + counters.skipped_slides)});
}

void trial_keys(const Shown& shown, const Gui& gui, Wishes& wishes) {
    if (gui.pressed('m') && shown.trial.last_px) wishes.action = platform::Action::mark;
    if (gui.pressed('u') || gui.pressed('z', true) || gui.pressed(platform::key::backspace))
        wishes.action = platform::Action::undo;
    if (gui.pressed('f')) wishes.action = platform::Action::finish;
    if (gui.pressed('h')) wishes.press_by_hold = true;
    for (int i = 0; i < 5; ++i) {
        if (gui.pressed('1' + i) || gui.pressed(platform::key::pad_0 + 1 + i)) {
            wishes.action = static_cast<platform::Action>(static_cast<int>(platform::Action::confidence_1) + i);
        }
    }
}

// Opens and closes the menu. From a screen without one, Escape leads back to the trial.
void menu_keys(const Shown& shown, const Gui& gui, Wishes& wishes) {
    const bool* menu = menu_of(shown.doing);
    if (menu == nullptr) {
        if (gui.pressed(platform::key::escape)) wishes.screen = Screen::trial;
        return;
    }
    const bool by_tab = gui.pressed(platform::key::tab) && !*menu && palpates(shown.doing);
    if (gui.pressed(platform::key::f10) || by_tab) wishes.menu = !*menu;
    if (gui.pressed(platform::key::escape)) wishes.menu = false;
}

}  // namespace

void draw_menu(const Shown& shown, const Layout& layout, Gui& gui, ViewState& view, Wishes& wishes) {
    const PanelArea area = menu_area(layout, gui.mm());
    begin_panel("menu", area, gui);
    if (ImGui::IsWindowAppearing()) ImGui::SetWindowFocus();
    const bool two_columns = area.width() >= 110.0f * gui.mm();
    const float half_px = two_columns ? 1.15f * share_of_line_px(2) : 0.0f;
    const float height_px = two_columns ? ImGui::GetContentRegionAvail().y : 0.5f * ImGui::GetContentRegionAvail().y;
    ImGui::BeginChild("what", ImVec2(half_px, height_px), false, ImGuiWindowFlags_NavFlattened);
    const float line_px = ImGui::GetFontSize() + 2.0f * ImGui::GetStyle().ItemSpacing.y;
    const float list_px = ImGui::GetContentRegionAvail().y - 2.0f * line_px;
    choices(words::kScene, shown.notices.scenes, shown.scene.file.string(), 0.62f * list_px, gui, wishes.scene);
    choices(words::kPressureProfile, shown.notices.profiles, shown.scene.profile.string(), 0.36f * list_px, gui,
            wishes.profile);
    ImGui::EndChild();
    if (two_columns) ImGui::SameLine();
    ImGui::BeginChild("how", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
    right_side(shown, gui, view, wishes);
    ImGui::EndChild();
    end_panel("menu", gui);
}

void draw_cost(const Shown& shown, const Layout& layout, Gui& gui) {
    const PanelArea& t = layout.tissue_px;
    const float height_px = std::min(0.55f * t.height(), 80.0f * gui.mm());
    begin_panel("cost", {t.x0, t.y1 - height_px, t.x1, t.y1}, gui, 0.9f);
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_ScrollY;
    const std::string text = frame_text(shown);
    const ImVec2 text_size = ImGui::CalcTextSize(text.c_str(), nullptr, false, ImGui::GetContentRegionAvail().x);
    const float text_px = text_size.y + 2.0f * ImGui::GetStyle().ItemSpacing.y;
    if (ImGui::BeginTable("stages", 6, kFlags, ImVec2(0.0f, ImGui::GetContentRegionAvail().y - text_px))) {
        ImGui::TableSetupScrollFreeze(0, 1);
        constexpr const char* kColumns[] = {words::kStage,        words::kFidelity,       words::kError,
                                            words::kMicroseconds, words::kMicroseconds99, words::kCalls};
        constexpr float kWidths[] = {1.9f, 4.0f, 4.0f, 0.8f, 1.1f, 1.0f};
        for (int i = 0; i < 6; ++i)
            ImGui::TableSetupColumn(kColumns[i], ImGuiTableColumnFlags_WidthStretch, kWidths[i]);
        ImGui::TableHeadersRow();
        stage_rows(shown, shown.plan.sample_stages);
        stage_rows(shown, shown.plan.frame_stages);
        ImGui::EndTable();
    }
    ImGui::TextWrapped("%s", text.c_str());
    end_panel("cost", gui);
}

void age_note(double now_s, Notices& notices) {
    constexpr double kShown_s = 8.0;  // long enough to read two lines twice
    if (notices.note != notices.note_seen) {
        notices.note_seen = notices.note;
        notices.note_since_s = now_s;
    }
    if (now_s - notices.note_since_s > kShown_s) notices.note.clear();
}

void take_keys(const Shown& shown, const Gui& gui, ViewState& view, Wishes& wishes) {
    if (gui.pressed('q', true) && !shown.notices.keeps_trials) wishes.quit = true;
    if (gui.pressed(platform::key::f11)) wishes.full_screen = true;
    if (gui.pressed(platform::key::escape)) wishes.understood = true;
    if (palpates(shown.doing)) trial_keys(shown, gui, wishes);
    // in a study the other keys would change what the protocol fixes, or reveal what it hides
    if (study_of(shown.doing) != nullptr) return;
    if (gui.pressed('t')) wishes.trials = true;
    if (gui.pressed('y')) wishes.studies = true;
    menu_keys(shown, gui, wishes);
    if (gui.pressed('v')) wishes.side_view = !shown.settings.side_view;
    if (gui.pressed('c')) view.cost = !view.cost;
    if (gui.pressed('d')) wishes.screen = Screen::devices;
    if (gui.pressed('z')) wishes.screen = Screen::scale;
    if (gui.pressed('p')) wishes.screen = Screen::calibrate;
    if (gui.pressed('b')) wishes.screen = Screen::maps;
    if (gui.pressed('r')) wishes.again = true;
    if (gui.pressed('s', true)) wishes.save_picture = true;
    if (!std::holds_alternative<Reviewing>(shown.doing)) return;
    if (gui.pressed('n')) wishes.next = true;
    if (gui.pressed('s')) wishes.save_picture = true;
}

}  // namespace palpa::app
