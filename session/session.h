#pragma once
// A session: the scene that is palpated now, the trial on it, and the files that the trial is written to. Each trial is
// a run of its own in the log.

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

// What a session writes.
struct SessionFiles {
    std::string log;  // folder; empty for no log
    std::string participant = "01";
    std::string record;                        // TRACE.tsv, later trials get TRACE-2.tsv and so on; empty for no trace
    bool samples = true;                       // false: only events, marks and settings
    bool sync_rows = true;                     // false: rows are on the disk only once the trial ends, for simulations
    std::optional<study::TrialLabel> label{};  // of a study's trial
    std::string task = "palpation";
    double finger_offset_mm = 0.0;  // by which positions of fingers were moved up; goes into the settings and the trace
    int first_run = 1;              // lower run numbers are taken, elsewhere
    // Where the tissue is drawn from the first sample on, since a study's settings are written before; nothing: on the whole
    // screen of the trace.
    std::optional<scene::ScreenArea> shown{};
};

// What the trials before the present one add to the figures of a run.
struct Totals {
    scene::Counters counters;
    scene::Extremes extremes;  // without the times, which are a trial's own
    std::int64_t backwards = 0, late = 0, duplicates = 0, clock_jumps = 0;  // as in platform::Timeline
};
Totals operator+(const Totals& before, const scene::State& trial);

struct Session {
    scene::Scene scene;
    // Never null. Shared, so that trials do not copy it: the plan of a linear tissue can take hundreds of megabytes.
    std::shared_ptr<const scene::Plan> plan = std::make_shared<const scene::Plan>();
    scene::State state;
    Totals before;                            // of the trials that are over
    std::vector<std::string> pressed_scenes;  // of those trials, by name
    Trial trial;
    std::string device;  // for the log
    int trials = 0;      // that have begun
    std::optional<study::RunFiles> files;
    std::optional<study::SampleLog> log;
    std::optional<study::TrialLog> trial_log;
    std::optional<study::TrialLabel> label;
    bool sync_rows = true;
    double finger_offset_mm = 0.0;
    bool failed = false;  // the settings could not be put on the disk
    std::string began_utc;
    std::int64_t flushed_ns = 0;  // when the log was last flushed, steady clock
    std::optional<platform::TraceWriter> record;
    files::Json ended =
        files::Json::array();  // trial_json() of each trial that was finished, or broken off after a touch
};

// Returns a trace's screen as the area of the tissue; it holds until a sample of action resize.
scene::ScreenArea screen_of(const platform::TraceInfo& info);

// The files of a scene's parts as they are now; none for other tissue.
std::vector<platform::TracedPart> traced_parts(const scene::Scene& scene);

// Puts another tissue into the session: the scene, its plan and a state at rest on them change together, since no frame
// and no sample may see a mixture of old and new. No other function changes session.scene or session.plan. The files of
// the last trial must be closed; no trial has begun afterwards.
void change_tissue(scene::Scene scene, std::shared_ptr<const scene::Plan> plan, const scene::ScreenArea& screen,
                   Session& session);

// Begins a trial on session.scene and session.plan, with a new state and new files. `info` describes the window and the
// device and goes into the trace. Throws InputError or std::runtime_error if a file cannot be made; the session then
// has no files.
void begin_trial(const SessionFiles& files, const platform::TraceInfo& info, TrialMode mode, Session& session);

// Hands the log's rows to the system if that was last done at least 80 ms ago, so that a killed process loses little.
// take_sample() calls it; a loop that waits for samples may call it too.
void flush_if_due(Session& session);

// Records the sample, advances the scene, observes the trial and writes the log. After the sample that finishes the
// trial its results are on the disk. Does nothing once the trial is finished.
void take_sample(const platform::Sample& sample, Session& session);

// Returns trial_json() of each trial that was finished, or broken off after a touch, and of the one that is going on.
files::Json trials_json(const Session& session);

// Returns false once anything could not be written.
bool files_good(const Session& session);

// Logs an event that no sample brings, such as the loss of a device. now_s: host time, as Sample::t_host_s.
void note_event(std::string_view trial_type, double now_s, Session& session);

// Takes the press of a device that leads (scene::device_leads) at a host time: it counts in the trial's force, way and coverage.
void take_device_press(const PressMoment& press, double now_s, Session& session);

// Moves the trial's time on where no sample does; rows that follow are not before it.
void note_time(double now_s, Session& session);

// Puts everything on the disk, with `performance` as the file of that name, and closes the files. A trial that is not
// finished is logged as interrupted, with its marks so far. Returns false if anything could not be written.
bool close_files(const files::Json& performance, Session& session);

}  // namespace palpa::session
