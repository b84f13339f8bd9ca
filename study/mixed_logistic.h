#pragma once
// Logistic regression with two crossed random effects, of people and of nodules, by Laplace's approximation:
//
//     y ~ Bernoulli(p),   logit p = beta_c + s_p u_p + s_n v_n,   u_p, v_n ~ N(0, 1)
//
// beta_c is the log odds of condition c for a person and a nodule in the middle; s_p and s_n are the spreads of people and
// of nodules. log L(beta, s) is the maximum over u and v of  sum[y eta - log(1 + e^eta)] - |u|^2/2 - |v|^2/2,  less half the
// log determinant of  Lambda Z' W Z Lambda + I  at that maximum, W = p (1 - p), Lambda = diag(s). It is maximised over beta
// and s together. Source: Bates et al., J. Statist. Softw. 67 (2015) 1; glmer of lme4 with nAGQ = 1 fits the same model.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/statistics.h"

namespace palpa::study {

// `found` of `n` trials of one nodule by one person under one condition, n >= 1.
struct MixedCell {
    int condition = 0;
    int participant = 0;
    int nodule = 0;
    std::int64_t found = 0;
    std::int64_t n = 1;
};

struct MixedData {
    int conditions = 0;
    int participants = 0;
    int nodules = 0;
    std::vector<MixedCell> cells;
};

// A condition under which all or none was found has no finite log odds. Then, and only then, each condition's log odds gets
// a normal prior with this spread about 0: 95 % of it lies between odds of 1 to 358 and 358 to 1.
inline constexpr double kPriorSpread = 3.0;

struct MixedFit {
    std::vector<double> beta;  // log odds by condition
    double s_participants = 0.0;
    double s_nodules = 0.0;
    double log_likelihood = 0.0;  // with the prior's density where there is one
    bool prior = false;           // because of separation
    // Covariance of (beta, s_participants, s_nodules) from the Hessian of log L by differences; empty where that has no
    // inverse, as with a spread of 0.
    std::vector<std::vector<double>> covariance;
    // Covariance of beta at these spreads (lme4's "RX"): (X'WX - X'WZL (LZ'WZL + I)^-1 LZ'WX)^-1.
    std::vector<std::vector<double>> covariance_given_spreads;
    std::string status;  // empty, or "cannot be computed, because ..."; the numbers above then hold nothing
};

// Fits the model. Where `same` is given, conditions with the same number in it share their log odds, which is the model of
// the null hypothesis in a likelihood-ratio test. It needs two people, two nodules, and something found and something missed.
MixedFit fit_mixed_logistic(const MixedData& data, const std::vector<int>& same = {});

// True if some condition's nodules were all found, or all missed.
bool is_separated(const MixedData& data);

// The log likelihood at given beta and spreads, without prior, for tests of the fit.
double mixed_log_likelihood(const MixedData& data, const std::vector<double>& beta, double s_participants,
                            double s_nodules);

// The standard error of beta_a - beta_b, with b = -1 of beta_a alone: by the Hessian, else given the spreads.
double standard_error(const MixedFit& fit, int a, int b);

// Sensitivity over people and nodules of the population: the mean of 1/(1 + e^-eta) for eta ~ N(log_odds, spread^2).
double averaged_share(double log_odds, double spread);

// The averaged share of a condition with its interval: by the delta method on the scale of the log odds. Nothing where the
// Hessian has no inverse.
struct AveragedShare {
    double share = 0.0;
    std::optional<Interval> ci;
};
AveragedShare averaged_share(const MixedFit& fit, int condition, double level);

}  // namespace palpa::study
