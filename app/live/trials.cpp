// The trials of the app: how one begins on a scene and how it ends. Those of a study are in study_trials.cpp.

#include <algorithm>
#include <cmath>
#include <random>
#include <stdexcept>

#include "app/live/live_app.h"
#include "app/scene_choices.h"
#include "app/screens/frame.h"
#include "app/screens/map_screen.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"
#include "files/clock.h"
#include "render/gl.h"
#include "scene/advance.h"
#include "session/history.h"
#include "session/plan_in_progress.h"
#include "session/replay.h"

namespace palpa::app {
namespace {

// Names the devices that are connected; a browser does not tell them.
std::string device_names(const platform::Window& window) {
    if (!window.lists_devices()) return "n/a";
    std::string names;
    for (const platform::PointerDevice& device : window.devices()) names += (names.empty() ? "" : ", ") + device.name;
    return names.empty() ? "mouse" : names;
}

bool is_of_last_mark(platform::Action action) {
    return action == platform::Action::undo ||
           (action >= platform::Action::confidence_1 && action <= platform::Action::confidence_5);
}

// Keeps the result of the trial that has just been finished, unless the person does not want it kept.
void keep_result(App& app) {
    if (!app.settings.keep_results || app.history_folder.empty() || app.guided) return;
    attempt(app, [&] { session::keep_trial(session::kept_trial(app.session, files::utc_now()), app.history_folder); });
}

void close_or_tell(const platform::Window& window, App& app) {
    const std::string why = close_trial(window, app);
    if (!why.empty()) app.notices.problems.push_back(why);
}

}  // namespace

platform::TraceInfo info_of(const App& app, const platform::Window& window) {
    if (app.trace) return app.trace->info;
    platform::TraceInfo info;
    info.screen_width_px = window.width_px();
    info.screen_height_px = window.height_px();
    if (std::isfinite(app.notices.px_per_mm)) {
        info.screen_width_mm = info.screen_width_px / app.notices.px_per_mm;
        info.screen_height_mm = info.screen_height_px / app.notices.px_per_mm;
    }
    info.device = device_names(window);
    return info;
}

double finger_offset_mm(const App& app) {
    if (app.trace) return app.trace->info.finger_offset_mm;
    return app.settings.above_finger ? static_cast<double>(kFingerOffset_mm) : 0.0;
}

double now_of(const App& app, const platform::Window& window) { return window.now_s() - app.trace_shift_s; }

namespace {

// Adds the figures of the frames since `before`, and what the app itself knows.
void add_figures(const App& app, const FramesSoFar& before, files::Json& result) {
    const FrameTimes& times = app.view.times;
    const auto put = [&](const char* key, const scene::Meter& now, const scene::Meter& earlier) {
        const scene::Meter timed = now.since(earlier);
        result[key] = {{"p50", 1e-6 * timed.quantile_ns(0.5)}, {"p99", 1e-6 * timed.quantile_ns(0.99)}};
    };
    put("frame_cpu_ms", times.cpu, before.times.cpu);
    put("frame_gl_ms", times.gl, before.times.gl);
    put("latency_besides_drawing_ms", times.ready, before.times.ready);
    result["problems"] = app.notices.problems;
    if (!app.tactile.report.is_null()) result["tactile"] = app.tactile.report;
    if (!app.tangible.report.is_null()) result["tangible"] = app.tangible.report;
    if (app.check) result["device_check"] = check_json(*app.check);
}

// What is kept beside a trial's log: nothing of earlier trials, which may be another person's.
files::Json performance_of(const App& app) {
    const session::Session& s = app.session;
    const FramesSoFar& before = app.before_trial;
    files::Json result =
        session::trial_run_json(s, app.frames - before.count, app.view.times.latency.since(before.times.latency));
    add_figures(app, before, result);
    result["trials"] = files::Json::array({session::trial_json(*s.plan, s.trial)});
    return result;
}

}  // namespace

files::Json result_of(const App& app) {
    files::Json result = session::run_json(app.session, app.frames, app.view.times.latency);
    add_figures(app, {}, result);
    result["trials"] = session::trials_json(app.session);
    return result;
}

void begin_figures(App& app) { app.before_trial = {app.frames, app.view.times}; }

void end_presses(platform::Window& window, App& app) {
    window.end_presses();
    app.hold.held.clear();
    const scene::State& state = app.session.state;
    if (!state.pointer) return;
    platform::Sample end;
    end.t_host_s = now_of(app, window);
    end.pointer_id = *state.pointer;
    end.tool = state.pointer_tool;
    end.phase = platform::Phase::cancel;
    end.x_px = end.y_px = platform::kMissing;  // the last position
    session::take_sample(end, app.session);
}

void begin(platform::Window& window, const Gui& gui, App& app) {
    const bool test = app.settings.test_mode && !app.guided;
    const session::TrialMode mode = test ? session::TrialMode::test : session::TrialMode::practice;
    go_to(Palpating{false, app.guided}, window, app);
    app.notices.note.clear();
    app.asked.reset();
    app.course = GoesOn{};
    session::SessionFiles files{app.options.log, app.options.participant, app.options.record};
    files.first_run = app.options.first_run;
    files.finger_offset_mm = finger_offset_mm(app);
    begin_figures(app);
    session::begin_trial(files, info_of(app, window), mode, app.session);
    if (!app.trace) session::take_sample(resize_sample(window, gui, app.settings, now_of(app, window)), app.session);
    begin_devices(app);
}

void note_resize(const platform::Window& window, const Gui& gui, App& app) {
    if (app.trace) return;
    session::Session& s = app.session;
    const platform::Sample now = resize_sample(window, gui, app.settings, now_of(app, window));
    const scene::ScreenArea& area = s.state.screen;
    const bool same = now.x_px == area.x_px && now.y_px == area.y_px && now.width_px == area.width_px &&
                      now.height_px == area.height_px;
    if (same) return;
    if (!s.trial.finished) return session::take_sample(now, s);
    scene::put_on_screen(s.scene, *s.plan, {now.width_px, now.height_px, now.x_px, now.y_px, area.px_per_m}, s.state);
}

std::string close_trial(const platform::Window& window, App& app) {
    rest_devices(app);
    // An interruption comes now, not with the last touch. Outside of studies a trace is recorded, whose replay ends with
    // its last sample and must give the same log.
    if (study_of(app.doing) != nullptr) session::note_time(now_of(app, window), app.session);
    const std::string where = !app.options.log.empty() ? app.options.log : app.options.record;
    const std::optional<study::RunFiles> files = app.session.files;
    const bool good = session::close_files(performance_of(app), app.session);
    if (app.keeper != nullptr && files) app.keeper->keep(*files, true);
    if (good) return {};
    const std::string why = words::filled(words::kCannotBeWritten, {where});
    app.course = TrialStopped{why, app.session.trial.now_s};
    if (app.lost.empty()) app.lost = why;
    return why;
}

void put_scene(scene::Scene scene, std::shared_ptr<const scene::Plan> plan, platform::Window& window, App& app) {
    end_presses(window, app);
    close_or_tell(window, app);
    session::change_tissue(std::move(scene), std::move(plan), session::screen_of(info_of(app, window)), app.session);
    // the debriefing belongs to the tissue before
    if (std::holds_alternative<Reviewing>(app.doing)) go_to(Palpating{}, window, app);
}

void begin_anew(platform::Window& window, const Gui& gui, App& app) {
    end_presses(window, app);
    // what ended the last trial is not said of the new one
    if (const auto* stopped = std::get_if<TrialStopped>(&app.course)) std::erase(app.notices.problems, stopped->why);
    close_or_tell(window, app);
    if (app.keeper != nullptr && !app.keeper->ready()) {
        app.course = WaitsForKeeper{};
        return;
    }
    if (!attempt(app, [&] { begin(window, gui, app); }))
        app.course = TrialStopped{app.notices.problems.back(), app.session.trial.now_s};
}

void begin_when_kept(platform::Window& window, const Gui& gui, App& app) {
    if (app.keeper == nullptr) return;
    for (std::string problem = app.keeper->problem(); !problem.empty(); problem = app.keeper->problem()) {
        app.notices.problems.push_back(problem);
    }
    for (std::string solved = app.keeper->solved(); !solved.empty(); solved = app.keeper->solved()) {
        std::erase(app.notices.problems, solved);
    }
    if (waits_for_keeper(app) && app.keeper->ready()) begin_anew(window, gui, app);
}

std::shared_ptr<const scene::Plan> prepare(platform::Window& window, Gui& gui, const scene::Scene& scene) {
    if (!takes_seconds(scene.tissue)) return std::make_shared<const scene::Plan>(scene::make_plan(scene));
    session::PlanInProgress work(scene);
    std::vector<platform::Sample> ignored;
    while (!work.wait(kFrame_s)) {
        window.poll(0.0, ignored);
        if (window.close_requested()) return nullptr;
        gui.begin_frame(kFrame_s, true);
        if (gui.pressed('q', true)) {  // the first scene: the app ends; another one: the present scene stays
            gui.end_frame();
            return nullptr;
        }
        draw_progress(words::kPreparing, work.share());
        gui.end_frame();
        render::clear_screen(window.width_px(), window.height_px());
        gui.draw();
        window.present();
    }
    return std::make_shared<const scene::Plan>(work.take());
}

bool change_scene(platform::Window& window, Gui& gui, const std::string& file, const std::string& profile, App& app) {
    end_presses(window, app);  // samples that arrive while the tissue is prepared reach none
    rest_devices(app);
    scene::Scene scene;
    std::shared_ptr<const scene::Plan> plan;
    const bool good = attempt(app, [&] {
        scene = load_scene(file);
        if (!profile.empty()) scene.profile = profile;
        draw_turn(scene);
        plan = prepare(window, gui, scene);
    });
    if (!good || !plan) return false;
    forget_parts(app);
    put_scene(std::move(scene), std::move(plan), window, app);
    begin_anew(window, gui, app);
    return true;
}

void begin_guided(platform::Window& window, Gui& gui, App& app) {
    app.guided = true;
    if (!change_scene(window, gui, "", app.settings.profile, app)) app.guided = false;  // it goes on with what there is
}

void leave_guided(platform::Window& window, const Gui& gui, App& app) {
    app.guided = false;
    app.settings.guided_done = true;
    app.settings.test_mode = false;
    keep_settings(app);
    if (auto* palpating = std::get_if<Palpating>(&app.doing)) {
        palpating->guided = false;
        return;
    }
    turn_tissue(window, app);
    begin_anew(window, gui, app);
}

void draw_turn(scene::Scene& scene) {
    if (!scene.mapping.random_turn) return;
    const unsigned turn = std::random_device{}() % 8;
    scene.mapping.rotate_deg = 90 * static_cast<int>(turn % 4);
    scene.mapping.flip = turn >= 4;
}

void turn_tissue(platform::Window& window, App& app) {
    // parts hide nothing, and stand beside plots that want their places
    if (scene::parts_of(app.session.plan->tissue) != nullptr) return;
    scene::Scene turned = app.session.scene;
    scene::Mapping& mapping = turned.mapping;
    const int now = mapping.rotate_deg / 90 + (mapping.flip ? 4 : 0);
    constexpr int kSteps[] = {3, 5};  // both reach all eight orientations before one is repeated
    const int step = mapping.random_turn ? 1 + static_cast<int>(std::random_device{}() % 7) : kSteps[turned.seed % 2];
    const int next = (now + step) % 8;
    mapping.rotate_deg = 90 * (next % 4);
    mapping.flip = next >= 4;
    put_scene(std::move(turned), app.session.plan, window, app);
}

void turn_if_shown(platform::Window& window, App& app) {
    if (may_show_maps(*app.session.plan, app.session.trial)) turn_tissue(window, app);
}

bool not_touched(const App& app) {
    const bool simulated = felt_elsewhere(app) && app.options.simulate_devices;  // nobody can press on it
    return !simulated && !app.session.trial.touched_s;
}

bool work_at_stake(const App& app) {
    const StudyRun* study = study_of(app.doing);
    const session::Trial& trial = app.session.trial;
    if (app.trace) return false;
    if (study != nullptr && !palpates(app.doing)) {
        // a surface that is to be repeated, or waits for its device, is the second one
        const bool second = (at<step::Present>(*study) || at<step::Device>(*study)) && study->interval > 0;
        const bool half_a_pair = at<step::Question>(*study) || second;
        if (half_a_pair) return true;
        return app.view.study.step == study->entered && answers_at_stake(app.view.study);
    }
    if (study != nullptr) return trial_goes_on(*study) && (!not_touched(app) || study->interval > 0);
    return !trial_stopped(app) && !trial.finished && !trial.marks.empty();
}

void act(platform::Action action, platform::Window& window, App& app) {
    const StudyRun* study = study_of(app.doing);
    const bool pair = study != nullptr && due_compares(*study);
    if (pair && action != platform::Action::finish) return;  // in a comparison there is nothing to mark
    const bool finish = study != nullptr && action == platform::Action::finish;
    if (finish && not_touched(app) && now_of(app, window) < trial_ends_s(app)) {
        app.notices.note = words::kTouchFirst;  // nothing that was not felt counts as missed
        return;
    }
    if (finish && repeat_if_unproven(window, app)) return;
    const bool clock = action == platform::Action::pause || action == platform::Action::resume;
    if (clock && study != nullptr) return;                // its limits are the protocol's
    if (!clock && app.session.trial.paused_at_s) return;  // nothing is done while the clock is stopped
    if (action == platform::Action::pause) end_presses(window, app);
    if (waits_for_keeper(app) || trial_stopped(app)) return;  // there is no trial to act on
    platform::Sample sample;
    sample.t_host_s = now_of(app, window);
    sample.phase = platform::Phase::ui;
    sample.action = action;
    if (is_of_last_mark(action) && app.session.trial.marks.empty()) return;
    if (action == platform::Action::mark) {
        if (!app.session.trial.last_px) return;
        sample.x_px = app.session.trial.last_px->x();
        sample.y_px = app.session.trial.last_px->y();
    }
    session::take_sample(sample, app.session);
    if (action == platform::Action::method) note_method(app);
    if (!app.session.trial.finished) return;
    if (study != nullptr) return finish_study_trial(window, app);
    close_or_tell(window, app);  // before the presses end: the log of a finished trial ends with its last action
    keep_result(app);
    go_to(back_to_trial(app), window, app);
    app.notices.note.clear();
}

}  // namespace palpa::app
