#pragma once
// A recorded trace, run as fast as it goes, without a window.

#include <functional>
#include <vector>

#include "files/json.h"
#include "platform/trace.h"
#include "scene/advance.h"
#include "study/sample_log.h"

namespace palpa::session {

inline constexpr double kVirtualDisplay_Hz = 60.0;

// The greatest lag while the pen was over a nodule: within its radius + the indenter's radius of its centre.
struct NodulePass {
    std::string id;
    double lag_m = 0.0;
};

struct ReplayResult {
    scene::State state;
    std::int64_t frames = 0;  // of a virtual display that shows every 1/60 s of the trace's time
    scene::Meter latency;     // from a sample's time to the virtual frame that shows it, ns
    std::vector<NodulePass> over;
    double lag_beside_m = 0.0;  // greatest lag farther than radius + 4 indenter radii from every nodule
};

// Called after every sample.
using AfterSample = std::function<void(const platform::Sample& sample, const scene::State& state)>;

// `time_every`: see State. Stops after the first sample at or after `until_s` (time of the state's timeline).
ReplayResult replay(const scene::Scene& scene, const scene::Plan& plan, const platform::Trace& trace, int time_every,
                    const AfterSample& after_sample = {}, double until_s = 1e300);

// The keys that every run reports (docs/formats.md).
files::Json run_json(const scene::Scene& scene, const scene::Plan& plan, const scene::State& state, std::int64_t frames,
                     const scene::Meter& latency);

// The same for a replay, with the lag over and beside the nodules.
files::Json result_json(const scene::Scene& scene, const scene::Plan& plan, const ReplayResult& result);

}  // namespace palpa::session
