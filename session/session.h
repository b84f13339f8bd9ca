#pragma once
// The scene that is palpated now, the trial on it, and the files that it is written to: one run of the log per trial.

#include <memory>
#include <optional>
#include <string>
#include <string_view>

#include "platform/trace.h"
#include "scene/scene.h"
#include "scene/state.h"
#include "session/trial.h"
#include "study/sample_log.h"
#include "study/trial_log.h"

namespace palpa::session {

// What a session writes; empty: nothing.
struct SessionFiles {
    std::string log;  // folder
    std::string participant = "01";
    std::string record;                        // TRACE.tsv; later trials get TRACE-2.tsv and so on
    bool samples = true;                       // false: events, marks and settings only
    bool sync_rows = true;                     // false: rows are on the disk when the trial ends, for simulations
    std::optional<study::TrialLabel> label{};  // of a study's trial
    std::string task = "palpation";
    double finger_offset_mm = 0.0;  // positions of fingers were moved up by this, for the settings
    int first_run = 1;              // runs before it are known to be taken, elsewhere
};

struct Session {
    scene::Scene scene;
    // Never null. Shared with whoever made it: that of a linear tissue takes 23 to 226 MB, and trials copy none of it.
    std::shared_ptr<const scene::Plan> plan = std::make_shared<const scene::Plan>();
    scene::State state;
    Trial trial;
    std::string device;  // for the log
    int trials = 0;      // begun
    std::optional<study::RunFiles> files;
    std::optional<study::SampleLog> log;
    std::optional<study::TrialLog> trial_log;
    std::optional<study::TrialLabel> label;
    bool sync_rows = true;
    double finger_offset_mm = 0.0;
    bool failed = false;  // settings could not be put on the disk
    std::string began_utc;
    std::int64_t flushed_ns = 0;  // steady clock
    std::optional<platform::TraceWriter> record;
    files::Json finished = files::Json::array();  // trial_json of each finished trial
};

// A trace's screen as the area of the tissue, until a sample of action resize says otherwise.
scene::ScreenArea screen_of(const platform::TraceInfo& info);

// Puts another tissue under the hand: scene, plan and a state at rest on them, all three together, since no frame and
// no sample may meet one of them with another's. The only function that changes session.scene and session.plan. No
// trial has begun then; the files of the last one must be closed.
void change_tissue(scene::Scene scene, std::shared_ptr<const scene::Plan> plan, const scene::ScreenArea& screen,
                   Session& session);

// Begins a trial on session.scene and session.plan: a new state, new files. `info`: the window, as it goes into the
// trace. Throws InputError or std::runtime_error if a file cannot be made; the session then has no files.
void begin_trial(const SessionFiles& files, const platform::TraceInfo& info, TrialMode mode, Session& session);

// Hands what was logged to the system if that was last done 80 ms ago: what a killed process loses. take_sample() calls
// it; a loop that waits for samples may too.
void flush_if_due(Session& session);

// Advances, observes, writes. After the sample that finishes the trial its results are on the disk.
void take_sample(const platform::Sample& sample, Session& session);

// trial_json of each finished trial, and of the one that goes on.
files::Json trials_json(const Session& session);

// False once anything could not be written.
bool files_good(const Session& session);

// A row of the events that no sample brings, such as that a device has gone.
void note_event(std::string_view trial_type, double now_s, Session& session);

// Puts everything on the disk, `performance` included, and closes the files. A trial that is not finished is logged as
// interrupted, with the marks that stand. Returns false if some of it failed.
bool close_files(const files::Json& performance, Session& session);

}  // namespace palpa::session
