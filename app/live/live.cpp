#include "app/live/live.h"

#include <algorithm>
#include <exception>
#include <stdexcept>
#include <utility>

#include "app/live/live_app.h"
#include "app/scene_choices.h"
#include "app/screens/calibrate_form.h"
#include "app/screens/frame.h"
#include "app/screens/history_screen.h"
#include "app/screens/map_screen.h"
#include "app/screens/part_screen.h"
#include "app/screens/screenshot.h"
#include "app/screens/words.h"
#include "app/study/study_run.h"
#include "files/input_error.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "render/gl.h"
#include "study/study_folder.h"

namespace palpa::app {
namespace {

// True while a study shows a screen of its own, between its trials.
bool between_study_trials(const App& app) { return study_of(app.doing) != nullptr && !palpates(app.doing); }

// Takes the rows of the trace that are due, with the trace's own times.
void take_due_rows(App& app, double now_s, std::vector<platform::Sample>& out) {
    const auto& rows = app.trace->samples;
    while (app.next_row < rows.size() && rows[app.next_row].t_host_s <= now_s) out.push_back(rows[app.next_row++]);
}

void take(const platform::Sample& sample, App& app) {
    session::take_sample(sample, app.session);
    note_press(app.session.state, sample.t_host_s, app.view.part);
    if (app.waiting_s.size() < app.waiting_s.capacity()) app.waiting_s.push_back(sample.t_host_s);
    // a trace has finished its trial; its presses are its own, so go_to() is not needed
    if (app.session.trial.finished && std::holds_alternative<Palpating>(app.doing)) app.doing = back_to_trial(app);
}

// If a finger must not hide the avatar, it indents the place above it; log and trace hold that place.
void lift_fingers(float mm, std::vector<platform::Sample>& samples, const App& app) {
    if (!app.settings.above_finger || app.trace || !palpates(app.doing)) return;
    for (platform::Sample& sample : samples) {
        if (sample.tool == platform::Tool::finger) sample.y_px -= static_cast<double>(kFingerOffset_mm * mm);
    }
}

// Hands the samples of one turn of the loop to the tissue, to the device check or to the calibration.
void take_all(double now_s, std::vector<platform::Sample>& samples, App& app) {
    if (app.trace) {
        for (const platform::Sample& sample : samples) take(sample, app);
        return;
    }
    if (auto* checking = std::get_if<CheckingDevices>(&app.doing)) {
        for (const platform::Sample& sample : samples) {
            observe(sample, *checking->check);
            add_dot(sample, checking->dots);
        }
        return;
    }
    if (const auto* calibrating = std::get_if<Calibrating>(&app.doing))
        return step_calibrate(samples, *calibrating->form);
    if (app.hold.pen || app.hold.finger) platform::press_by_hold(now_s, app.hold, samples);
    if (!palpates(app.doing) || !std::holds_alternative<GoesOn>(app.course)) return;
    const bool study = study_of(app.doing) != nullptr;
    for (const platform::Sample& sample : samples) {
        if (!study || allowed(sample, app)) take(sample, app);
    }
}

// Lets the keys move the indenter over the tissue, at 30 mm/s, as long as no panel needs them. It stops at the tissue's edges:
// beyond them nothing would answer, and nothing would show where it is.
void place_keyboard(platform::Window& window, const App& app) {
    constexpr double kSpeed_m_per_s = 0.03;
    if (app.asked || app.view.help || app.session.trial.paused_at_s || !keys_move_indenter(app.doing)) {
        window.set_keyboard(0.0, 0.0, 0.0, 0.0, 0.0);
    } else {
        const scene::View& view = app.session.state.view;
        const scene::ScreenArea a = scene::input_area(view, app.session.state.screen);
        window.set_keyboard(a.x_px, a.y_px, a.x_px + a.width_px, a.y_px + a.height_px, kSpeed_m_per_s * view.px_per_m);
    }
}

float scale_now(const App& app, const platform::Window& window) {
    return control_scale(app.notices.px_per_mm, static_cast<float>(window.width_px()),
                         static_cast<float>(window.height_px()), window.touch_px_per_mm());
}

void set_scale(const platform::Window& window, const App& app, Gui& gui) {
    gui.set_scale(scale_now(app, window), 0.01f * static_cast<float>(app.settings.text_percent));
}

// Counts the frame and the latency of the samples that it shows. Samples that change nothing on the screen have no
// frame, and no latency.
void note_shown(const platform::Window& window, App& app) {
    const double shown_s = now_of(app, window);
    const double ready_s = 1e-9 * static_cast<double>(app.view.times.built_ns) - app.trace_shift_s;
    for (const double t_s : app.waiting_s) {
        app.view.times.latency.add_ns(1e9 * (shown_s - t_s));
        app.view.times.ready.add_ns(1e9 * (ready_s - t_s));
    }
    ++app.frames;
    const double since_s = window.now_s() - app.drawn_s;
    app.view.times.frames_per_s += 0.05 * (1.0 / std::max(since_s, 1e-3) - app.view.times.frames_per_s);
    app.drawn_s = window.now_s();
}

ToShow to_show(const App& app, double now_s, double dt_s) {
    const session::Session& s = app.session;
    const TactileShown* tactile = app.tactile.shown ? &*app.tactile.shown : nullptr;
    const TangibleShown* tangible = app.tangible.shown ? &*app.tangible.shown : nullptr;
    if (const auto* stopped = std::get_if<TrialStopped>(&app.course)) now_s = std::min(now_s, stopped->at_s);
    return {s.scene, *s.plan, s.trial, app.settings, app.notices, app.doing, app.asked, now_s, dt_s, tactile, tangible};
}

// Notes when a step of a study is shown first, which is when it begins.
void note_step_shown(double now_s, App& app) {
    StudyRun* study = study_of(app.doing);
    if (study != nullptr && study->step_began_s == 0.0) study->step_began_s = now_s;
}

void show(platform::Window& window, App& app, const Canvas& canvas, double dt_s) {
    app.notices.trial_stopped = trial_stopped(app);
    // with any frame rate, a pen that is gone is noticed within a second
    constexpr double kDevices_s = 0.5;
    if (window.now_s() - app.devices_noted_s >= kDevices_s) {
        note_devices(window, app);
        app.devices_noted_s = window.now_s();
    }
    const double now_s = now_of(app, window);
    age_note(now_s, app.notices);
    note_step_shown(now_s, app);
    const bool save = std::exchange(app.save_waits, false);
    // forces a drawing, since the content of the window is only certain right after it
    if (save) app.view.on_screen.content = 0;
    const Wishes wishes = draw_frame(to_show(app, now_s, dt_s), canvas, app.view, app.session.state);
    if (save) {
        attempt(app, [&] {
            app.notices.note = words::filled(words::kSaved, {save_picture(window, app.options.log).string()});
        });
    }
    if (app.view.on_screen.drawn) {
        window.present();
        note_shown(window, app);
    }
    app.waiting_s.clear();
    carry_out(wishes, window, canvas.gui, app);
}

// True while the screen changes by itself, or while a step waits for something that sends no event when it is ready.
bool in_motion(const App& app) {
    const StudyRun* study = study_of(app.doing);
    const bool records = std::holds_alternative<Calibrating>(app.doing);
    const bool keeps = waits_for_keeper(app) || (study != nullptr && study->keeping_since_s);
    const bool presses = palpates(app.doing) && app.session.state.pointer;
    const bool replays = app.view.history && app.view.history->plays;
    return devices_driven(app) || replays || app.trace || presses || !app.hold.held.empty() || records || keeps ||
           app.save_waits;
}

// Stops the trial with a message if a log can no longer be written; earlier rows are on the disk.
void watch_files(platform::Window& window, App& app) {
    if (trial_stopped(app) || session::files_good(app.session)) return;
    const std::string why = close_trial(window, app);
    end_presses(window, app);
    if (StudyRun* study = study_of(app.doing)) return stop_study(why, *study);
    app.notices.problems.push_back(why);
}

// Gives the keeper the trial so far once a second and with each mark, so that a reload or an empty battery costs at most a
// second of samples.
void keep_part(double now_s, App& app) {
    constexpr double kEvery_s = 1.0;
    const std::size_t marks = app.session.trial.marks.size();
    const bool due = now_s - app.parted_s >= kEvery_s || marks != app.parted_marks;
    if (app.keeper == nullptr || !app.session.files || !due) return;
    if (study_of(app.doing) == nullptr && !app.session.trial.last_px) return;  // nobody has pressed yet
    if (app.session.log) app.session.log->flush();
    app.keeper->keep_part(*app.session.files);
    app.parted_s = now_s;
    app.parted_marks = marks;
}

// Nobody has used the app here yet, and nothing is asked of it.
bool is_first_start(const RunOptions& options, const App& app) {
    const bool plain = options.scene.empty() && options.trace.empty() && options.log.empty() &&
                       options.record.empty() && options.screenshot.empty() && options.protocol.empty() &&
                       !options.test && !options.practice && !options.json && options.quit_after_s == 0.0;
    return plain && options.screen == Screen::trial && app.keeper == nullptr && !app.settings.guided_done;
}

void remember_window(const platform::Window& window, App& app) {
    if (app.trace || app.settings.full_screen || app.options.width_px > 0 || app.options.height_px > 0) return;
    if (app.settings.width_px == window.width_px() && app.settings.height_px == window.height_px()) return;
    app.settings.width_px = window.width_px();
    app.settings.height_px = window.height_px();
    keep_settings(app);
}

// The letters of a study, or of names that people have given to scenes and profiles.
std::string letters_to_show(const App& app) {
    if (const StudyRun* run = study_of(app.doing)) return letters_of(run->protocol);
    std::string letters = app.unprepared ? app.unprepared->name : app.session.scene.name;
    for (const auto* choices : {&app.notices.scenes, &app.notices.profiles}) {
        for (const Choice& one : *choices) letters += one.name;
    }
    return letters;
}

}  // namespace

struct Live::Impl {
    explicit Impl(const RunOptions& options, session::TrialKeeper* keeper) {
        app.keeper = keeper;
        app.notices.keeps_trials = keeper != nullptr;
        load(options, app);
        platform::WindowOptions window_options;
        window_options.width_px = app.settings.width_px;
        window_options.height_px = app.settings.height_px;
        // what a person asked for, and what was recorded, stays as it is
        window_options.within_screen = !app.trace && options.width_px == 0 && options.height_px == 0;
        window.emplace(window_options);
        if (app.settings.full_screen && !app.trace) window->set_full_screen(true);
        know_screen(*window, app);
        gui.emplace(*window);
        gui->add_letters(letters_to_show(app));
        set_scale(*window, app, *gui);
        ready = prepare_chosen(*window, *gui, app);
        if (!ready) return;
        if (app.trace) app.trace_shift_s = window->now_s() - app.trace->samples.front().t_host_s;
        if (study_of(app.doing) == nullptr) begin(*window, *gui, app);
        if (options.screen != Screen::trial) open_screen(options.screen, *window, app);
        if (options.guided || is_first_start(options, app)) begin_guided(*window, *gui, app);
        tissue.emplace();
        app.waiting_s.reserve(4096);
        frame_s = stirred_s = app.drawn_s = window->now_s();
    }

    // The window's close button asks first, as Ctrl+Q does; pressed a second time, it closes.
    bool closes() {
        if (app.quit) return true;
        if (!window->close_requested()) return false;
        const bool again = app.asked && app.asked->quit;
        if (again || !work_at_stake(app) || !window->stay_open()) return true;
        Wishes wishes;
        wishes.quit = true;
        carry_out(wishes, *window, *gui, app);
        return app.quit;
    }

    bool over() {
        if (closes()) return true;
        if (app.trace && app.next_row == app.trace->samples.size()) return true;
        return app.options.quit_after_s > 0.0 && app.frames > 0 && window->now_s() - shown_s > app.options.quit_after_s;
    }

    void take_samples(double wait_s) {
        samples.clear();
        window->poll(wait_s, samples);  // 1. read
        if (!app.trace) app.pressure = window->pressure();
        if (gui->take_stop()) stop_devices(app);
        if (window->stirred() || !samples.empty()) stirred_s = window->now_s();
        if (window->uncovered()) app.view.on_screen.content = 0;
        if (app.trace) {
            samples.clear();
            take_due_rows(app, now_of(app, *window), samples);
        }
        begin_when_kept(*window, *gui, app);
        set_scale(*window, app, *gui);
        if (!between_study_trials(app)) note_resize(*window, *gui, app);
        place_keyboard(*window, app);
        lift_fingers(gui->hand_mm(), samples, app);
        take_all(window->now_s(), samples, app);  // 2. simulate and log
        follow_devices(window->now_s(), app);
        follow_parts(*window, *gui, app);
        watch_files(*window, app);
        session::flush_if_due(app.session);  // also while nothing moves and nothing is drawn
        keep_part(window->now_s(), app);
    }

    // Returns when the next frame is built. While nothing happens, frames are rare: often enough for clocks, notices
    // and cursors that blink. Input wakes the loop at once.
    double next_frame_s() const {
        // a result has no clock, and much to draw
        const double idle_s = std::holds_alternative<Reviewing>(app.doing) ? 0.25 : 0.1;
        constexpr double kSettle_s = 0.25;  // panels take some frames to settle, and the log is flushed after 80 ms
        const bool quick = in_motion(app) || gui->in_use() || window->now_s() - stirred_s < kSettle_s;
        return std::min(frame_s + (quick ? kFrame_s : idle_s), trial_ends_s(app));
    }

    App app;
    std::optional<platform::Window> window;
    std::optional<Gui> gui;
    std::optional<render::TissueDrawer> tissue;  // destroyed before the window
    bool ready = false;
    double asked_s = 1e-9 * static_cast<double>(scene::steady_ns());
    double shown_s = 0.0;    // when the first frame was
    double frame_s = 0.0;    // when the last frame was built
    double stirred_s = 0.0;  // when the last event or sample arrived
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
    const bool first = it.app.frames == 0;
    show(*it.window, it.app, {*it.gui, *it.tissue}, now_s - it.frame_s);  // 3. show
    it.frame_s = now_s;
    if (first && it.app.frames > 0) {
        it.first_frame_s = 1e-9 * static_cast<double>(scene::steady_ns()) - it.asked_s;
        it.shown_s = it.window->now_s();
    }
    return true;
}

void Live::out_of_sight(bool hidden) {
    Impl& it = *impl_;
    it.take_samples(0.0);  // of presses that end now
    it.frame_s = it.stirred_s = it.window->now_s();
    it.app.view.on_screen.content = 0;
    note_sight(hidden, now_of(it.app, *it.window), it.app);
    if (it.app.trace || it.app.session.trial.finished || waits_for_keeper(it.app) || between_study_trials(it.app))
        return;
    platform::Sample sample;
    sample.t_host_s = now_of(it.app, *it.window);
    sample.phase = platform::Phase::ui;
    sample.action = hidden ? platform::Action::hidden : platform::Action::shown;
    take(sample, it.app);
    if (!hidden || it.app.keeper == nullptr || !it.app.session.files) return;
    if (it.app.session.log) it.app.session.log->flush();
    it.app.keeper->keep(*it.app.session.files, false);
}

void Live::follow_window() {
    const bool hidden = impl_->window->hidden();
    if (hidden != impl_->app.hidden) out_of_sight(hidden);
}

void Live::renew_drawing() {
    impl_->gui->renew_drawing();
    impl_->tissue.emplace();
    impl_->app.view.on_screen.content = 0;
    impl_->stirred_s = impl_->window->now_s();
}

files::Json Live::report() const {
    files::Json result = result_of(impl_->app);
    result["overflow"] = impl_->gui->overflow();
    if (study_of(impl_->app.doing) != nullptr) result["study"] = study_json(impl_->app);
    return result;
}

std::optional<Gui::TextField> Live::text_field() const { return impl_->gui->text_field(); }
void Live::type_instead(const std::string& text) { impl_->gui->type_instead(text); }

files::Json Live::close() {
    Impl& it = *impl_;
    if (!it.app.options.screenshot.empty()) {
        it.app.view.on_screen.content = 0;
        draw_frame(to_show(it.app, now_of(it.app, *it.window), kFrame_s), {*it.gui, *it.tissue}, it.app.view,
                   it.app.session.state);
        save_screen(*it.window, it.app.options.screenshot);
    }
    if (const auto* calibrating = std::get_if<Calibrating>(&it.app.doing)) stop_recording(*calibrating->form);
    remember_window(*it.window, it.app);
    if (study_of(it.app.doing) != nullptr) return close_study(*it.window, *it.gui, it.app);
    rest_devices(it.app);
    files::Json result = result_of(it.app);
    result["start_to_first_frame_s"] = it.first_frame_s;
    result["overflow"] = it.gui->overflow();
    close_trial(*it.window, it.app);
    if (const auto* stopped = std::get_if<TrialStopped>(&it.app.course)) throw std::runtime_error(stopped->why);
    if (!it.app.lost.empty()) throw std::runtime_error(it.app.lost);
    return result;
}

void check_png_name(const std::string& name) {
    if (std::filesystem::path(name).extension() != ".png")
        throw files::bad_input("--screenshot", "", files::shown(name), "FILE.png");
}

std::optional<files::Json> run_live(const RunOptions& options) {
    if (!options.screenshot.empty()) {
        files::check_output(options.screenshot, {options.scene, options.trace, options.protocol});
        check_png_name(options.screenshot);
    }
    if (!options.log.empty()) files::check_output_folder(options.log);
    if (!options.log.empty() && options.protocol.empty()) study::check_no_study(options.log);
    Live live(options);
    if (!live.ready()) return std::nullopt;
    while (live.turn(Live::Draw::when_due)) live.follow_window();
    return live.close();
}

}  // namespace palpa::app
