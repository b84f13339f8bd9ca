#pragma once
// A simulated pen that sweeps the tissue line by line: for benchmarks, and for a machine without a pen.

#include <cstdint>

#include "platform/trace.h"
#include "scene/plan.h"

namespace palpa::session {

struct RasterOptions {
    double rate_Hz = 120.0;
    double seconds = 40.0;  // lines are repeated until then; cut at the end of a line
    double speed_m_per_s = 0.03;
    double force_N = 2.5;  // swings by a tenth; firm: at 1.5 N the default map's smallest nodule makes no lag
    double screen_width_px = 1280.0;
    double screen_height_px = 800.0;
    std::uint32_t seed = 1;  // of 0.02 mm rms of jitter
};

// Lines through each placed nodule along x and along y, and lines beside them, in turn from both sides.
platform::Trace raster_trace(const scene::Scene& scene, const scene::Plan& plan, const RasterOptions& options);

}  // namespace palpa::session
