#pragma once
// Runs a recorded trace without a window, as fast as the machine can. It goes the way of a live trial (session.h), so
// that its log is the log of the recorded trial.

#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "files/json.h"
#include "platform/trace.h"
#include "scene/surface.h"
#include "session/session.h"

namespace palpa::session {

inline constexpr double kVirtualDisplay_Hz = 60.0;

// The greatest lag while the pen was over a nodule: nearer to its centre than its radius plus the indenter's.
struct NodulePass {
    std::string id;
    double lag_m = std::numeric_limits<double>::quiet_NaN();  // NaN: nothing pressed there
};

// A display that shows a frame every 1/60 s of the trace's time.
struct VirtualDisplay {
    std::int64_t frames = 0;
    scene::Meter latency;  // from the time of a sample to the next frame after it
    bool began = false;
    double shown_s = 0.0;  // time of the next frame, on the timeline
    // Nobody sees the surface, so it is computed only to be timed: for every n-th frame; 0 for none.
    int surface_every = 1;
    std::int64_t drawn = 0;  // frames so far, for surface_every
    scene::SurfaceShape surface;
};

// Shows the frames that are due after a sample, which advance() has taken.
void show_due(const scene::Scene& scene, const scene::Plan& plan, scene::State& state, VirtualDisplay& display);

struct ReplayResult {
    VirtualDisplay display;
    std::vector<NodulePass> over;
    // greatest lag while every nodule was farther away than its radius + 4 indenter radii; NaN: nothing pressed there
    double lag_beside_m = std::numeric_limits<double>::quiet_NaN();
};

// Returns the mode of the recorded trial; practice if the trace does not state it.
TrialMode mode_of(const platform::TraceInfo& info);

// Turns the tissue as it was when the trace was recorded, if the trace states it.
void turn_as_recorded(const platform::TraceInfo& info, scene::Scene& scene);

// Empty, or which parts were other ones when the trace was recorded: its forces and depths are not those of the scene.
std::string other_parts(const platform::TraceInfo& info, const scene::Scene& scene);

// Begins the recorded trial on the session's scene: with the tissue turned as it was, with the recorded finger offset,
// and in the recorded mode unless `mode` names another one. Throws as begin_trial().
void begin_replay(SessionFiles files, const platform::TraceInfo& info, std::optional<TrialMode> mode, Session& session);

// Takes the samples of the trace up to the one that finishes the trial, or to the first one at or after `until_s` on
// the state's timeline. The files stay open until close_files().
ReplayResult replay(const platform::Trace& trace, Session& session, double until_s = 1e300);

// Returns the keys that every run reports, of all its trials (docs/formats.md).
files::Json run_json(const Session& session, std::int64_t frames, const scene::Meter& latency);

// Returns them of the present trial alone: nothing in it is of an earlier trial.
files::Json trial_run_json(const Session& session, std::int64_t frames, const scene::Meter& latency);

// Returns the keys of run_json() for a replay, and beside them the lag over and beside the nodules, and the trials.
files::Json result_json(const Session& session, const ReplayResult& result);

}  // namespace palpa::session
