#pragma once
// A calibration session from the command line: levels from a window or a stream, forces from a sensor, points on disk.

#include <memory>
#include <string>
#include <vector>

#include "calibration/profile.h"
#include "calibration/record_session.h"
#include "devices/force_sensor.h"
#include "files/json.h"
#include "platform/sample.h"

namespace palpa {

struct RecordArguments {
    std::string folder;
    std::string sensor;            // netft:HOST[:PORT], serial:PATH, typed
    std::string levels;            // a file or pipe with one level a line, "-" for standard input; empty: a window
    double counts_per_N = 1e6;     // netft
    std::string axis = "-z";       // netft
    double N_per_count = 0.0;      // serial
    int baud = 115200;
    double seconds = 0.0;          // 0: until it is known, or ended
    bool resume = false;
    bool newton = false;           // typed numbers are newtons, not gram-force
    Profile level;                 // which field of a sample is the level, and its range
    RecordOptions options;
};

struct Recording;

inline constexpr double kN_per_gf = 9.80665e-3;

// Where levels come from.
class LevelSource {
 public:
    virtual ~LevelSource() = default;
    // Appends what arrived; waits up to `wait_s`. False once there will be no more.
    virtual bool poll(double wait_s, std::vector<Sample>& out) = 0;
    // A window shows what to press next; a stream has nobody to show it to.
    virtual void show(Recording&) {}
};
std::unique_ptr<LevelSource> open_level_stream(const std::string& path);  // level in Sample::pressure
std::unique_ptr<LevelSource> open_level_window();

// Runs the session; what came of it. Throws std::runtime_error when the sensor gives nothing.
Json record_calibration(const RecordArguments& arguments);

}  // namespace palpa
