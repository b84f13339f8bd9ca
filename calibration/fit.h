#pragma once
// Fits curves to measured points: least squares in newtons or in log space, robust against slips, and without a
// starting value that could lead astray.

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "calibration/curve.h"

namespace palpa::calibration {

// The error that is taken to be equal over the whole range: in newtons, or relative to the force.
enum class ErrorModel : std::uint8_t { newton, log };
enum class Robust : std::uint8_t { none, huber, tukey };

// Points sorted by level; forces >= 0.
struct FitPoints {
    Eigen::ArrayXd level;
    Eigen::ArrayXd force_N;
    std::vector<int> repeat;  // the press of each point, 0, 1, ...; empty if not known
};

struct FitOptions {
    CurveModel model = CurveModel::exponential;
    ErrorModel error = ErrorModel::newton;
    Robust robust = Robust::huber;
    int knots = 0;             // monotone_cubic: the greatest number of knots; 0: one for each level that occurs
    double start_b = 0.0;      // tried besides the program's own starts; may be any number, also NaN
    double level_scale = 1.0;  // the highest level of the device
};

// Scratch memory of the parametric fits; means nothing between calls.
struct FitWorkspace {
    Eigen::ArrayXd z;  // the exponent's variable, see fit_parametric.cpp
    Eigen::ArrayXd log_force;
    Eigen::ArrayXd weight;  // of each point: 0 if the model excludes it, times its robust weight
    Eigen::ArrayXd residual;
    Eigen::ArrayXd wave;  // exp(theta z)
    Eigen::ArrayXd sorted;
    Eigen::MatrixX3d jacobian;
};

// Parameters of a fit, from which refits to resampled points start.
struct FitStart {
    Eigen::Vector3d p = Eigen::Vector3d::Zero();
    double scale = 0.0;  // of the residuals, against which slips are judged
};

// Returns nothing if the points do not determine a curve that rises.
std::optional<Curve> fit_curve(const FitPoints& points, const FitOptions& options);

// The same for the parametric models in two parts: start_fit() searches once; refit() then starts close to its result,
// with each point counted `count` times (a bootstrap).
bool start_fit(const FitPoints& points, const FitOptions& options, FitWorkspace& work, FitStart& start);
std::optional<Curve> curve_at(const FitOptions& options, const FitStart& start);
std::optional<Curve> refit(const FitPoints& points, const FitOptions& options, const Eigen::ArrayXd& count,
                           const FitStart& start, FitWorkspace& work);

// Bins along the level with equal numbers of points; equal levels share a bin.
struct CubicBins {
    std::vector<Eigen::Index> starts;    // first point of each bin, and the number of points
    std::vector<Eigen::Index> by_force;  // indices of the points, bin by bin, sorted by force
};
CubicBins cubic_bins(const FitPoints& points, int knots);
// Fits a cubic through the medians of the points in each bin, made to rise by isotonic regression. Returns nothing if
// fewer than two knots result.
std::optional<Curve> fit_cubic(const FitPoints& points, const CubicBins& bins, const Eigen::ArrayXd& count = {});

std::string_view name_of(ErrorModel error);
int parameter_count(CurveModel model);
int distinct_levels(const FitPoints& points);

}  // namespace palpa::calibration
