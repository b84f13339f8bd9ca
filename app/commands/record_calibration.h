#pragma once
// A calibration session from the command line: levels from a window or a stream, forces from a sensor, points on disk.

#include <memory>
#include <string>
#include <vector>

#include "calibration/record/acquisition.h"
#include "files/json.h"
#include "platform/sample.h"

namespace palpa::app {

// Where levels come from.
class LevelSource {
  public:
    virtual ~LevelSource() = default;
    // Appends what arrived; waits up to `wait_s`. False once there will be no more.
    virtual bool poll(double wait_s, std::vector<platform::Sample>& out) = 0;
    // A window shows what to press next; a stream has nobody to show it to.
    virtual void show(calibration::Recording&) {}
};
std::unique_ptr<LevelSource> open_level_stream(const std::string& path);  // level in Sample::pressure
std::unique_ptr<LevelSource> open_level_window();

// Runs the session; what came of it. Throws std::runtime_error when the sensor gives nothing.
files::Json record_calibration(const calibration::RecordArguments& arguments);

}  // namespace palpa::app
