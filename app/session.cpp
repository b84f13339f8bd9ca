#include "app/session.h"

#include <cmath>
#include <exception>

#include "app/log.h"
#include "files/text.h"
#include "scene/advance.h"

namespace palpa {
namespace {

const char* condition_of(const Scene& scene) {
    if (scene.display_ratio) return "display_ratio";
    return scene.delay ? "delay" : "none";
}

const char* event_name(Action action) {
    switch (action) {
        case Action::none: return "start";
        case Action::mark: return "mark";
        case Action::undo: return "undo";
        case Action::finish: return "finish";
        case Action::resize: return "resize";
        default: return "confidence";
    }
}

EventRow event_row(const Session& session, Action action) {
    const Scene& scene = session.scene;
    EventRow row;
    row.onset_s = session.trial.now_s - session.trial.began_s;
    row.trial_type = event_name(action);
    row.block = name_of(session.trial.mode);
    row.condition = condition_of(scene);
    row.device_id = session.device;
    row.calibration_id = session.plan.profile.id;
    row.map_id = session.plan.tissue_name;
    row.map_rotation_deg = scene.mapping.rotate_deg;
    row.map_flip = scene.mapping.flip ? 1 : 0;
    row.seed = scene.seed;
    row.n_nodules = static_cast<std::int64_t>(session.plan.nodules.size());
    return row;
}

void write_marks(const Score& score, Session& session) {
    for (std::size_t i = 0; i < session.trial.marks.size(); ++i) {
        const Mark& mark = session.trial.marks[i];
        const MarkScore& found = score.marks[i];
        MarkRow row;
        row.onset_s = mark.onset_s;
        row.mark = static_cast<std::int64_t>(i) + 1;
        row.x_mm = 1e3 * mark.p_m.x();
        row.y_mm = 1e3 * mark.p_m.y();
        if (mark.confidence > 0) row.confidence = mark.confidence;
        if (found.target >= 0) {
            row.nodule = session.plan.nodules[static_cast<std::size_t>(found.target)].id;
            row.distance_mm = 1e3 * found.distance_m;
        }
        row.hit = found.kind == MarkKind::hit ? 1 : 0;
        session.trial_log->write(row);
    }
}

void write_event(const Sample& sample, Session& session) {
    if (!session.trial_log || sample.phase != Phase::ui || sample.action == Action::resize) return;
    EventRow row = event_row(session, sample.action);
    if (sample.action == Action::finish) {
        const Score score = debrief(session.plan, session.trial).score;
        write_marks(score, session);  // first the marks, then the row that says that they are complete
        row.duration_s = row.onset_s;
        row.true_positives = score.true_positives;
        row.false_positives = score.false_positives;
        row.false_negatives = score.false_negatives;
    }
    session.trial_log->write(row);
}

std::filesystem::path trace_name(const std::string& first, int trial) {
    std::filesystem::path path = first;
    if (trial > 1) path.replace_filename(path.stem().string() + "-" + std::to_string(trial) + path.extension().string());
    return path;
}

void drop_files(Session& session) {
    session.record.reset();
    session.trial_log.reset();
    session.log.reset();
    session.files.reset();
}

void open_files(const SessionFiles& files, const TraceInfo& info, Session& session) {
    drop_files(session);
    try {
        if (!files.record.empty()) session.record.emplace(trace_name(files.record, session.trials), info);
        if (files.log.empty()) return;
        session.files = next_run(files.log, files.participant);
        session.log.emplace(*session.files);
        session.trial_log.emplace(*session.files);
    } catch (...) {
        drop_files(session);
        throw;
    }
}

}  // namespace

ScreenArea screen_of(const TraceInfo& info) {
    ScreenArea area{info.screen_width_px, info.screen_height_px};
    if (std::isfinite(info.screen_width_mm)) area.px_per_m = 1e3 * info.screen_width_px / info.screen_width_mm;
    return area;
}

void begin_trial(const SessionFiles& files, const TraceInfo& info, TrialMode mode, Session& session) {
    ++session.trials;
    session.state = start(session.scene, session.plan, screen_of(info));
    session.state.time_every = 16;
    session.trial = make_trial(session.plan, mode);
    session.device = info.device;
    open_files(files, info, session);
    if (session.trial_log) session.trial_log->write(event_row(session, Action::none));
}

void take_sample(const Sample& sample, Session& session) {
    if (session.trial.finished) return;
    if (session.record) session.record->write(sample);
    advance(session.scene, session.plan, sample, session.state);
    observe(session.plan, sample, session.state, session.trial);
    if (session.log) session.log->write(row_of(sample, session.plan, session.state));
    write_event(sample, session);
    if (!session.trial.finished) return;
    session.finished.push_back(trial_json(session.plan, session.trial));
    if (session.record) session.record->sync();
    if (session.log) session.log->sync();
}

bool files_good(const Session& session) {
    return !(session.record && session.record->failed()) && !(session.log && session.log->failed()) &&
           !(session.trial_log && session.trial_log->failed());
}

bool close_files(const Json& performance, Session& session) {
    if (session.record) session.record->sync();
    if (session.log) session.log->sync();
    bool good = files_good(session);
    if (session.files && good) {
        try {
            const Json settings = settings_json(session.scene, session.plan, session.state);
            write_text_atomically(session.files->file("_settings.json"), json_text(settings));
            write_text_atomically(session.files->file("_performance.json"), json_text(performance));
        } catch (const std::exception&) {
            good = false;
        }
    }
    drop_files(session);
    return good;
}

}  // namespace palpa
