#pragma once
// The arm of `palpa tactile identify` and `characterise`: a real one, the simulator, or one in this process.

#include <filesystem>
#include <limits>
#include <memory>
#include <string>
#include <vector>

#include "devices/simulators/process.h"
#include "files/json.h"
#include "tactile/arm_strokes.h"

namespace CLI {
class App;
}

namespace palpa::app {

struct RigOptions {
    std::string device;  // file; empty: that of the scene, else assets/devices/arm.json
    bool simulate = false;
    bool virtual_time = false;
    std::uint64_t seed = 1;
};
void add_rig_options(CLI::App& command, RigOptions& options);

// The device of the options. The default file names an example address: it is only taken when simulating.
devices::ArmDevice rig_device(const RigOptions& options, const std::filesystem::path& scene_device);

// What a stroke found, and how the link was.
struct RigResult {
    tactile::Strokes strokes;
    std::size_t ticks = 0;
    double round_trip_p50_s = std::numeric_limits<double>::quiet_NaN();  // without a link
    double round_trip_p99_s = std::numeric_limits<double>::quiet_NaN();
    std::int64_t lost = 0;
    double loop_delay_s = 0.0;  // median, from the arm's reading to its next command
};

// Strokes along a path: that of the simulated hand, or what a person is told to do. `what` is shown meanwhile.
RigResult stroke_along(const RigOptions& options, const devices::ArmDevice& device,
                       const std::vector<devices::PressRow>& path, tactile::StrokeOptions stroke,
                       const std::string& what);

files::Json link_json(const RigResult& result);

}  // namespace palpa::app
