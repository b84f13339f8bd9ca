#pragma once
// What time does to a calibration: the pen's lag behind the sensor, the loop between pressing and releasing, the drift
// from one repeat to the next.

#include <optional>
#include <vector>

#include "calibration/curve.h"
#include "calibration/points.h"

namespace palpa::calibration {

// The pen's level behind the sensor's force, seconds: level(t) = g(F(t - lag)). Found where the correlation between
// the level and the level that `curve` gives for the force, shifted by the lag, is highest:
//
//   lag = argmax over tau of corr( level(t_i), g(F(t_i - tau)) ),   |tau| <= 0.5 s, the peak by a parabola
//
// Nothing where it cannot be told: no times, no release (a steady ramp fits any lag), too few samples, or a best
// place at the edge. A loop that depends on direction alone, not on speed, looks like a lag at one speed: press at
// two speeds to tell them apart.
std::optional<double> lag_s(const CalibrationRows& rows, const Curve& curve, LevelRange range);

// The rows with the force that acted when the level was formed, F(t - lag), linear between samples. Rows at the
// ends of a press that have none are left out.
CalibrationRows without_lag(const CalibrationRows& rows, double lag_s);

struct Hysteresis {
    double median_relative = 0.0;  // (F pressing - F releasing) / F at one level, median over the range
    double greatest_N = 0.0;       // greatest difference, with its sign
    double at_level = 0.0;
};
// Nothing unless both directions are there, from the phases or, without them, from the times.
std::optional<Hysteresis> hysteresis_of(const CalibrationRows& rows, LevelRange range);

struct Drift {
    std::vector<double> repeat_offset;  // median of F measured / F curve - 1, of each repeat
    double per_repeat = 0.0;            // slope of these
    double spread = 0.0;                // greatest minus least
};
std::optional<Drift> drift_of(const FitPoints& points, const Curve& curve);

}  // namespace palpa::calibration
