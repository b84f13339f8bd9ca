#pragma once
// A calibration session from the command line: levels come from a window or a stream, forces from a sensor, and points
// go to the disk.

#include <memory>
#include <string>
#include <vector>

#include "calibration/record/acquisition.h"
#include "files/json.h"
#include "platform/sample.h"

namespace palpa::app {

// A source of pressure levels: a window or a stream.
class LevelSource {
  public:
    virtual ~LevelSource() = default;
    // Appends the samples that arrived and waits up to `wait_s` for them. Returns false once no more will come.
    virtual bool poll(double wait_s, std::vector<platform::Sample>& out) = 0;
    // Shows what to press next; only a window does anything here.
    virtual void show(calibration::Recording&) {}
};
// Levels as text, put into the field of the samples that `profile` reads; it must outlive the source.
std::unique_ptr<LevelSource> open_level_stream(const std::string& path, const calibration::Profile& profile);
std::unique_ptr<LevelSource> open_level_window();

// Runs the session and returns its result. Throws std::runtime_error if the sensor gives nothing.
files::Json record_calibration(const calibration::RecordArguments& arguments);

// What a session has shown, in words; `missing`: as in calibration::Knowledge.
std::string known_words(bool done, const std::string& missing);

}  // namespace palpa::app
