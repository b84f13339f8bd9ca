#pragma once
// The trace of a simulated pen that sweeps the tissue line by line, for benchmarks and for machines without a pen.

#include <cstdint>
#include <functional>

#include "platform/trace.h"
#include "scene/plan.h"

namespace palpa::session {

struct RasterOptions {
    double rate_Hz = 120.0;
    double seconds = 40.0;  // lines are repeated until this time has passed; the last one is finished
    double speed_m_per_s = 0.03;
    double force_N = 2.5;  // swings by a tenth; firm, since at 1.5 N the shipped map's smallest nodule causes no lag
    double screen_width_px = 1280.0;
    double screen_height_px = 800.0;
    std::uint32_t seed = 1;  // of the jitter, 0.02 mm rms along x and along y
};

platform::TraceInfo raster_info(const RasterOptions& options);

// Lines through each nodule of the plan along x and along y, and some beside them; every second line is drawn backwards.
// Each sample is handed to `take` as it is made, so that a trace of hours needs no memory.
void draw_raster(const scene::Scene& scene, const scene::Plan& plan, const RasterOptions& options,
                 const std::function<void(const platform::Sample&)>& take);

// The same as a trace in memory.
platform::Trace raster_trace(const scene::Scene& scene, const scene::Plan& plan, const RasterOptions& options);

}  // namespace palpa::session
