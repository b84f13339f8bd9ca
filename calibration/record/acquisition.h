#pragma once
// A calibration that is being recorded: pen and force sensor in, points and both raw streams on disk. It has no window
// and no terminal, so that the command line and the app's screen drive the same session.

#include <memory>
#include <optional>
#include <string>
#include <vector>

#include "calibration/profile.h"
#include "calibration/record_session.h"
#include "devices/sensor_reader.h"
#include "files/append_file.h"
#include "files/folder_lock.h"
#include "files/json.h"
#include "platform/sample.h"
#include "platform/timeline.h"

namespace palpa::calibration {

inline constexpr double kN_per_gf = 9.80665e-3;

struct RecordArguments {
    std::string folder;
    std::string sensor;         // netft:HOST[:PORT], serial:PATH, typed
    std::string levels;         // a file or pipe with one level per line, "-" for standard input; empty: a window
    double counts_per_N = 1e6;  // netft
    std::string axis = "-z";    // netft
    double N_per_count = 0.0;   // serial
    int baud = 115200;
    double seconds = 0.0;  // 0: until the curve is known, or the person ends it
    bool resume = false;
    bool newton = false;  // typed numbers are newtons, not gram-force
    Profile level;        // says which field of a sample is the level, and its range
    RecordOptions options;
};

// Both streams as they arrived, synced to the disk once a second. Each run has files of its own.
struct RawFiles {
    files::AppendFile levels;
    files::AppendFile forces;
    std::string row;

    explicit RawFiles(const std::filesystem::path& folder);
    void write(const platform::Sample& sample, double level);
    void write(const devices::ForceReading& reading);
    void sync();  // throws std::runtime_error if something could not be written
};

struct Recording {
    RecordArguments arguments;
    std::optional<files::FolderLock> lock;          // two recordings would replace each other's points
    std::unique_ptr<devices::SensorReader> sensor;  // null: forces are typed
    std::optional<RawFiles> raw;
    RecordSession session;
    Knowledge knowledge;
    // When samples really arrived: a slow frame delays their arrival, but not their device's clock.
    platform::Timeline timeline;
    double began_s = 0.0;
    double synced_s = 0.0;
    double touched_s = -1.0;  // when a touch last ended
    std::int64_t samples = 0;
    std::int64_t readings = 0;
    std::size_t resumed = 0;    // number of points from earlier runs
    std::size_t zero_at = 0;    // the zero is measured while there are so many points: at the start, after a silence
    int known_repeats = -1;     // the repeat whose end was judged last
    bool judged = false;        // a press ended in the last step
    bool silent = false;        // the sensor has stopped; nothing is captured until it returns
    bool invalid = false;       // the sensor says that its forces are invalid; nothing is captured until they are valid
    std::int64_t invalids = 0;  // such readings so far
    double invalid_s = -1.0;    // when the last one came
    std::int64_t outside = 0;   // levels of touches outside arguments.options.range, from which no point can follow
    double outside_level = 0.0;      // the first of them
    std::int64_t without_level = 0;  // samples of touches whose device does not report arguments.level
    bool knows_level = false;        // some touch had one
};

// Opens sensor, folder and files. Throws InputError for impossible arguments, std::runtime_error for what cannot be
// opened.
std::unique_ptr<Recording> open_recording(const RecordArguments& arguments);

// One turn: takes samples and readings, captures points and saves them. Returns false once the curve is known
// everywhere or arguments.seconds are over. Throws std::runtime_error if the disk is full or the sensor has never sent
// anything.
bool step(const std::vector<platform::Sample>& samples, Recording& recording);

// Takes what a scale shows now, while the pen is held still at a level. Returns false, and captures no point, if it is not
// held still; the stream of forces has the number either way.
bool take_typed_N(double force_N, Recording& recording);

// Takes the last point back, for a number that was typed wrongly; both streams keep what came.
void drop_last_point(Recording& recording);

// Returns in words which band to press next.
std::string advice(const Recording& recording);

std::filesystem::path points_file(const RecordArguments& arguments);

// Writes all that is left to the disk, and returns the result as `calibrate record --json` prints it.
files::Json close_recording(Recording& recording);

}  // namespace palpa::calibration
