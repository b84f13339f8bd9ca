#include "session/session.h"

#include <algorithm>
#include <cmath>
#include <exception>
#include <utility>

#include "files/clock.h"
#include "files/sha256.h"
#include "files/text.h"
#include "scene/advance.h"
#include "scene/tissue.h"
#include "session/log_rows.h"

namespace palpa::session {
namespace {

const char* condition_of(const scene::Scene& scene) {
    if (scene.display_ratio) return "display_ratio";
    return scene.delay ? "delay" : "none";
}

const char* event_name(platform::Action action) {
    switch (action) {
        case platform::Action::none:
            return "start";
        case platform::Action::mark:
            return "mark";
        case platform::Action::undo:
            return "undo";
        case platform::Action::finish:
            return "finish";
        case platform::Action::resize:
            return "resize";
        case platform::Action::hidden:
            return "hidden";
        case platform::Action::shown:
            return "shown";
        case platform::Action::pause:
            return "pause";
        case platform::Action::resume:
            return "resume";
        case platform::Action::method:
            return "method";
        default:
            return "confidence";
    }
}

study::EventRow event_row(const Session& session, platform::Action action) {
    const scene::Scene& scene = session.scene;
    study::EventRow row;
    row.onset_s = session.trial.now_s - session.trial.began_s;
    row.trial_type = event_name(action);
    // a surface of a practised pair hides its maps as a test does
    row.block = !session.label ? name_of(session.trial.mode) : session.label->practice ? "practice" : "test";
    row.condition = session.label ? std::string_view(session.label->condition) : condition_of(scene);
    row.device_id = session.label ? std::string_view(session.label->device) : std::string_view(session.device);
    if (session.label) {
        row.trial = session.label->trial;
        row.order_id = session.label->order_id;
    }
    row.calibration_id = session.plan->profile.id;
    row.map_id = session.plan->tissue_name;
    row.map_rotation_deg = scene.mapping.rotate_deg;
    row.map_flip = scene.mapping.flip ? 1 : 0;
    row.seed = scene.seed;
    row.n_nodules = static_cast<std::int64_t>(session.plan->nodules.size());
    return row;
}

void write_marks(const study::Score& score, Session& session) {
    for (std::size_t i = 0; i < session.trial.marks.size(); ++i) {
        const Mark& mark = session.trial.marks[i];
        const study::MarkScore& found = score.marks[i];
        study::MarkRow row;
        if (session.label) row.trial = session.label->trial;
        row.onset_s = mark.onset_s;
        row.mark = static_cast<std::int64_t>(i) + 1;
        row.x_mm = 1e3 * mark.p_m.x();
        row.y_mm = 1e3 * mark.p_m.y();
        if (mark.confidence > 0) row.confidence = mark.confidence;
        if (found.target >= 0) {
            row.nodule = session.plan->nodules[static_cast<std::size_t>(found.target)].id;
            row.distance_mm = 1e3 * found.distance_m;
        }
        row.hit = found.kind == study::MarkKind::hit ? 1 : 0;
        session.trial_log->write(row);
    }
}

void sync_all_but_events(Session& session) {
    if (session.label) {
        try {
            files::sync_file(session.files->file("_settings.json"));
        } catch (const std::exception&) {
            session.failed = true;
        }
    }
    if (session.log) session.log->sync();
    session.trial_log->sync_marks();
}

void write_event(const platform::Sample& sample, std::size_t marks_before, Session& session) {
    if (!session.trial_log || sample.phase != platform::Phase::ui || sample.action == platform::Action::resize) return;
    if (sample.action == platform::Action::method && session.state.method == nullptr) return;  // it changed nothing
    study::EventRow row = event_row(session, sample.action);
    if (sample.action == platform::Action::method) row.condition = session.state.method;
    if (sample.action == platform::Action::mark && session.trial.marks.size() > marks_before) {
        row.x_mm = 1e3 * session.trial.marks.back().p_m.x();
        row.y_mm = 1e3 * session.trial.marks.back().p_m.y();
    }
    if (sample.action == platform::Action::finish) {
        const study::Score score = debrief(*session.plan, session.trial).score;
        write_marks(score, session);
        sync_all_but_events(session);  // before the row that tells readers that the trial is complete
        if (!files_good(session)) return;
        row.duration_s = row.onset_s;
        row.true_positives = score.true_positives;
        row.false_positives = score.false_positives;
        row.false_negatives = score.false_negatives;
        row.path_mm = 1e3 * session.trial.pressed_m;
        row.mean_force_N = mean_force_N(session.trial);
        row.max_force_N = session.trial.max_force_N;
    }
    session.trial_log->write(row);
    if (sample.action == platform::Action::finish) session.trial_log->sync_events();
}

// Logs the marks of a trial that ends without being finished, whatever the cause: they count for no result, but are
// kept.
void log_interruption(Session& session) {
    if (!session.trial_log || session.trial.finished) return;
    write_marks(debrief(*session.plan, session.trial).score, session);
    session.trial_log->sync_marks();
    note_event("interrupted", session.trial.now_s, session);
    session.trial_log->sync_events();
}

std::filesystem::path trace_name(const std::string& first, int trial) {
    std::filesystem::path path = first;
    if (trial > 1)
        path.replace_filename(path.stem().string() + "-" + std::to_string(trial) + path.extension().string());
    return path;
}

files::Json settings_of(const Session& session) {
    files::Json settings = settings_json(session.scene, *session.plan, session.state);
    if (session.finger_offset_mm != 0.0) settings["finger_offset_mm"] = session.finger_offset_mm;
    return settings;
}

void write_settled(const std::filesystem::path& file, const files::Json& json, const Session& session) {
    if (session.sync_rows) return files::write_text_atomically(file, files::json_text(json));
    files::write_text_whole(file, files::json_text(json));
}

void drop_files(Session& session) {
    session.record.reset();
    session.trial_log.reset();
    session.log.reset();
    session.failed = false;
    session.files.reset();
}

// Adds to the trace's description what the log depends on besides the samples, so that a replay logs the same.
platform::TraceInfo with_trial(platform::TraceInfo info, const Session& session) {
    info.mode = name_of(session.trial.mode);
    info.finger_offset_mm = session.finger_offset_mm;
    info.turn = platform::TissueTurn{session.scene.mapping.rotate_deg, session.scene.mapping.flip};
    info.parts = traced_parts(session.scene);
    return info;
}

void open_files(const SessionFiles& files, const platform::TraceInfo& info, Session& session) {
    drop_files(session);
    try {
        if (!files.record.empty()) {
            session.record.emplace(trace_name(files.record, session.trials), with_trial(info, session));
        }
        if (files.log.empty()) return;
        session.files = study::next_run(files.log, files.participant, files.task, files.first_run);
        const bool alone = !files.label;  // a study explains the columns once, in its top folder
        if (files.label) {
            files::Json settings = settings_of(session);
            settings["study"] = files.label->study;
            write_settled(session.files->file("_settings.json"), settings, session);  // before the first sample
        }
        if (files.samples) session.log.emplace(*session.files, alone);
        session.trial_log.emplace(*session.files, study::LogOptions{files.sync_rows, alone});
    } catch (...) {
        drop_files(session);
        throw;
    }
}

// Where the tissue was last pressed stays there, also where the window draws the tissue elsewhere since.
void keep_last_place(const scene::View& before, const scene::View& now, Trial& trial) {
    const bool same = before.centre_px == now.centre_px && before.input_px_per_m == now.input_px_per_m;
    if (same || !trial.last_px) return;
    const Eigen::Vector2d p_m = scene::tissue_of_px(before, *trial.last_px);
    trial.last_px = now.centre_px + now.input_px_per_m.cwiseProduct(now.axes * (p_m - now.area.centre_m));
}

// Before trial and state are replaced: a trial that was not finished stays in the list, and its counts in those of the run.
void add_to_totals(Session& session) {
    if (session.trial.touched_s && !session.trial.finished)
        session.ended.push_back(trial_json(*session.plan, session.trial));
    std::vector<std::string>& pressed = session.pressed_scenes;
    const std::string& name = session.scene.name;
    if (session.state.extremes.force_N > 0.0 && std::find(pressed.begin(), pressed.end(), name) == pressed.end())
        pressed.push_back(name);
    session.before = session.before + session.state;
}

}  // namespace

std::vector<platform::TracedPart> traced_parts(const scene::Scene& scene) {
    std::vector<platform::TracedPart> out;
    if (const scene::PartOptions* parts = scene::part_options(scene.tissue)) {
        for (const std::filesystem::path& design : parts->designs)
            out.push_back({design.filename().string(), files::sha256_of_file(design)});
    }
    return out;
}

scene::ScreenArea screen_of(const platform::TraceInfo& info) {
    scene::ScreenArea area{info.screen_width_px, info.screen_height_px};
    if (std::isfinite(info.screen_width_mm)) area.px_per_m = 1e3 * info.screen_width_px / info.screen_width_mm;
    return area;
}

Totals operator+(const Totals& before, const scene::State& trial) {
    Totals sum = before;
    sum.counters += trial.counters;
    sum.extremes.force_N = std::max(before.extremes.force_N, trial.extremes.force_N);
    sum.extremes.depth_m = std::max(before.extremes.depth_m, trial.extremes.depth_m);
    sum.extremes.lag_m = std::max(before.extremes.lag_m, trial.extremes.lag_m);
    sum.backwards += trial.timeline.backwards;
    sum.late += trial.timeline.late;
    sum.duplicates += trial.timeline.duplicates;
    sum.clock_jumps += trial.timeline.clock_jumps;
    return sum;
}

void change_tissue(scene::Scene scene, std::shared_ptr<const scene::Plan> plan, const scene::ScreenArea& screen,
                   Session& session) {
    scene::State state = scene::start(scene, *plan, screen);
    add_to_totals(session);
    Trial trial = make_trial(*plan, session.trial.mode);
    session.scene = std::move(scene);
    session.plan = std::move(plan);
    session.state = std::move(state);
    session.trial = std::move(trial);
}

void begin_trial(const SessionFiles& files, const platform::TraceInfo& info, TrialMode mode, Session& session) {
    ++session.trials;
    add_to_totals(session);
    session.state = scene::start(session.scene, *session.plan, files.shown.value_or(screen_of(info)));
    session.state.time_every = 16;
    session.trial = make_trial(*session.plan, mode);
    session.device = info.device;
    session.label = files.label;
    session.sync_rows = files.sync_rows;
    session.finger_offset_mm = files.finger_offset_mm;
    session.began_utc = files::utc_now();
    open_files(files, info, session);
    if (session.trial_log) session.trial_log->write(event_row(session, platform::Action::none));
}

void take_sample(const platform::Sample& sample, Session& session) {
    if (session.trial.finished) return;
    if (session.record) session.record->write(sample);
    const scene::View before = session.state.view;
    const std::optional<std::int64_t> switched = scene::switch_events(session.plan->tissue, session.state.tissue);
    scene::advance(session.scene, *session.plan, sample, session.state);
    keep_last_place(before, session.state.view, session.trial);
    const std::size_t marks_before = session.trial.marks.size();
    observe(*session.plan, sample, session.state, session.trial);
    if (session.log) {
        study::SampleRow row = row_of(sample, session.scene, *session.plan, session.state);
        if (session.label) row.trial = session.label->trial;
        session.log->write(row);
    }
    write_event(sample, marks_before, session);
    if (switched && scene::switch_events(session.plan->tissue, session.state.tissue) > switched)
        note_event("switch_on", session.trial.now_s, session);
    flush_if_due(session);
    if (!session.trial.finished) return;
    session.ended.push_back(trial_json(*session.plan, session.trial));
    if (session.record) session.record->sync();
    if (session.log) session.log->sync();
}

void flush_if_due(Session& session) {
    constexpr std::int64_t kEvery_ns = 80'000'000;
    if (!session.log) return;
    const std::int64_t now_ns = scene::steady_ns();
    if (now_ns - session.flushed_ns < kEvery_ns) return;
    session.log->flush();
    session.flushed_ns = now_ns;
}

files::Json trials_json(const Session& session) {
    files::Json trials = session.ended;
    if (!session.trial.finished) trials.push_back(trial_json(*session.plan, session.trial));
    return trials;
}

bool files_good(const Session& session) {
    return !(session.record && session.record->failed()) && !(session.log && session.log->failed()) &&
           !(session.trial_log && session.trial_log->failed()) && !session.failed;
}

void take_device_press(const PressMoment& press, double now_s, Session& session) {
    const Trial& trial = session.trial;
    if (trial.finished || !trial.began || trial.paused_at_s) return;
    observe_device(*session.plan, press, now_s, session.trial);
    scene::Extremes& extremes = session.state.extremes;
    extremes.force_N = std::max(extremes.force_N, press.force_N);
    extremes.depth_m = std::max(extremes.depth_m, press.depth_m);
}

void note_time(double now_s, Session& session) {
    if (session.trial.began && !session.trial.finished) session.trial.now_s = std::max(session.trial.now_s, now_s);
}

void note_event(std::string_view trial_type, double now_s, Session& session) {
    if (!session.trial_log) return;
    note_time(now_s, session);
    study::EventRow row = event_row(session, platform::Action::none);
    row.trial_type = trial_type;
    session.trial_log->write(row);
}

bool close_files(const files::Json& performance, Session& session) {
    log_interruption(session);
    if (session.record) session.record->sync();
    if (session.log) session.log->sync();
    bool good = files_good(session);
    if (session.files && good) {
        try {
            if (!session.label) {
                files::write_text_atomically(session.files->file("_settings.json"),
                                             files::json_text(settings_of(session)));
            }
            files::Json with_clock = performance;
            with_clock["began_utc"] = session.began_utc;
            write_settled(session.files->file("_performance.json"), with_clock, session);
        } catch (const std::exception&) {
            good = false;
        }
    }
    drop_files(session);
    return good;
}

}  // namespace palpa::session
