#pragma once
// How well a curve predicts given points.

#include <vector>

#include "calibration/curve.h"
#include "calibration/points.h"

namespace palpa::calibration {

// Errors relative to the measured force, of the points with a level in [from, to); NaN without points.
struct ErrorBand {
    double from = 0.0;
    double to = 0.0;
    std::size_t n = 0;
    double median = platform::kMissing;
    double p90 = platform::kMissing;
};

struct FitQuality {
    double r2_newton = platform::kMissing;
    double r2_log = platform::kMissing;  // of log F, over points with forces above 0
    double rmse_N = platform::kMissing;
};

// Compares `predicted_N[i]` with `measured_N[i]`.
FitQuality fit_quality(const Eigen::ArrayXd& measured_N, const Eigen::ArrayXd& predicted_N);

// Returns five bands of equal width over the range, the lightest first. Points whose level or force is not above 0 are
// in no band: a device that reports 0 says nothing about the force. The range's highest level belongs to the last band.
std::vector<ErrorBand> error_bands(const Eigen::ArrayXd& level, const Eigen::ArrayXd& measured_N,
                                   const Eigen::ArrayXd& predicted_N, LevelRange range);
double median_relative_error(const Eigen::ArrayXd& level, const Eigen::ArrayXd& measured_N,
                             const Eigen::ArrayXd& predicted_N, LevelRange range);

}  // namespace palpa::calibration
