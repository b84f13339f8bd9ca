#pragma once
// A recorded trace, run as fast as it goes, without a window. It goes the way of a live trial (session.h), so its log is
// the log of the trial that was recorded.

#include <optional>
#include <vector>

#include "files/json.h"
#include "platform/trace.h"
#include "scene/surface.h"
#include "session/session.h"

namespace palpa::session {

inline constexpr double kVirtualDisplay_Hz = 60.0;

// The greatest lag while the pen was over a nodule: within its radius + the indenter's radius of its centre.
struct NodulePass {
    std::string id;
    double lag_m = 0.0;
};

// A display that shows every 1/60 s of the trace's time.
struct VirtualDisplay {
    std::int64_t frames = 0;
    scene::Meter latency;  // from a sample's time to the frame that shows it, ns
    bool began = false;
    double shown_s = 0.0;  // time of the next frame
    // Nobody sees the surface, so it is only computed to be timed: for every n-th frame; 0: for none.
    int surface_every = 1;
    std::int64_t drawn = 0;
    scene::SurfaceShape surface;
};

// The frames that are due after a sample.
void show_due(const scene::Scene& scene, const scene::Plan& plan, scene::State& state, VirtualDisplay& display);

struct ReplayResult {
    VirtualDisplay display;
    std::vector<NodulePass> over;
    double lag_beside_m = 0.0;  // greatest lag farther than radius + 4 indenter radii from every nodule
};

// The mode of the recorded trial; practice where the trace does not say.
TrialMode mode_of(const platform::TraceInfo& info);

// Turns the tissue as it lay when the trace was recorded, where the trace says it.
void turn_as_recorded(const platform::TraceInfo& info, scene::Scene& scene);

// Begins the trial that was recorded, on the session's scene: turned as it lay then, with the recorded finger offset, and
// in the recorded mode unless `mode` names another one.
void begin_replay(SessionFiles files, const platform::TraceInfo& info, std::optional<TrialMode> mode, Session& session);

// Takes the samples of the trace up to the one that finishes the trial, or to the first at or after `until_s` (time of
// the state's timeline). The files stay open, for close_files().
ReplayResult replay(const platform::Trace& trace, Session& session, double until_s = 1e300);

// The keys that every run reports (docs/formats.md).
files::Json run_json(const scene::Scene& scene, const scene::Plan& plan, const scene::State& state, std::int64_t frames,
                     const scene::Meter& latency);

// The same for a replay, with the lag over and beside the nodules, and the trial.
files::Json result_json(const Session& session, const ReplayResult& result);

}  // namespace palpa::session
