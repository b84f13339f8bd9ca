#pragma once
// Curves through measured points: least squares in newtons or in log space, robust against slips, without a
// starting value that could break it.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/curve.h"

namespace palpa::calibration {

// What is taken to be equally large over the whole range: the error in newtons, or in per cent of the force.
enum class ErrorModel : std::uint8_t { newton, log };
enum class Robust : std::uint8_t { none, huber, tukey };

// Points sorted by level; forces >= 0.
struct FitPoints {
    Eigen::ArrayXd level;
    Eigen::ArrayXd force_N;
    std::vector<int> repeat;  // which press a point is from, 0, 1, ...; empty if that is not known
};

struct FitOptions {
    CurveModel model = CurveModel::exponential;
    ErrorModel error = ErrorModel::newton;
    Robust robust = Robust::huber;
    int knots = 0;             // monotone_cubic: at most so many; 0 = one for each level that occurs
    double start_b = 0.0;      // tried besides the program's own starts; any number, NaN too
    double level_scale = 1.0;  // the highest level of the device
};

// Scratch memory of the parametric fits; means nothing between calls.
struct FitWorkspace {
    Eigen::ArrayXd z;  // the exponent's variable, see fit_parametric.cpp
    Eigen::ArrayXd log_force;
    Eigen::ArrayXd weight;  // of a point: 0 if the model cannot have it, x how far it is believed
    Eigen::ArrayXd residual;
    Eigen::ArrayXd wave;  // exp(theta z)
    Eigen::ArrayXd sorted;
    Eigen::MatrixX3d jacobian;
};

// Shape parameters of a fit, with which a repeat on resampled points starts.
struct FitStart {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    double scale = 0.0;  // of the residuals; decides what a slip is
};

// Nothing, where the points do not determine a curve that rises.
std::optional<Curve> fit_curve(const FitPoints& points, const FitOptions& options);

// The same for the parametric models in parts: once with a search, then again and again near to it with each point
// counted `count` times (a bootstrap).
bool start_fit(const FitPoints& points, const FitOptions& options, FitWorkspace& work, FitStart& start);
std::optional<Curve> curve_at(const FitOptions& options, const FitStart& start);
std::optional<Curve> refit(const FitPoints& points, const FitOptions& options, const Eigen::ArrayXd& count,
                           const FitStart& start, FitWorkspace& work);

// Bins of equal count along the level; equal levels are never parted.
struct CubicBins {
    std::vector<Eigen::Index> starts;    // of each bin, and the end
    std::vector<Eigen::Index> by_force;  // the points of each bin, sorted by force
};
CubicBins cubic_bins(const FitPoints& points, int knots);
// Medians of the points in each bin, made to rise by isotonic regression.
std::optional<Curve> fit_cubic(const FitPoints& points, const CubicBins& bins, const Eigen::ArrayXd& count = {});

std::string_view name_of(ErrorModel error);
int parameter_count(CurveModel model);
int distinct_levels(const FitPoints& points);

}  // namespace palpa::calibration
