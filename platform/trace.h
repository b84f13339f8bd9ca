#pragma once
// Recorded input: one tab-separated row per sample, and a JSON sidecar of the same name that says on which screen, and
// in what kind of trial, it was recorded. A whole run can be replayed from its trace.

#include <filesystem>
#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "files/append_file.h"
#include "platform/sample.h"

namespace palpa::platform {

// How the tissue was turned on the screen (scene/mapping.h).
struct TissueTurn {
    int rotate_deg = 0;  // 0, 90, 180, 270
    bool flip = false;
};

// A part that was pressed, as its file was then: people change parts between presses.
struct TracedPart {
    std::string file;    // its name, without folder
    std::string sha256;  // of its bytes
};

struct TraceInfo {
    double screen_width_px = 0.0;
    double screen_height_px = 0.0;
    double screen_width_mm = kMissing;
    double screen_height_mm = kMissing;
    std::string device;
    // Device loops that ran with it. The input of the loop NAME is in X.NAME.tsv (session/device_rows.h).
    std::vector<std::string> device_loops{};
    // The recorded trial, so that a replay logs the same. Traces without a trial, and older ones, lack these.
    std::string mode{};             // practice or test; empty: not recorded
    double finger_offset_mm = 0.0;  // by which positions of fingers were moved up
    std::optional<TissueTurn> turn{};
    std::vector<TracedPart> parts{};  // of a scene of parts
};

struct Trace {
    TraceInfo info;
    std::vector<Sample> samples;
};

// Reads X.tsv and X.json. Throws InputError with file, line and column.
Trace read_trace(const std::filesystem::path& tsv);

// Writes a trace NAME.tsv and its NAME.json while samples arrive, and overwrites nothing. The constructor throws
// InputError for a name that cannot be used, std::runtime_error if a file cannot be written.
class TraceWriter {
  public:
    TraceWriter(const std::filesystem::path& tsv, const TraceInfo& info);
    void write(const Sample& sample);
    bool sync() { return file_.sync(); }
    bool failed() const { return file_.failed(); }

  private:
    files::AppendFile file_;
    std::string row_;
};

}  // namespace palpa::platform
