// A study in the app: begins and ends its trials. With a keeper (in a browser), no step begins before the previous one
// is stored.

#include <exception>
#include <limits>
#include <stdexcept>

#include "app/live/live_app.h"
#include "app/scene_choices.h"
#include "app/screens/font.h"
#include "app/screens/frame.h"
#include "app/screens/words.h"
#include "app/study/study_device.h"
#include "app/study/study_run.h"
#include "files/input_error.h"
#include "study/protocol_checks.h"

namespace palpa::app {
namespace {

void begin_study_trial(platform::Window& window, const Gui& gui, App& app) {
    StudyRun& run = *study_of(app.doing);
    try {
        const StudyScene& due = due_scene(run);
        const study::PlannedTrial& trial = due_trial(run);
        const bool known = trial.practice && !due_compares(run);
        if (!std::get<step::Trial>(run.step).opening) put_scene(scene_of(due, trial), due.plan, window, app);
        if (!study_devices_ready(app)) return;
        if (devices_stopped(app)) return wait_for_device(false, run);
        session::SessionFiles files = due_files(run);
        files.finger_offset_mm = finger_offset_mm(app);
        name_devices(app, *files.label);
        app.notices.note.clear();
        begin_figures(app);
        app.over_unseen = false;
        const platform::TraceInfo info = info_of(app, window);
        const platform::Sample laid_out = resize_sample(window, gui, app.settings, now_of(app, window));
        files.shown = {laid_out.width_px, laid_out.height_px, laid_out.x_px, laid_out.y_px,
                       session::screen_of(info).px_per_m};
        session::begin_trial(files, info, known ? session::TrialMode::practice : session::TrialMode::test, app.session);
        app.parted_s = 0.0;
        session::take_sample(resize_sample(window, gui, app.settings, now_of(app, window)), app.session);
        std::get<step::Trial>(run.step).begun = true;
    } catch (const std::exception& error) {
        rest_devices(app);
        stop_study(error.what(), run);
    }
}

bool is_device_here(const App& app) {
    if (!app.notices.devices_listed) return true;
    return device_here(due_condition(*study_of(app.doing)).modality, app.notices.devices);
}

void note_pressure_of_tool(const App& app, StudyRun& run) {
    const bool on_tissue = run.progress.next && shows_tissue(run);
    run.pressure = on_tissue
                       ? pressure_verdict(due_condition(run).modality,
                                          due_scene(run).plan->profile.level == calibration::LevelField::contact_area,
                                          app.notices.devices, app.notices.devices_listed, app.pressure)
                       : PressureVerdict::not_needed;
    if (run.pressure == PressureVerdict::ready) run.pressure_must_vary = false;
    if (run.pressure == PressureVerdict::untried && run.pressure_must_vary) run.pressure = PressureVerdict::no_pressure;
}

// A trial begins only with its device, and a pen's or a finger's trial only with one that measures pressure.
bool may_begin(const App& app) {
    const StudyRun& run = *study_of(app.doing);
    return is_device_here(app) && !refuses(run.pressure) && run.devices_note.empty();
}

// Why a trial says nothing about the person: its device is gone, or turned out to measure no pressure, its touches lack
// the level that the profile reads, nothing was touched in its time, or its time went by while the app was out of sight or
// the computer slept.
enum class Interruption { device_gone, no_pressure, no_level, untouched, overslept };
constexpr double kOverslept_s = 2.0;  // longer than any frame

// Touches without a level give no force. A device may report it late in a touch, so that `few` may lack it.
bool gives_no_force(const App& app, std::int64_t few) {
    const scene::State& state = app.session.state;
    return state.counters.without_level > few && !(state.extremes.force_N > 0.0);
}
constexpr std::int64_t kFewWithoutLevel = 30;

// Interrupts such a trial. It is repeated.
void interrupt_study_trial(Interruption why_interrupted, platform::Window& window, App& app) {
    if (why_interrupted == Interruption::device_gone)
        session::note_event("device_gone", now_of(app, window), app.session);
    if (why_interrupted == Interruption::no_pressure)
        session::note_event("no_pressure", now_of(app, window), app.session);
    if (why_interrupted == Interruption::no_level) session::note_event("no_level", now_of(app, window), app.session);
    app.asked.reset();
    StudyRun& run = *study_of(app.doing);
    const std::string why = close_trial(window, app);
    end_presses(window, app);
    if (!why.empty()) return stop_study(why, run);
    if (why_interrupted == Interruption::untouched) return repeat_untouched(run);
    if (why_interrupted == Interruption::no_level) return repeat_without_level(run);
    if (why_interrupted == Interruption::overslept) return repeat_unseen(run);
    wait_for_device(true, run);
}

// Gives the keeper typed trials and answers too; `keeping_since_s` stays set until it has stored them.
void follow_keeper(double now_s, App& app) {
    if (app.keeper == nullptr) return;
    StudyRun& run = *study_of(app.doing);
    for (const study::RunFiles& typed : run.unkept_runs) app.keeper->keep(typed, true);
    run.unkept_runs.clear();
    if (run.unkept_answers) app.keeper->keep_answers(run.directory, run.code);
    run.unkept_answers = false;
    app.keeper->participant(run.code);
    if (app.keeper->ready())
        run.keeping_since_s.reset();
    else if (!run.keeping_since_s)
        run.keeping_since_s = now_s;
    run.warnings = app.notices.problems;
    if (at<step::Done>(run) || at<step::Withdrawn>(run)) run.where = app.keeper->where(run.code);
}

// A participant must be able to read what is agreed to and asked. Throws InputError.
void check_letters(const study::Protocol& protocol) {
    const std::string file = protocol.file.string();
    for (const ShownText& shown : shown_texts(protocol)) {
        const std::string letter = first_letter_not_shown(shown.text);
        if (letter.empty()) continue;
        throw files::bad_input(file, shown.key, files::shown(letter), letters_shown());
    }
}

}  // namespace

void load_study(const RunOptions& options, App& app) {
    app.settings_path.clear();  // what a study fixes is not kept as a person's choice
    const bool tablet = app.keeper != nullptr;
    // on a tablet the screen refuses a code that has finished, since there is no command line to give another one
    const study::Protocol protocol = study::read_protocol(options.protocol);
    check_letters(protocol);
    // studies that have begun go on as they were
    if (!std::filesystem::exists(std::filesystem::path(options.log) / "protocol.json"))
        study::refuse_mixed_ratings(protocol);
    StudyRun run = open_study_run(protocol, options.log, tablet ? "" : options.participant);
    run.on_tablet = tablet;
    if (tablet) refuse_counts(run.protocol, run.scenes);
    run.first_run = options.first_run;
    if (tablet && !options.participant.empty()) enter_code(options.participant, run);
    app.doing = std::move(run);
    scene::Scene scene = load_scene("");  // shown behind the first screens
    auto plan = std::make_shared<const scene::Plan>(scene::make_plan(scene));
    session::change_tissue(std::move(scene), std::move(plan), {}, app.session);
}

bool repeat_if_unproven(platform::Window& window, App& app) {
    StudyRun& run = *study_of(app.doing);
    if (gives_no_force(app, 0)) {
        interrupt_study_trial(Interruption::no_level, window, app);
        return true;
    }
    note_pressure_of_tool(app, run);
    if (run.pressure == PressureVerdict::ready || run.pressure == PressureVerdict::not_needed) return false;
    run.pressure_must_vary = true;
    interrupt_study_trial(Interruption::no_pressure, window, app);
    return true;
}

// Reveals nothing. The next step comes once the trial is on the disk.
void finish_study_trial(platform::Window& window, App& app) {
    StudyRun& run = *study_of(app.doing);
    const std::string why = close_trial(window, app);
    end_presses(window, app);
    if (!why.empty()) return stop_study(why, run);
    if (due_trial(run).practice && !due_compares(run)) {
        const study::Score score = session::debrief(*app.session.plan, app.session.trial).score;
        give_feedback(score.true_positives, score.false_negatives, score.false_positives, run);
    } else {
        trial_finished(run);
    }
    follow_keeper(now_of(app, window), app);
}

bool felt_elsewhere(const App& app) {
    return (app.tactile.shown && app.tactile.shown->arm_leads) ||
           (app.tangible.shown && app.tangible.shown->device_leads);
}

double trial_ends_s(const App& app) {
    constexpr double kNever_s = std::numeric_limits<double>::infinity();
    const StudyRun* run = study_of(app.doing);
    if (run == nullptr || !trial_goes_on(*run)) return kNever_s;
    const double limit_s = due_limit_s(*run);
    return limit_s > 0.0 ? app.session.trial.began_s + limit_s : kNever_s;
}

void follow_study(const std::optional<StudyWish>& wish, platform::Window& window, const Gui& gui, App& app) {
    StudyRun& run = *study_of(app.doing);
    const bool waited = at<step::Device>(run);
    if (wish) carry_out(*wish, run);
    if (waited && trial_waits(run)) {  // somebody has read why the devices were stopped, and went on
        release_devices(app);
        forget_problems(app);
    }
    follow_keeper(now_of(app, window), app);
    if (trial_waits(run) && !run.keeping_since_s) {
        note_devices(window, app);
        note_pressure_of_tool(app, run);
        note_missing(app, run);
        if (may_begin(app)) {
            begin_study_trial(window, gui, app);
        } else {
            rest_devices(app);
            wait_for_device(false, run);
        }
    }
    if (at<step::Instructions>(run) || at<step::Device>(run)) note_pressure_of_tool(app, run);
    if (auto* device = std::get_if<step::Device>(&run.step)) {
        note_missing(app, run);
        const bool stopped = devices_stopped(app);  // but they could run
        device->connected = is_device_here(app) && (stopped || run.devices_note.empty());
        device->here = stopped || may_begin(app);
    }
    if (!trial_goes_on(run)) return;
    note_pressure_of_tool(app, run);
    if (refuses(run.pressure)) return interrupt_study_trial(Interruption::no_pressure, window, app);
    if (gives_no_force(app, kFewWithoutLevel)) return interrupt_study_trial(Interruption::no_level, window, app);
    if (app.session.trial.touched_s && app.notices.note == words::kTouchFirst) app.notices.note.clear();
    if (!is_device_here(app) || devices_failed(window.now_s(), app))
        return interrupt_study_trial(Interruption::device_gone, window, app);
    const double over_s = now_of(app, window) - trial_ends_s(app);
    if (over_s < 0.0) return;
    if (not_touched(app)) return interrupt_study_trial(Interruption::untouched, window, app);
    if (over_s > kOverslept_s || app.hidden || app.over_unseen)
        return interrupt_study_trial(Interruption::overslept, window, app);
    act(platform::Action::finish, window, app);
}

void note_sight(bool hidden, double now_s, App& app) {
    const StudyRun* run = study_of(app.doing);
    if (!hidden && run != nullptr && trial_goes_on(*run) && now_s >= trial_ends_s(app)) app.over_unseen = true;
    app.hidden = hidden;
}

bool allowed(const platform::Sample& sample, App& app) {
    const study::Modality modality = due_condition(*study_of(app.doing)).modality;
    if (sample.phase == platform::Phase::ui) return true;
    if (felt_elsewhere(app)) return false;
    if (tool_allowed(modality, sample.tool)) return true;
    if (sample.phase == platform::Phase::down) app.notices.note = words::filled(words::kDoneWith, {name_of(modality)});
    return false;
}

files::Json study_json(const App& app) {
    const StudyRun& run = *study_of(app.doing);
    return files::Json{{"participant", run.code},
                       {"step", name_of(run.step)},
                       {"finished", finished_count(run)},
                       {"of", run.progress.plan.trials.size()}};
}

// A trial in progress is logged as interrupted.
files::Json close_study(const platform::Window& window, const Gui& gui, App& app) {
    const StudyRun& run = *study_of(app.doing);
    if (trial_goes_on(run)) {
        const std::string why = close_trial(window, app);
        if (!why.empty()) throw std::runtime_error(why);
    }
    if (at<step::Consent>(run)) forget_unasked(run);
    if (const auto* stopped = std::get_if<step::Stopped>(&run.step)) throw std::runtime_error(stopped->why);
    files::Json json = study_json(app);
    json["overflow"] = gui.overflow();
    return json;
}

}  // namespace palpa::app
