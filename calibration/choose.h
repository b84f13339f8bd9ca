#pragma once
// Which curve to believe: by how well it predicts points that it was not fitted to.

#include <vector>

#include "calibration/fit.h"

namespace palpa::calibration {

struct Candidate {
    FitOptions options;
    Eigen::ArrayXd predicted_N;  // each point by a fit without its fold; empty if one of the fits was not possible
    double score = 0.0;          // mean log density of the left-out forces, per newton; higher is better
    ErrorModel error = ErrorModel::newton;  // under which of the two error models this score was reached
};

// Fold of each point: its repeat where there are two at least, else one of five (all of them, for fewer than 10
// points), taken in turn along the level.
std::vector<int> folds_of(const FitPoints& points);

// All models (or one), both error models (or one), several numbers of knots.
std::vector<FitOptions> candidates(const FitPoints& points, const std::optional<CurveModel>& model,
                                   const std::optional<ErrorModel>& error, Robust robust, double level_scale);

// Predicts and scores. The density is Laplace's, with the mean |error| of the candidate itself as its scale, in
// newtons or of log F (then divided by F, so that both are densities of F and can be compared):
//
//   newton: -log(2 m) - 1,  m = mean |f - F|      log: -log(2 m) - 1 - mean log f,  m = mean |log f - log F|
//
// A candidate fitted in newtons is judged in newtons, one fitted in log space there, a cubic by the better of both.
void cross_validate(const FitPoints& points, const std::vector<int>& fold, std::optional<ErrorModel> error,
                    Candidate& candidate);

// The best of them all; empty predictions if none could be fitted. A score from n points is itself uncertain by about
// 1/sqrt(n), and real pens have bends that no smooth curve follows: within this uncertainty the cubic with a knot for
// each level is taken.
Candidate choose(const FitPoints& points, const std::vector<FitOptions>& options, std::optional<ErrorModel> error);

}  // namespace palpa::calibration
