#pragma once
// How far a fitted curve can be trusted: the same fit is repeated on resampled points.

#include <cstdint>
#include <string>
#include <vector>

#include "calibration/fit.h"

namespace palpa::calibration {

struct CurveInterval {
    double low = 0.0;
    double high = 0.0;
};

struct Bootstrap {
    int fits = 0;                    // number of fits that gave a curve, of those asked for
    bool over_repeats = false;       // whole repeats were drawn, not single points
    CurveInterval a_N, b, offset_N;  // 95 % intervals; parametric models only
    std::vector<double> level;       // levels of the 95 % band, whose limits follow
    std::vector<double> low_N;
    std::vector<double> high_N;
};

// Fits the curve to `fits` resamples. With three repeats or more, repeats are drawn: the errors of the points of one
// press are correlated, so that drawing single points would give intervals that are too narrow. A few repeats vary too
// little, so each interval is widened by sqrt(R/(R-1)) and by the ratio of Student's to the normal quantile (R repeats,
// R - 1 degrees of freedom). With fewer repeats, points are drawn.
Bootstrap bootstrap(const FitPoints& points, const FitOptions& options, const Curve& fitted,
                    const std::vector<double>& level, int fits, std::uint64_t seed);

}  // namespace palpa::calibration
