// Carries out what the person asked for on the screens.

#include <cmath>
#include <string>

#include "app/live/live_app.h"
#include "app/screens/history_screen.h"
#include "app/screens/settings.h"

namespace palpa::app {
namespace {

void change_settings(const Wishes& wishes, platform::Window& window, Gui& gui, App& app) {
    if (wishes.left_handed) app.settings.left_handed = *wishes.left_handed;
    if (wishes.above_finger) app.settings.above_finger = *wishes.above_finger;
    if (wishes.side_view) app.settings.side_view = *wishes.side_view;
    if (wishes.mode) app.settings.test_mode = *wishes.mode == session::TrialMode::test;
    if (wishes.full_screen) {
        app.settings.full_screen = !window.full_screen();
        window.set_full_screen(app.settings.full_screen);
    }
    if (wishes.px_per_mm) {
        app.notices.px_per_mm = *wishes.px_per_mm;
        app.settings.px_per_mm.erase(app.notices.screen_name);
        if (std::isfinite(*wishes.px_per_mm)) app.settings.px_per_mm[app.notices.screen_name] = *wishes.px_per_mm;
    }
    if (wishes.keep_results) app.settings.keep_results = *wishes.keep_results;
    if (wishes.text_percent) app.settings.text_percent = *wishes.text_percent;
    const bool changed = wishes.keep_results || wishes.text_percent || wishes.left_handed || wishes.above_finger ||
                         wishes.side_view || wishes.mode || wishes.full_screen || wishes.px_per_mm || wishes.scene ||
                         wishes.profile;
    if (changed) keep_settings(app);
    // a trial has one scale and one way of showing the tissue, so a change begins another trial
    if (!wishes.px_per_mm && !wishes.mode && !wishes.above_finger) return;
    if (app.settings.test_mode) turn_if_shown(window, app);
    begin_anew(window, gui, app);
}

void delete_results(App& app) {
    if (!app.view.history) return;
    attempt(app, [&] { session::delete_history(app.view.history->files); });
    app.view.history = make_history_view(app.history_folder);
}

void press_by_hold(App& app) {
    const auto lacks = [&](platform::Tool tool) {
        const platform::PressureKind kind = platform::pressure_kind(app.pressure, tool);
        return kind == platform::PressureKind::constant || kind == platform::PressureKind::missing;
    };
    app.hold.pen = app.hold.pen || lacks(platform::Tool::pen);
    app.hold.finger = app.hold.finger || lacks(platform::Tool::finger);
}

// A replay gives the recorded trial: another one, or another tissue, would log the rest of the trace as a trial of its own.
void stay_with_trace(Wishes& wishes) {
    wishes.again = wishes.next = false;
    wishes.scene.reset();
    wishes.profile.reset();
    wishes.mode.reset();
    wishes.guided.reset();
}

}  // namespace

void keep_settings(App& app) {
    if (app.settings_path.empty()) return;
    const std::string problem = save_settings(app.settings, app.kept_settings, app.settings_path);
    if (problem.empty()) app.kept_settings = app.settings;
    if (!problem.empty()) app.notices.problems.push_back(problem);
    if (app.keeper != nullptr) app.keeper->keep_settings(app.settings_path);
}

void carry_out(const Wishes& asked_for, platform::Window& window, Gui& gui, App& app) {
    if (asked_for.sure || asked_for.stay) app.asked.reset();
    Wishes wishes = asked_for;
    if (work_at_stake(app)) {
        wishes = ask_first(asked_for, app.asked);
        if (app.asked) end_presses(window, app);
    } else {
        app.asked.reset();
    }
    if (app.trace) stay_with_trace(wishes);
    if (wishes.quit) app.quit = true;
    const StudyRun* study = study_of(app.doing);
    const bool waits = study != nullptr && study->keeping_since_s;  // the problem is why, and says what can be done
    if (wishes.understood && !waits) app.notices.problems.clear();
    if (asked_for.stop_devices) stop_devices(app);
    if (wishes.release_devices) release_devices(app);
    if (study_of(app.doing) != nullptr) follow_study(wishes.study, window, gui, app);
    if (wishes.action && palpates(app.doing) && !app.trace) act(*wishes.action, window, app);
    if (bool* menu = menu_of(app.doing); menu != nullptr && wishes.menu) *menu = *wishes.menu;
    if (wishes.part && palpates(app.doing)) change_part(*wishes.part, window, gui, app);
    if (wishes.screen) open_screen(*wishes.screen, window, app);
    const bool another_way = wishes.again || wishes.next || wishes.scene || wishes.profile || wishes.mode;
    const bool quits_at_its_end = wishes.quit && app.session.trial.finished;
    if (app.guided && (another_way || quits_at_its_end)) {
        app.guided = false;  // whoever goes on by another way need not begin with it again
        app.settings.guided_done = true;
        keep_settings(app);
    }
    if (wishes.scene || wishes.profile) {
        const std::string scene = wishes.scene.value_or(app.session.scene.file.string());
        const std::string profile = wishes.profile.value_or(app.settings.profile);
        // what fails is not chosen, and not tried at the next start
        if (change_scene(window, gui, scene, profile, app)) {
            if (wishes.scene) app.settings.scene = scene;
            app.settings.profile = profile;
        }
    }
    change_settings(wishes, window, gui, app);
    if (wishes.press_by_hold && app.notices.offer_hold) press_by_hold(app);
    if (wishes.trials && app.keeper != nullptr) app.keeper->open();
    if (wishes.studies && app.keeper != nullptr) app.keeper->open_studies();
    if (wishes.delete_results && !app.history_folder.empty()) delete_results(app);
    if (wishes.guided && study_of(app.doing) == nullptr) {
        if (*wishes.guided)
            begin_guided(window, gui, app);
        else
            leave_guided(window, gui, app);
    }
    const bool turns = wishes.next || (wishes.again && app.session.scene.mapping.random_turn);
    if (turns) turn_tissue(window, app);
    if (wishes.again || wishes.next) begin_anew(window, gui, app);
    app.save_waits = app.save_waits || wishes.save_picture;
}

}  // namespace palpa::app
