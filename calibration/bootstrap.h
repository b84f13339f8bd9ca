#pragma once
// How far a fitted curve can be trusted: the same fit on resampled points.

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
    int fits = 0;                    // of those asked for, how many gave a curve
    bool over_repeats = false;       // whole presses were drawn, not single points
    CurveInterval a_N, b, offset_N;  // 95 %; parametric models only
    std::vector<double> level;       // the curve's band, 95 % at each level
    std::vector<double> low_N;
    std::vector<double> high_N;
};

// With three repeats or more, repeats are drawn: the points of one press err together, and drawing them one by one
// would promise too much. Few repeats spread too little, so that the interval is widened by sqrt(R/(R-1)) and by the
// ratio of Student's to the normal quantile (R repeats, R - 1 degrees of freedom). Else points are drawn.
Bootstrap bootstrap(const FitPoints& points, const FitOptions& options, const Curve& fitted,
                    const std::vector<double>& level, int fits, std::uint64_t seed);

}  // namespace palpa::calibration
