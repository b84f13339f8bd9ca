// Prepares what the app starts with: options, settings, and the first scene.

#include <cmath>
#include <filesystem>
#include <utility>

#include "app/live/live_app.h"
#include "app/scene_choices.h"
#include "app/screens/words.h"
#include "calibration/profile_file.h"
#include "session/replay.h"

namespace palpa::app {
namespace {

// A chosen profile that is gone, or cannot be read any more, is told of: another one answers in its place.
void take_chosen_profile(App& app, scene::Scene& scene) {
    std::string& profile = app.settings.profile;
    if (profile.empty()) return;
    const bool there = std::filesystem::exists(profile);
    if (!there) app.notices.problems.push_back(words::filled(words::kProfileGone, {profile}));
    if (there && attempt(app, [&] { calibration::read_profile(profile); })) {
        scene.profile = profile;
        return;
    }
    profile.clear();
}

// A scene that is named on the command line keeps its profile, so that the run is the same for everybody.
void tell_of_own_profile(const scene::Scene& scene, App& app) {
    const std::filesystem::path chosen = app.settings.profile;
    if (chosen.empty() || chosen == scene.profile || !std::filesystem::exists(chosen)) return;
    app.notices.problems.push_back(
        words::filled(words::kProfileOfScene, {scene.profile.stem().string(), chosen.stem().string()}));
}

// Whoever chose a scene that can no longer be prepared must get to the menu to choose another: the default one opens.
std::shared_ptr<const scene::Plan> prepare_own_choice(scene::Scene& scene, App& app) {
    std::shared_ptr<const scene::Plan> plan;
    const auto work = [&] { plan = std::make_shared<const scene::Plan>(scene::make_plan(scene)); };
    if (attempt(app, work)) return plan;
    scene = load_scene("");
    draw_turn(scene);
    work();
    return plan;
}

}  // namespace

void load(const RunOptions& options, App& app) {
    app.options = options;
    app.settings_path = settings_file();
    std::string problem;
    app.settings = load_settings(app.settings_path, problem);
    if (!problem.empty()) app.notices.problems.push_back(problem);
    if (options.test) app.settings.test_mode = true;
    if (options.practice) app.settings.test_mode = false;
    if (options.left_handed) app.settings.left_handed = true;
    if (options.width_px > 0) app.settings.width_px = options.width_px;
    if (options.height_px > 0) app.settings.height_px = options.height_px;
    app.kept_settings = app.settings;  // what the command line asks for is for this run and is not kept
    if (!options.protocol.empty()) return load_study(options, app);
    const std::filesystem::path data = user_folder();
    if (app.keeper == nullptr && options.trace.empty() && !data.empty()) app.history_folder = data / "history";
    app.notices.scenes = scene_choices();
    app.notices.profiles = profile_choices();
    if (!options.trace.empty()) {
        app.trace = platform::read_trace(options.trace);
        app.settings.width_px = static_cast<int>(app.trace->info.screen_width_px);
        app.settings.height_px = static_cast<int>(app.trace->info.screen_height_px);
        const std::string& mode = app.trace->info.mode;
        if (!options.test && !options.practice && !mode.empty())
            app.settings.test_mode = session::mode_of(app.trace->info) == session::TrialMode::test;
        app.kept_settings = app.settings;  // nor is what a recording asks for
    }
    const bool own_choice = options.scene.empty() && !app.trace;  // a replay is the same for everybody
    scene::Scene scene;
    if (own_choice && !app.settings.scene.empty()) attempt(app, [&] { scene = load_scene(app.settings.scene); });
    if (scene.name.empty()) scene = load_scene(options.scene);
    if (own_choice) take_chosen_profile(app, scene);
    if (!options.scene.empty() && !app.trace) tell_of_own_profile(scene, app);
    if (app.trace) {
        session::turn_as_recorded(app.trace->info, scene);
        const std::string other = session::other_parts(app.trace->info, scene);
        if (!other.empty()) std::fprintf(stderr, "palpa: warning: %s: %s\n", options.trace.c_str(), other.c_str());
    } else {
        draw_turn(scene);
    }
    if (takes_seconds(scene.tissue)) {
        app.unprepared = std::move(scene);
        return;
    }
    auto plan =
        own_choice ? prepare_own_choice(scene, app) : std::make_shared<const scene::Plan>(scene::make_plan(scene));
    session::change_tissue(std::move(scene), std::move(plan), {}, app.session);
}

void know_screen(const platform::Window& window, App& app) {
    app.notices.screen_name = window.screen_name();
    const auto known = app.settings.px_per_mm.find(app.notices.screen_name);
    if (std::isfinite(window.touch_px_per_mm())) app.view.scale.card_px_per_mm = window.touch_px_per_mm();
    if (known != app.settings.px_per_mm.end()) app.view.scale.card_px_per_mm = app.notices.px_per_mm = known->second;
}

namespace {

// Returns false if the window was closed before the tissue was ready.
bool prepare_first(scene::Scene scene, platform::Window& window, Gui& gui, App& app) {
    std::shared_ptr<const scene::Plan> plan = prepare(window, gui, scene);
    if (!plan) return false;
    session::change_tissue(std::move(scene), std::move(plan), session::screen_of(info_of(app, window)), app.session);
    return true;
}

}  // namespace

// If a scene chosen last time can no longer be prepared, the default scene replaces it, so that the person can still
// use the app.
bool prepare_chosen(platform::Window& window, Gui& gui, App& app) {
    if (!app.unprepared) return true;
    const scene::Scene scene = *std::exchange(app.unprepared, std::nullopt);
    const bool own_choice = app.options.scene.empty() && !app.trace && !app.settings.scene.empty();
    if (!own_choice) return prepare_first(scene, window, gui, app);
    bool ready = false;
    if (attempt(app, [&] { ready = prepare_first(scene, window, gui, app); })) return ready;
    return prepare_first(load_scene(""), window, gui, app);
}

}  // namespace palpa::app
