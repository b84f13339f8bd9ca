#pragma once
// Chooses the curve that best predicts points that it was not fitted to.

#include <vector>

#include "calibration/fit.h"

namespace palpa::calibration {

struct Candidate {
    FitOptions options;
    Eigen::ArrayXd predicted_N;  // each point by a fit without its fold; empty if one of these fits failed
    double score = 0.0;          // mean log density of the left-out forces, per newton; the higher the better
    ErrorModel error = ErrorModel::newton;  // the error model of the score
};

// Returns the fold of each point: its repeat if there are at least two, and three levels are left without any of them;
// else one of five (for fewer than 10 points, one of its own), in turn along the level.
std::vector<int> folds_of(const FitPoints& points);

// Returns all models (or one) with both error models (or one), the cubic with several numbers of knots. Models with too
// many parameters for the levels that occur are left out.
std::vector<FitOptions> candidates(const FitPoints& points, const std::optional<CurveModel>& model,
                                   const std::optional<ErrorModel>& error, Robust robust, double level_scale);

// Predicts the points of each fold by a fit without it, and scores the predictions. The density is Laplace's, with the
// candidate's own mean |error| as its scale, in newtons or of log F (then divided by F, so that both are densities of F
// and can be compared); f is the measured and F the predicted force:
//
//   newton: -log(2 m) - 1,  m = mean |f - F|      log: -log(2 m) - 1 - mean log f,  m = mean |log f - log F|
//
// A candidate fitted in newtons is scored in newtons, one fitted in log space there, and a cubic by the better of both
// unless `error` is given.
void cross_validate(const FitPoints& points, const std::vector<int>& fold, std::optional<ErrorModel> error,
                    Candidate& candidate);

// Returns the best candidate; its predictions are empty if none could be fitted. A score from n points is itself
// uncertain by about 1/sqrt(n), and real pens have bends that no smooth curve follows: within this uncertainty the
// cubic with a knot for each level is chosen.
Candidate choose(const FitPoints& points, const std::vector<FitOptions>& options, std::optional<ErrorModel> error);

}  // namespace palpa::calibration
