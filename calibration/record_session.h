#pragma once
// Recording a calibration: what a session knows, when a point is captured, and when it is enough. No window, no
// device: samples go in, points and advice come out.

#include <deque>
#include <string>
#include <vector>

#include "calibration/points.h"

namespace palpa::calibration {

struct RecordOptions {
    LevelRange range;
    double steady_s = 0.3;          // how long both signals must hold still
    double level_tolerance = 0.01;  // of the range
    double force_tolerance = 0.02;  // of the force, or
    double least_tolerance_N = 0.01;
    int bands = 20;  // of equal width, over the range
    int least_repeats = 3;
    double goal = 0.05;  // half of the 95 % interval, of the force
};

struct CapturedPoint {
    double time_s = 0.0;  // the end of the still moment, host clock + the session's clock_shift_s
    double level = 0.0;
    double force_N = 0.0;
    int repeat = 0;
    PressPhase phase = PressPhase::press;
};

struct RecordSession {
    struct Timed {
        double t_s;
        double value;
    };
    std::deque<Timed> levels;  // the last second or so, and one before the still moment
    std::deque<Timed> forces;
    std::deque<Timed> rest;              // what the sensor shows while nothing touches
    double zero_N = platform::kMissing;  // to be subtracted from what it shows
    bool touching = false;
    double lifted_s = 0.0;  // since when not
    int repeat = 0;         // 0, 1, ...; one press and release is one
    bool captured_in_repeat = false;
    double last_level = platform::kMissing;  // captured last in this repeat
    double last_force_N = 0.0;
    double clock_shift_s = 0.0;  // so that times rise when the computer was started anew in between
    std::vector<CapturedPoint> points;
};

// Every sample as it arrives, each stream in order of time. A pen that does not touch has level 0.
void take_level(const RecordOptions& options, double t_s, double level, bool touching, RecordSession& session);
void take_force(const RecordOptions& options, double t_s, double force_N, RecordSession& session);

// What the sensor shows while the pen does not touch. 0.4 s without movement are the zero, the latest count:
// a hand that already leans on the sensor does not hold so still.
void take_rest(const RecordOptions& options, double t_s, double shown_N, RecordSession& session);

// Captures a point if both signals have held still up to `now_s`: the mean force and the median level of that time.
// One place is captured once in a press: the next must be half a band away.
bool capture(const RecordOptions& options, double now_s, RecordSession& session);

// The band to press next: the lightest without a point in this press; when all have one, the one that is known least.
// -1: lift the pen.
int target_band(const RecordOptions& options, const RecordSession& session, const std::vector<double>& band_error);
int band_of(const RecordOptions& options, double level);

// How well the curve is known.
struct Knowledge {
    std::vector<double> band_error;  // half of the 95 % interval / force; NaN: not measured
    int repeats = 0;
    bool done = false;    // `goal` is met in every band, by enough repeats
    std::string missing;  // what is not known, in plain words; empty when done
};
Knowledge knowledge_of(const RecordOptions& options, const std::vector<CapturedPoint>& points);

// Levels, forces and repeats, for a fit. Not the times: a session that was gone on with may have two clocks.
CalibrationRows rows_of(const std::vector<CapturedPoint>& points);

// The file that a session is kept in: columns time_s, level, force_N, repeat, phase. Read back to resume; throws
// InputError for a file that is none.
std::string points_csv(const std::vector<CapturedPoint>& points);
std::vector<CapturedPoint> read_session(const std::filesystem::path& file);

}  // namespace palpa::calibration
