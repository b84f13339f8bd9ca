#pragma once
// Recording a calibration: the state of a session, when a point is captured, and when the curve is known well enough.
// It has no window and no device: samples go in, points and advice come out.

#include <deque>
#include <string>
#include <vector>

#include "calibration/points.h"

namespace palpa::calibration {

struct RecordOptions {
    LevelRange range;
    double steady_s = 0.3;            // time for which both signals must hold still
    double level_tolerance = 0.01;    // as a share of the range
    double force_tolerance = 0.02;    // as a share of the force, or
    double least_tolerance_N = 0.01;  // this, if it is more
    int bands = 20;                   // of equal width over the range
    int least_repeats = 3;
    double goal = 0.05;  // half of the 95 % interval, as a share of the force
};

struct CapturedPoint {
    double time_s = 0.0;  // end of the still time, host clock + the session's clock_shift_s
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
    std::deque<Timed> levels;  // of the last 2 steady_s, and one before
    std::deque<Timed> forces;
    std::deque<Timed> rest;              // readings of the sensor while nothing touches
    double zero_N = platform::kMissing;  // subtracted from the readings
    bool touching = false;
    double lifted_s = 0.0;  // when the pen was lifted last
    int repeat = 0;         // 0, 1, ...; one press with its release is one repeat
    bool captured_in_repeat = false;
    double last_level = platform::kMissing;  // of the last point in this repeat
    double last_force_N = 0.0;
    // Keeps times rising in a resumed session if the computer was restarted in between.
    double clock_shift_s = 0.0;
    int below_zero = 0;  // times at which both held still in a press, but the force was below zero: its sign is wrong
    std::vector<CapturedPoint> points;
};

// Take every sample as it arrives, each stream in order of time. A pen that does not touch has level 0.
void take_level(const RecordOptions& options, double t_s, double level, bool touching, RecordSession& session);
void take_force(const RecordOptions& options, double t_s, double force_N, RecordSession& session);

// Takes a reading of the sensor while the pen does not touch. The mean of 0.4 s without movement is the zero, and the
// latest one counts: a hand that already leans on the sensor does not hold so still.
void take_rest(const RecordOptions& options, double t_s, double shown_N, RecordSession& session);

// Captures a point if both signals have held still up to `now_s`: the mean force and the median level of that time.
// Within a press the next point must be half a band away, or differ by a tenth in force.
bool capture(const RecordOptions& options, double now_s, RecordSession& session);

// Returns the band to press next: the lightest one from the last point upwards that has no point in this press; if all
// have one, the band that is known least. -1: lift the pen.
int target_band(const RecordOptions& options, const RecordSession& session, const std::vector<double>& band_error);
int band_of(const RecordOptions& options, double level);

// How well the curve is known.
struct Knowledge {
    std::vector<double> band_error;  // half of the 95 % interval / force; NaN: not measured
    int repeats = 0;
    bool done = false;    // `goal` is met in every band, with enough repeats
    std::string missing;  // what is not known, in plain words; when done, where full level begins, or empty
};
Knowledge knowledge_of(const RecordOptions& options, const std::vector<CapturedPoint>& points);

// Returns levels, forces and repeats for a fit, without the times: a resumed session may have two clocks.
CalibrationRows rows_of(const std::vector<CapturedPoint>& points);

// The file of a session: columns time_s, level, force_N, repeat, phase. read_session() reads it to resume, and throws
// InputError for a file that is none.
std::string points_csv(const std::vector<CapturedPoint>& points);
std::vector<CapturedPoint> read_session(const std::filesystem::path& file);

}  // namespace palpa::calibration
