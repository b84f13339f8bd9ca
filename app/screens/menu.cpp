// The menu over the tissue, the cost table, and the keys.

#include <algorithm>

#include "app/assets.h"
#include "app/screens/map_screen.h"
#include "app/screens/part_screen.h"
#include "app/screens/screens.h"
#include "app/screens/widgets.h"
#include "app/screens/words.h"
#include "scene/tissue.h"

namespace palpa::app {
namespace {

// The scene that the screen of parts begins with.
std::string parts_scene() { return (assets_folder() / "scenes" / "toothbrush.json").string(); }

// As high as its pages need; the rest of the tissue stays in view.
PanelArea menu_area(const Layout& layout, float mm) {
    const PanelArea& t = layout.tissue_px;
    PanelArea area = t;
    area.x1 = std::min(t.x1, t.x0 + 150.0f * mm);
    const float lowest = layout.column ? std::max(t.y1, layout.controls_px.y1) : t.y1;
    area.y1 = std::min(lowest, t.y0 + 128.0f * mm);
    return area;
}

void choices(const char* title, const std::vector<Choice>& list, const std::string& chosen, const Gui& gui,
             std::optional<std::string>& wish) {
    ImGui::TextDisabled("%s", title);
    ImGui::BeginChild(title, ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
    for (const Choice& choice : list) {
        ImGui::PushID(choice.file.c_str());
        ImGui::PushStyleVar(ImGuiStyleVar_ButtonTextAlign, ImVec2(0.0f, 0.5f));
        ImGui::PushStyleVar(ImGuiStyleVar_FramePadding, ImVec2(1.5f * gui.mm(), 0.0f));
        const bool wide =
            ImGui::CalcTextSize(choice.name.c_str()).x > ImGui::GetContentRegionAvail().x - 3.0f * gui.mm();
        if (big_button(choice.name.c_str(), "",
                       {0.0f, kTarget_mm, true, choice.file == chosen, wide ? choice.name.c_str() : ""}, gui))
            wish = choice.file;
        if (choice.file == chosen) ImGui::SetItemDefaultFocus();  // where arrow keys start
        ImGui::PopStyleVar(2);
        ImGui::PopID();
    }
    scroll_by_drag(gui);
    ImGui::EndChild();
}

struct Way {
    const char* label;
    bool chosen = false;
    const char* hint = "";
};

// Draws alternatives side by side under a title. Returns the index of the one that is pressed, -1 if none is.
int ways(const char* title, std::initializer_list<Way> all, const Gui& gui) {
    ImGui::TextDisabled("%s", title);
    ImGui::PushID(title);
    const float width_px = share_of_line_px(static_cast<int>(all.size()));
    int pressed = -1;
    int i = 0;
    for (const Way& way : all) {
        if (i > 0) ImGui::SameLine();
        if (big_button(way.label, "", {width_px, kTarget_mm, true, way.chosen, way.hint}, gui)) pressed = i;
        ++i;
    }
    ImGui::PopID();
    return pressed;
}

void trial_page(const Shown& shown, const Gui& gui, Wishes& wishes) {
    const bool test = shown.trial.mode == session::TrialMode::test;
    const int mode = ways(
        words::kMode, {{words::kPractice, !test, words::kHintPractice}, {words::kTest, test, words::kHintTest}}, gui);
    if (mode >= 0) wishes.mode = mode == 0 ? session::TrialMode::practice : session::TrialMode::test;
    if (big_button(words::kRestartTrial, words::kKeyAgain, {0.0f, kTarget_mm, true, false, words::kHintRestart}, gui))
        wishes.again = true;
    if (big_button(words::kGuidedStart, "", {}, gui)) wishes.guided = true;
    if (!shown.notices.keeps_trials &&
        big_button(words::kHistory, words::kKeyHistory,
                   {0.0f, kTarget_mm, may_show_maps(shown.plan, shown.trial), false}, gui))
        wishes.screen = Screen::history;
    if (shown.notices.keeps_trials) {
        const int where = ways(words::kOnThisTablet, {{words::kTrials}, {words::kStudies}}, gui);
        wishes.trials = wishes.trials || where == 0;
        wishes.studies = wishes.studies || where == 1;
    }
    if (!shown.notices.keeps_trials && big_button(words::kQuit, words::kCtrlQ, {}, gui)) wishes.quit = true;
}

void settings_page(const Shown& shown, const Gui& gui, Wishes& wishes) {
    const Settings& s = shown.settings;
    const int hand = ways(words::kDominantHand, {{words::kLeft, s.left_handed}, {words::kRight, !s.left_handed}}, gui);
    if (hand >= 0) wishes.left_handed = hand == 0;
    const int finger = ways(words::kContactOfFinger,
                            {{words::kUnderFinger, !s.above_finger}, {words::kAboveFinger, s.above_finger}}, gui);
    if (finger >= 0) wishes.above_finger = finger == 1;
    if (shown.scene.cues.side_view) {
        const int side = ways(words::kSideView, {{words::kShown, s.side_view}, {words::kHidden, !s.side_view}}, gui);
        if (side >= 0) wishes.side_view = side == 0;
    }
    const int size = ways(words::kTextSize,
                          {{"100 %", s.text_percent == kTextPercents[0]},
                           {"120 %", s.text_percent == kTextPercents[1]},
                           {"140 %", s.text_percent == kTextPercents[2]}},
                          gui);
    if (size >= 0) wishes.text_percent = kTextPercents[size];
    if (!shown.notices.keeps_trials) {
        const int keep =
            ways(words::kKeepResults, {{words::kKept, s.keep_results}, {words::kNotKept, !s.keep_results}}, gui);
        if (keep >= 0) wishes.keep_results = keep == 0;
    }
    if (big_button(words::kScreenScale, words::kKeyScale, {0.0f, kTarget_mm, true, false, words::kHintScale}, gui))
        wishes.screen = Screen::scale;
    if (big_button(words::kFullScreen, "F11", {0.0f, kTarget_mm, true, s.full_screen}, gui)) wishes.full_screen = true;
}

void experimenter_page(const Shown& shown, const Gui& gui, ViewState& view, Wishes& wishes) {
    ImGui::TextDisabled(words::kDisplayAndInput);
    if (big_button(words::kDeviceCheck, words::kKeyDevices, {0.0f, kTarget_mm, true, false, words::kHintDevices}, gui))
        wishes.screen = Screen::devices;
    if (big_button(words::kCalibratePressure, "", {}, gui)) wishes.screen = Screen::calibrate;
    if (big_button(words::kMaps, words::kKeyMaps, {0.0f, kTarget_mm, may_show_maps(shown.plan, shown.trial), false},
                   gui))
        wishes.screen = Screen::maps;
    const bool devices = shown.tactile != nullptr;
    if (!shown.notices.keeps_trials &&
        big_button(words::kTactile, words::kKeyTactile, {0.0f, kTarget_mm, devices, false, words::kHintTactile}, gui))
        wishes.screen = Screen::tactile;
    const bool soft = shown.tangible != nullptr;
    if (!shown.notices.keeps_trials &&
        big_button(words::kTangible, words::kKeyTangible, {0.0f, kTarget_mm, soft, false, words::kHintTangible}, gui))
        wishes.screen = Screen::tangible;
    if (big_button(words::kParts, words::kKeyParts, {0.0f, kTarget_mm, true, shows_parts(shown), words::kHintParts},
                   gui)) {
        if (!shows_parts(shown)) wishes.scene = parts_scene();
    }
    if (big_button(words::kPerformance, words::kKeyCost, {0.0f, kTarget_mm, true, view.cost, words::kHintPerformance},
                   gui))
        view.cost = !view.cost;
}

void page_tabs(const Gui& gui, MenuPage& page) {
    constexpr const char* kPages[] = {words::kTrial, words::kPageSettings, words::kPageExperimenter};
    const float width_px = share_of_line_px(3);
    for (int i = 0; i < 3; ++i) {
        if (i > 0) ImGui::SameLine();
        ImGui::PushID(i);
        const auto each = static_cast<MenuPage>(i);
        if (big_button(kPages[i], "", {width_px, kTarget_mm, true, page == each}, gui)) page = each;
        ImGui::PopID();
    }
    ImGui::Separator();
}

// The stage as it is now: parts may have been changed to another method.
scene::Stage as_computed_now(const Shown& shown, const scene::Stage& planned) {
    const scene::PartTissue* parts = scene::parts_of(shown.plan.tissue);
    if (parts == nullptr || planned.id != scene::StageId::depth) return planned;
    return scene::depth_stage(*parts, scene::part_work_of(shown.state.tissue)->method);
}

void stage_rows(const Shown& shown, const std::vector<scene::Stage>& stages) {
    for (const scene::Stage& planned : stages) {
        const scene::Stage stage = as_computed_now(shown, planned);
        const scene::Meter& meter = shown.state.meters[static_cast<std::size_t>(stage.id)];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(name_of(stage.id));
        hint_for_last(stage.fidelity.c_str());
        ImGui::TableNextColumn();
        wrapped_text(stage.error);
        ImGui::TableNextColumn();
        const auto us = [&](double q) { return meter.timed() > 0 ? fixed(1e-3 * meter.quantile_ns(q), 2) : "-"; };
        ImGui::TextUnformatted(us(0.5).c_str());
        ImGui::TableNextColumn();
        ImGui::TextUnformatted(us(0.99).c_str());
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
         std::to_string(counters.skipped_stations + counters.skipped_slides), std::to_string(counters.inexact)});
}

void trial_keys(const Shown& shown, const Gui& gui, Wishes& wishes) {
    if (gui.pressed('m') && shown.trial.last_px) wishes.action = platform::Action::mark;
    if (gui.pressed('u') || gui.pressed('z', true) || gui.pressed(platform::key::backspace))
        wishes.action = platform::Action::undo;
    if (gui.pressed('f')) wishes.action = platform::Action::finish;
    if (gui.pressed('h')) wishes.press_by_hold = true;
    if (gui.pressed('p') && study_of(shown.doing) == nullptr)
        wishes.action = shown.trial.paused_at_s ? platform::Action::resume : platform::Action::pause;
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
    page_tabs(gui, view.menu_page);
    const bool lists = view.menu_page != MenuPage::settings;
    const bool two_columns = area.width() >= 110.0f * gui.mm();
    const float rest_px = ImGui::GetContentRegionAvail().y;
    if (lists) {
        ImGui::BeginChild(
            "what", ImVec2(two_columns ? 1.15f * share_of_line_px(2) : 0.0f, two_columns ? rest_px : 0.5f * rest_px),
            false, ImGuiWindowFlags_NavFlattened);
        if (view.menu_page == MenuPage::trial) {
            choices(words::kScene, shown.notices.scenes, shown.scene.file.string(), gui, wishes.scene);
        } else {
            choices(words::kCalibrationProfile, shown.notices.profiles, shown.scene.profile.string(), gui,
                    wishes.profile);
        }
        ImGui::EndChild();
        if (two_columns) ImGui::SameLine();
    }
    ImGui::BeginChild("how", ImVec2(0.0f, 0.0f), false, ImGuiWindowFlags_NavFlattened);
    if (view.menu_page == MenuPage::trial) trial_page(shown, gui, wishes);
    if (view.menu_page == MenuPage::settings) settings_page(shown, gui, wishes);
    if (view.menu_page == MenuPage::experimenter) experimenter_page(shown, gui, view, wishes);
    scroll_by_drag(gui);
    ImGui::EndChild();
    end_panel("menu", gui);
}

void draw_cost(const Shown& shown, const Layout& layout, Gui& gui) {
    const PanelArea& t = layout.tissue_px;
    const float height_px = std::min(0.32f * t.height(), 80.0f * gui.mm());
    begin_panel("cost", {t.x0, t.y1 - height_px, t.x1, t.y1}, gui, 0.9f);
    constexpr ImGuiTableFlags kFlags =
        ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingStretchProp | ImGuiTableFlags_ScrollY;
    const std::string text = frame_text(shown);
    const std::string lines = broken_at_spaces(text, ImGui::GetContentRegionAvail().x);
    const float text_px = ImGui::CalcTextSize(lines.c_str()).y + 2.0f * ImGui::GetStyle().ItemSpacing.y;
    if (ImGui::BeginTable("stages", 5, kFlags, ImVec2(0.0f, ImGui::GetContentRegionAvail().y - text_px))) {
        ImGui::TableSetupScrollFreeze(0, 1);
        constexpr const char* kColumns[] = {words::kStage, words::kError, words::kMicroseconds, words::kMicroseconds99,
                                            words::kCalls};
        constexpr float kWidths[] = {2.2f, 5.0f, 1.6f, 1.4f, 1.2f};
        for (int i = 0; i < 5; ++i)
            ImGui::TableSetupColumn(kColumns[i], ImGuiTableColumnFlags_WidthStretch, kWidths[i]);
        ImGui::TableHeadersRow();
        stage_rows(shown, shown.plan.sample_stages);
        stage_rows(shown, shown.plan.frame_stages);
        ImGui::EndTable();
    }
    wrapped_text(text);
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
    const bool help = gui.pressed(platform::key::f1) || gui.pressed('?') || gui.pressed('/');
    if (view.help) {  // the keys only act on what can be seen
        if (help || gui.pressed(platform::key::escape)) view.help = false;
        return;
    }
    const bool parts = shows_parts(shown) && study_of(shown.doing) == nullptr;
    if (palpates(shown.doing) && parts) part_keys(shown, gui, view.part, wishes);
    if (palpates(shown.doing) && !parts) trial_keys(shown, gui, wishes);
    // in a study the other keys would change what the protocol fixes, or reveal what it hides
    if (study_of(shown.doing) != nullptr) return;
    if (help) view.help = true;
    if (gui.pressed('t')) {
        wishes.trials = true;  // in the browser
        if (!shown.notices.keeps_trials) wishes.screen = Screen::tactile;
    }
    if (gui.pressed('g') && !shown.notices.keeps_trials) wishes.screen = Screen::tangible;
    if (gui.pressed('y') && shown.notices.keeps_trials) wishes.studies = true;
    menu_keys(shown, gui, wishes);
    if (gui.pressed('e') && !parts) wishes.scene = parts_scene();  // there it would throw the edits away
    if (gui.pressed('x') && shown.scene.cues.side_view) wishes.side_view = !shown.settings.side_view;
    if (gui.pressed('c')) view.cost = !view.cost;
    if (gui.pressed('d')) wishes.screen = Screen::devices;
    if (gui.pressed('z')) wishes.screen = Screen::scale;
    if (gui.pressed('v') && !shown.notices.keeps_trials) wishes.screen = Screen::history;
    if (gui.pressed('b')) wishes.screen = Screen::maps;
    if (gui.pressed('r')) wishes.again = true;
    if (gui.pressed('s', true)) wishes.save_picture = true;
    if (!std::holds_alternative<Reviewing>(shown.doing)) return;
    if (gui.pressed('n')) wishes.next = true;
    if (gui.pressed('s')) wishes.save_picture = true;
}

}  // namespace palpa::app
