#pragma once
// Effects of time on a calibration: the pen's lag behind the sensor, the hysteresis between pressing and releasing, and
// the drift from one repeat to the next.

#include <optional>
#include <vector>

#include "calibration/curve.h"
#include "calibration/points.h"

namespace palpa::calibration {

// Returns the lag of the pen's level behind the sensor's force, seconds, found together with the hysteresis' share s of the
// force: it leaves least of the variance of
//
//   ln F(t - lag) = g(level(t)) + d s / 2,   |lag| <= 0.5 s and a fifth of the longest press,
//
// with any g of the level and d = +1 pressing, -1 releasing, rows weighted by the sensor's noise beside F. Returns nothing if it cannot be determined: no times, no release
// (a steady ramp fits any lag), too few samples, or an end of the search. A loop whose share of the force varies along the
// press looks like a lag, less so where presses have different speeds (figures in docs/calibration.md).
std::optional<double> lag_s(const CalibrationRows& rows, LevelRange range);

// Returns the rows with the force that acted when the level was formed, F(t - lag), linear between samples. Rows at the
// ends of a press for which there is none are left out.
CalibrationRows without_lag(const CalibrationRows& rows, double lag_s);

struct Hysteresis {
    double median_relative =
        0.0;                  // (F pressing - F releasing) / F at equal levels, median from a tenth of the force up
    double greatest_N = 0.0;  // F pressing - F releasing where it is greatest in size
    double at_level = 0.0;    // where that is
};
// Returns nothing unless both directions occur, by the phases or, without them, by the times.
std::optional<Hysteresis> hysteresis_of(const CalibrationRows& rows, LevelRange range);

struct Drift {
    std::vector<double> repeat_offset;  // of each repeat, from the mean of all: median of F measured / F expected - 1
    double per_repeat = 0.0;            // slope of these over the repeats
    double spread = 0.0;                // greatest minus least
};
// expected_N: at each point, by a fit to the other repeats (by_others), or else by the curve, which hides what lies on it: a
// knot for each level does. Returns nothing with fewer than two repeats.
std::optional<Drift> drift_of(const FitPoints& points, const Eigen::ArrayXd& expected_N, bool by_others);

}  // namespace palpa::calibration
