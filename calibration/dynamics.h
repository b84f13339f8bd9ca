#pragma once
// Effects of time on a calibration: the pen's lag behind the sensor, the hysteresis between pressing and releasing, and
// the drift from one repeat to the next.

#include <optional>
#include <vector>

#include "calibration/curve.h"
#include "calibration/points.h"

namespace palpa::calibration {

// Returns the lag of the pen's level behind the sensor's force, seconds: level(t) = g(F(t - lag)). It maximises the
// correlation between the level and the level g that `curve` gives for the shifted force:
//
//   lag = argmax over tau of corr( level(t_i), g(F(t_i - tau)) ),   |tau| <= 0.5 s, the peak by a parabola
//
// Returns nothing if it cannot be determined: no times, no release (a steady ramp fits any lag), too few samples, or a
// maximum at the edge. Hysteresis that depends on direction alone, not on speed, looks like a lag here; calibrate() removes
// only a lag that explains the loop better than hysteresis does.
std::optional<double> lag_s(const CalibrationRows& rows, const Curve& curve, LevelRange range);

// Returns the rows with the force that acted when the level was formed, F(t - lag), linear between samples. Rows at the
// ends of a press for which there is none are left out.
CalibrationRows without_lag(const CalibrationRows& rows, double lag_s);

struct Hysteresis {
    double median_relative = 0.0;  // (F pressing - F releasing) / F at equal levels, median over the range
    double greatest_N = 0.0;       // F pressing - F releasing where it is greatest in size
    double at_level = 0.0;         // where that is
};
// Returns nothing unless both directions occur, by the phases or, without them, by the times.
std::optional<Hysteresis> hysteresis_of(const CalibrationRows& rows, LevelRange range);

// Returns the rows with a loop of this size taken out: half of it from the forces of pressing, half added to those of releasing.
CalibrationRows without_loop(const CalibrationRows& rows, double relative);

struct Drift {
    std::vector<double> repeat_offset;  // of each repeat: median of F measured / F curve - 1
    double per_repeat = 0.0;            // slope of these over the repeats
    double spread = 0.0;                // greatest minus least
};
// Returns nothing with fewer than two repeats.
std::optional<Drift> drift_of(const FitPoints& points, const Curve& curve);

}  // namespace palpa::calibration
