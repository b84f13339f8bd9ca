#include "app/live/live.h"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "app/live/live_app.h"
#include "app/scene_choices.h"
#include "app/screens/calibrate_form.h"
#include "app/screens/frame.h"
#include "app/screens/map_screen.h"
#include "app/screens/screenshot.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "render/gl.h"

namespace palpa::app {
namespace {

void keep_settings(App& app) {
    if (app.settings_path.empty()) return;
    const std::string problem = save_settings(app.settings, app.settings_path);
    if (!problem.empty()) app.screens.problems.push_back(problem);
    if (app.keeper != nullptr) app.keeper->keep_settings(app.settings_path);
}

// Puts the recording on the disk; a profile that was kept can be chosen at once.
void close_calibrate(App& app) {
    stop_recording(*app.screens.calibrate);
    app.screens.calibrate.reset();
    app.screens.profiles = profile_choices();
}

void open_screen(Screen screen, platform::Window& window, App& app) {
    if (screen == Screen::maps && (app.screens.study || !may_show_maps(app.session.trial))) {
        app.screens.note = words::kMapsHidden;
        app.screens.menu = false;
        return;
    }
    if (app.screens.screen != screen) end_presses(window, app);
    if (screen == Screen::devices) {
        app.screens.check = std::make_shared<DeviceCheck>();
        app.screens.dots.clear();
    }
    if (screen == Screen::calibrate && !app.screens.calibrate) app.screens.calibrate = make_calibrate_form();
    if (app.screens.screen == Screen::calibrate && screen != Screen::calibrate) close_calibrate(app);
    if (screen == Screen::maps && !app.screens.maps)
        app.screens.maps = make_map_browser(app.session.scene, map_choices());
    if (screen != Screen::maps) app.screens.maps.reset();
    app.screens.screen = screen;
    app.screens.menu = false;
}

void change_settings(const Wishes& wishes, platform::Window& window, Gui& gui, App& app) {
    if (wishes.left_handed) app.settings.left_handed = *wishes.left_handed;
    if (wishes.above_finger) app.settings.above_finger = *wishes.above_finger;
    if (wishes.mode) app.settings.test_mode = *wishes.mode == session::TrialMode::test;
    if (wishes.full_screen) {
        app.settings.full_screen = !window.full_screen();
        window.set_full_screen(app.settings.full_screen);
    }
    if (wishes.px_per_mm) {
        app.screens.px_per_mm = *wishes.px_per_mm;
        app.settings.px_per_mm.erase(app.screens.screen_name);
        if (std::isfinite(*wishes.px_per_mm)) app.settings.px_per_mm[app.screens.screen_name] = *wishes.px_per_mm;
    }
    const bool changed = wishes.left_handed || wishes.above_finger || wishes.mode || wishes.full_screen ||
                         wishes.px_per_mm || wishes.scene || wishes.profile;
    if (changed) keep_settings(app);
    // another scale or another way of showing the tissue makes another trial
    if (!wishes.px_per_mm && !wishes.mode && !wishes.above_finger) return;
    if (app.settings.test_mode) turn_if_shown(window, app);
    begin_anew(window, gui, app);
}

void carry_out(const Wishes& asked_for, platform::Window& window, Gui& gui, App& app) {
    Wishes wishes = asked_for;
    if (marks_at_stake(app)) {
        wishes = ask_first(asked_for, app.screens);
        if (app.screens.asked) end_presses(window, app);
    } else {
        app.screens.asked.reset();
    }
    if (wishes.quit) app.quit = true;
    if (app.screens.study) follow_study(window, gui, app);
    if (wishes.action && app.screens.screen == Screen::trial && !app.trace)
        act(*wishes.action, now_of(app, window), app);
    if (wishes.screen) open_screen(*wishes.screen, window, app);
    if (wishes.scene) app.settings.scene = *wishes.scene;
    if (wishes.profile) app.settings.profile = *wishes.profile;
    if (wishes.scene || wishes.profile) {
        change_scene(window, gui, wishes.scene.value_or(app.session.scene.file.string()), app.settings.profile, app);
    }
    change_settings(wishes, window, gui, app);
    if (wishes.press_by_hold && app.screens.offer_hold) {
        const auto lacks = [&](platform::Tool tool) {
            const platform::PressureKind kind = platform::pressure_kind(app.pressure, tool);
            return kind == platform::PressureKind::constant || kind == platform::PressureKind::missing;
        };
        app.hold.pen = app.hold.pen || lacks(platform::Tool::pen);
        app.hold.finger = app.hold.finger || lacks(platform::Tool::finger);
    }
    if (wishes.trials && app.keeper != nullptr) app.keeper->open();
    if (wishes.studies && app.keeper != nullptr) app.keeper->open_studies();
    if (wishes.next) turn_tissue(window, app);
    if (wishes.again || wishes.next) begin_anew(window, gui, app);
    app.save_waits = app.save_waits || wishes.save_picture;
}

// Takes the rows of the trace that are due, with the trace's own times.
void take_due_rows(App& app, double now_s, std::vector<platform::Sample>& out) {
    const auto& rows = app.trace->samples;
    while (app.next_row < rows.size() && rows[app.next_row].t_host_s <= now_s) out.push_back(rows[app.next_row++]);
}

void take(const platform::Sample& sample, App& app) {
    session::take_sample(sample, app.session);
    if (app.waiting_s.size() < app.waiting_s.capacity()) app.waiting_s.push_back(sample.t_host_s);
    if (!app.session.trial.finished || app.screens.screen != Screen::trial) return;
    app.screens.debrief = session::debrief(*app.session.plan, app.session.trial);  // a trace that finishes its trial
    app.screens.screen = Screen::reveal;
}

// If a finger may not hide the avatar, it indents the place above it; log and trace hold that place.
void lift_fingers(float mm, std::vector<platform::Sample>& samples, const App& app) {
    if (!app.settings.above_finger || app.trace || app.screens.screen != Screen::trial) return;
    for (platform::Sample& sample : samples) {
        if (sample.tool == platform::Tool::finger) sample.y_px -= static_cast<double>(kFingerOffset_mm * mm);
    }
}

// Where the samples of one turn of the loop go: to the tissue, or to the device check.
void take_all(double now_s, std::vector<platform::Sample>& samples, App& app) {
    if (app.trace) {
        for (const platform::Sample& sample : samples) take(sample, app);
        return;
    }
    for (const platform::Sample& sample : samples) platform::watch(sample, app.pressure);
    if (app.screens.screen == Screen::devices) {
        for (const platform::Sample& sample : samples) {
            observe(sample, *app.screens.check);
            add_dot(sample, app.screens);
        }
        return;
    }
    if (app.screens.screen == Screen::calibrate) return step_calibrate(samples, *app.screens.calibrate);
    if (app.hold.pen || app.hold.finger) platform::press_by_hold(now_s, app.hold, samples);
    if (app.screens.screen != Screen::trial || !app.stopped.empty() || app.begin_waits) return;
    for (const platform::Sample& sample : samples) {
        if (!app.screens.study || allowed(sample, app)) take(sample, app);
    }
}

// The keys move the indenter over the tissue, 30 mm/s, as long as no panel wants them.
void place_keyboard(platform::Window& window, const App& app) {
    constexpr double kSpeed_m_per_s = 0.03;
    const scene::ScreenArea& a = app.session.state.screen;
    const bool elsewhere = app.screens.study && app.screens.screen != Screen::trial;
    if (elsewhere || app.screens.menu || app.screens.asked ||
        (app.screens.screen != Screen::trial && app.screens.screen != Screen::devices)) {
        window.set_keyboard(0.0, 0.0, 0.0, 0.0, 0.0);
    } else {
        window.set_keyboard(a.x_px, a.y_px, a.x_px + a.width_px, a.y_px + a.height_px,
                            kSpeed_m_per_s * app.session.state.view.px_per_m);
    }
}

float scale_now(const App& app, const platform::Window& window) {
    return control_scale(app.screens.px_per_mm, static_cast<float>(window.width_px()),
                         static_cast<float>(window.height_px()), window.touch_px_per_mm());
}

// A window that changed its size, or a hand that changed sides, is input too: a replay must map positions alike.
void note_resize(const platform::Window& window, Gui& gui, App& app) {
    gui.set_scale(scale_now(app, window));
    const bool none = app.screens.study && app.screens.screen != Screen::trial;
    if (app.trace || none || app.session.trial.finished) return;
    const platform::Sample now = resize_sample(window, gui, app.settings, now_of(app, window));
    const scene::ScreenArea& area = app.session.state.screen;
    const bool same = now.x_px == area.x_px && now.y_px == area.y_px && now.width_px == area.width_px &&
                      now.height_px == area.height_px;
    if (!same) take(now, app);
}

// Counts the frame and the latency of the samples that it shows. Samples that changed nothing on the screen have no
// frame that shows them, and no latency.
void note_shown(const platform::Window& window, App& app) {
    const double shown_s = now_of(app, window);
    const double ready_s = 1e-9 * static_cast<double>(app.times.built_ns) - app.trace_shift_s;
    for (const double t_s : app.waiting_s) {
        app.times.latency.add_ns(1e9 * (shown_s - t_s));
        app.times.ready.add_ns(1e9 * (ready_s - t_s));
    }
    ++app.frames;
    const double since_s = window.now_s() - app.drawn_s;
    app.times.frames_per_s += 0.05 * (1.0 / std::max(since_s, 1e-3) - app.times.frames_per_s);
    app.drawn_s = window.now_s();
}

void show(platform::Window& window, App& app, render::TissueDrawer& tissue, Gui& gui, double dt_s) {
    constexpr double kDevices_s = 0.5;  // however slowly frames come: a pen that is gone is noticed within a second
    if (window.now_s() - app.devices_noted_s >= kDevices_s) {
        note_devices(window, app);
        app.devices_noted_s = window.now_s();
    }
    age_note(now_of(app, window), app.screens);
    const session::Session& s = app.session;
    const bool save = std::exchange(app.save_waits, false);
    if (save) app.on_screen.content = 0;  // what the window hands out is only sure while it has just been drawn
    const Wishes wishes = draw_frame(s.scene, *s.plan, s.trial, app.settings, now_of(app, window), dt_s, tissue, gui,
                                     app.screens, app.session.state, app.times, app.on_screen);
    if (save) {
        attempt(app, [&] {
            app.screens.note = words::filled(words::kSaved, {save_picture(window, app.options.log).string()});
        });
    }
    if (app.on_screen.drawn) {
        window.present();
        note_shown(window, app);
    }
    app.waiting_s.clear();
    carry_out(wishes, window, gui, app);
}

// True while the screen changes by itself, or while a step waits for something that sends no event when it is ready.
bool in_motion(const App& app) {
    const bool records = app.screens.screen == Screen::calibrate;
    const bool keeps = app.begin_waits || (app.screens.study && app.screens.study->keeping);
    return app.trace || app.session.state.pointer || !app.hold.held.empty() || records || keeps || app.save_waits;
}

// A log that can no longer be written stops the trial with a message; earlier rows are on the disk.
void watch_files(App& app) {
    if (!app.stopped.empty() || session::files_good(app.session)) return;
    close_trial(app);
    if (app.screens.study) {
        app.screens.screen = Screen::study;
        return stop_study(app.stopped, *app.screens.study);
    }
    app.screens.problems.push_back(app.stopped);
}

// Gives the keeper the trial so far once a second, so that a reload or an empty battery costs at most a second.
void keep_part(double now_s, App& app) {
    constexpr double kEvery_s = 1.0;
    if (app.keeper == nullptr || !app.session.files || now_s - app.parted_s < kEvery_s) return;
    if (!app.screens.study && !app.session.trial.last_px) return;  // a page that was only looked at
    if (app.session.log) app.session.log->flush();
    app.keeper->keep_part(*app.session.files);
    app.parted_s = now_s;
}

void remember_window(const platform::Window& window, App& app) {
    if (app.trace || app.settings.full_screen || app.options.width_px > 0 || app.options.height_px > 0) return;
    if (app.settings.width_px == window.width_px() && app.settings.height_px == window.height_px()) return;
    app.settings.width_px = window.width_px();
    app.settings.height_px = window.height_px();
    keep_settings(app);
}

}  // namespace

struct Live::Impl {
    explicit Impl(const RunOptions& options, session::TrialKeeper* keeper) {
        app.keeper = keeper;
        app.screens.keeps_trials = keeper != nullptr;
        load(options, app);
        platform::WindowOptions window_options;
        window_options.width_px = app.settings.width_px;
        window_options.height_px = app.settings.height_px;
        window.emplace(window_options);
        if (app.settings.full_screen && !app.trace) window->set_full_screen(true);
        know_screen(*window, app);
        gui.emplace(*window);
        gui->set_scale(scale_now(app, *window));
        ready = prepare_chosen(*window, *gui, app);
        if (!ready) return;
        if (app.trace) app.trace_shift_s = window->now_s() - app.trace->samples.front().t_host_s;
        if (!app.screens.study) begin(*window, *gui, app);
        if (options.screen != Screen::trial) open_screen(options.screen, *window, app);
        tissue.emplace();
        app.waiting_s.reserve(4096);
        began_s = frame_s = stirred_s = app.drawn_s = window->now_s();
    }

    // The window's own button asks first, as Ctrl+Q does; pressed a second time, it closes.
    bool closes() {
        if (app.quit) return true;
        if (!window->close_requested()) return false;
        const bool again = app.screens.asked && app.screens.asked->quit;
        if (again || !marks_at_stake(app) || !window->stay_open()) return true;
        Wishes wishes;
        wishes.quit = true;
        carry_out(wishes, *window, *gui, app);
        return app.quit;
    }

    bool over() {
        if (closes()) return true;
        if (app.trace && app.next_row == app.trace->samples.size()) return true;
        return app.options.quit_after_s > 0.0 && window->now_s() - began_s > app.options.quit_after_s;
    }

    void take_samples(double wait_s) {
        samples.clear();
        window->poll(wait_s, samples);  // 1. read
        if (window->stirred() || !samples.empty()) stirred_s = window->now_s();
        if (window->uncovered()) app.on_screen.content = 0;
        if (app.trace) {
            samples.clear();
            take_due_rows(app, now_of(app, *window), samples);
        }
        begin_when_kept(*window, *gui, app);
        note_resize(*window, *gui, app);
        place_keyboard(*window, app);
        lift_fingers(gui->mm(), samples, app);
        take_all(window->now_s(), samples, app);  // 2. simulate, 3. log
        watch_files(app);
        session::flush_if_due(app.session);  // also while nothing moves, and nothing is drawn
        keep_part(window->now_s(), app);
    }

    // When the next frame is built. While nothing happens, frames are seldom: often enough for clocks, notices and
    // cursors that blink. Input wakes the loop at once.
    double next_frame_s() const {
        constexpr double kIdle_s = 0.1;
        constexpr double kSettle_s = 0.25;  // panels take some frames to settle, and the log is flushed after 80 ms
        const bool quick = in_motion(app) || gui->in_use() || window->now_s() - stirred_s < kSettle_s;
        return std::min(frame_s + (quick ? kFrame_s : kIdle_s), trial_ends_s(app));
    }

    App app;
    std::optional<platform::Window> window;
    std::optional<Gui> gui;
    std::optional<render::TissueDrawer> tissue;  // goes before the window
    bool ready = false;
    double asked_s = 1e-9 * static_cast<double>(scene::steady_ns());
    double began_s = 0.0;
    double frame_s = 0.0;    // when a frame was built last
    double stirred_s = 0.0;  // when anything came last
    double first_frame_s = 0.0;
    std::vector<platform::Sample> samples;
};

Live::Live(const RunOptions& options, session::TrialKeeper* keeper) : impl_(std::make_unique<Impl>(options, keeper)) {}
Live::~Live() = default;

bool Live::ready() const { return impl_->ready; }

bool Live::turn(Draw draw) {
    Impl& it = *impl_;
    if (it.over()) return false;
    const bool waits = draw == Draw::when_due;
    it.take_samples(waits ? std::max(0.0, it.next_frame_s() - it.window->now_s()) : 0.0);
    const double now_s = it.window->now_s();
    if (draw == Draw::nothing) return true;
    // a browser that calls for each frame of its display sets the pace itself while anything moves
    const double early_s = waits ? 0.0 : kFrame_s;
    if (now_s + early_s < it.next_frame_s() && it.app.frames > 0) return true;
    show(*it.window, it.app, *it.tissue, *it.gui, now_s - it.frame_s);  // 4. show
    it.frame_s = now_s;
    if (it.app.frames == 1) it.first_frame_s = 1e-9 * static_cast<double>(scene::steady_ns()) - it.asked_s;
    return true;
}

void Live::out_of_sight(bool hidden) {
    Impl& it = *impl_;
    it.take_samples(0.0);  // presses that end now
    it.frame_s = it.stirred_s = it.window->now_s();
    it.app.on_screen.content = 0;
    const bool between = it.app.screens.study && it.app.screens.screen != Screen::trial;
    if (it.app.trace || it.app.session.trial.finished || it.app.begin_waits || between) return;
    platform::Sample sample;
    sample.t_host_s = now_of(it.app, *it.window);
    sample.phase = platform::Phase::ui;
    sample.action = hidden ? platform::Action::hidden : platform::Action::shown;
    take(sample, it.app);
    if (!hidden || it.app.keeper == nullptr || !it.app.session.files) return;
    if (it.app.session.log) it.app.session.log->flush();
    it.app.keeper->keep(*it.app.session.files, false);
}

void Live::renew_drawing() {
    impl_->gui->renew_drawing();
    impl_->tissue.emplace();
    impl_->app.on_screen.content = 0;
    impl_->stirred_s = impl_->window->now_s();
}

files::Json Live::report() const {
    files::Json result = result_of(impl_->app);
    result["overflow"] = impl_->gui->overflow();
    if (impl_->app.screens.study) result["study"] = study_json(impl_->app);
    return result;
}

std::optional<Gui::TextField> Live::text_field() const { return impl_->gui->text_field(); }
void Live::type_instead(const std::string& text) { impl_->gui->type_instead(text); }

files::Json Live::close() {
    Impl& it = *impl_;
    if (!it.app.options.screenshot.empty()) {
        it.app.on_screen.content = 0;
        const session::Session& s = it.app.session;
        draw_frame(s.scene, *s.plan, s.trial, it.app.settings, now_of(it.app, *it.window), kFrame_s, *it.tissue,
                   *it.gui, it.app.screens, it.app.session.state, it.app.times, it.app.on_screen);
        save_screen(*it.window, it.app.options.screenshot);
    }
    if (it.app.screens.calibrate) stop_recording(*it.app.screens.calibrate);
    remember_window(*it.window, it.app);
    if (it.app.screens.study) return close_study(*it.gui, it.app);
    files::Json result = result_of(it.app);
    result["start_to_first_frame_s"] = it.first_frame_s;
    result["overflow"] = it.gui->overflow();
    const bool good = close_trial(it.app);
    if (!good || !it.app.stopped.empty()) throw std::runtime_error(it.app.stopped);
    return result;
}

std::optional<files::Json> run_live(const RunOptions& options) {
    if (!options.screenshot.empty())
        files::check_output(options.screenshot, {options.scene, options.trace, options.protocol});
    if (!options.log.empty()) files::check_output_folder(options.log);
    Live live(options);
    if (!live.ready()) return std::nullopt;
    while (live.turn(Live::Draw::when_due)) {
    }
    return live.close();
}

}  // namespace palpa::app
