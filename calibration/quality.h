#pragma once
// How good a curve is on given points.

#include <vector>

#include "calibration/curve.h"
#include "calibration/points.h"

namespace palpa::calibration {

// Errors relative to the measured force, of the points with a level inside [from, to).
struct ErrorBand {
    double from = 0.0;
    double to = 0.0;
    std::size_t n = 0;
    double median = platform::kMissing;
    double p90 = platform::kMissing;
};

struct FitQuality {
    double r2_newton = platform::kMissing;
    double r2_log = platform::kMissing;  // of log F, points with a force above 0
    double rmse_N = platform::kMissing;
};

// `predicted_N[i]` belongs to `measured_N[i]`.
FitQuality fit_quality(const Eigen::ArrayXd& measured_N, const Eigen::ArrayXd& predicted_N);

// Five bands of equal width over the range, the lightest first. Points without a level or a force above 0 are in none
// of them: a device that reports 0 says nothing about the force. The range's highest level is in the last band.
std::vector<ErrorBand> error_bands(const Eigen::ArrayXd& level, const Eigen::ArrayXd& measured_N,
                                   const Eigen::ArrayXd& predicted_N, LevelRange range);
double median_relative_error(const Eigen::ArrayXd& level, const Eigen::ArrayXd& measured_N,
                             const Eigen::ArrayXd& predicted_N, LevelRange range);

}  // namespace palpa::calibration
