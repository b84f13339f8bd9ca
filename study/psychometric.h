#pragma once
// The psychometric function: how often one of two surfaces is called the stiffer one, as a function of how much stiffer
// it is; fitted by maximum likelihood. Numbers in, numbers out; no files.
//
//     P(x) = l + (1 - 2 l) Phi((x - PSE) / sd)
//
// x: logarithm of a ratio of two stiffnesses. PSE: point of subjective equality, the x at which both are called stiffer
// equally often. sd: standard deviation of the noise, in units of x. l: lapse, the probability of an answer by mistake,
// which is the same at both ends; between 0 and a greatest value. Phi: distribution function of the standard normal.
// The just noticeable difference is JND = 0.6745 sd, the step from P = 1/2 to 3/4 where l = 0.
// Source: Wichmann & Hill, Perception & Psychophysics 63 (2001) 1293, with one lapse for both ends.

#include <cstdint>
#include <optional>
#include <span>
#include <vector>

namespace palpa::study {

// The answers at one level.
struct LevelAnswers {
    double x = 0.0;
    std::int64_t stiffer = 0;
    std::int64_t n = 0;
};

// Sorts the levels and adds up those that differ by less than 1e-9; levels without answers are left out.
std::vector<LevelAnswers> merged_levels(std::vector<LevelAnswers> levels);

struct PsychometricCurve {
    double pse = 0.0;
    double sd = 1.0;
    double lapse = 0.0;
};

double probability_stiffer(double x, const PsychometricCurve& curve);

// The logarithm of the likelihood, without the binomial coefficients, which do not depend on the curve.
double log_likelihood(std::span<const LevelAnswers> levels, const PsychometricCurve& curve);

// JND in units of x, and in per cent: 100 (e^JND - 1).
double jnd_of_sd(double sd);
double jnd_percent_of_sd(double sd);

// An interval that may lack limits: answers do not always exclude a greater, or a smaller, value.
struct OpenInterval {
    std::optional<double> low, high;
    bool closed() const { return low && high; }
};

// ok: estimates and both limits of both intervals exist.
// open: at least one limit does not exist. PSE and sd do not exist either if the answers do not rise with x.
// separated: a step explains the answers best, so sd has no lower limit, and PSE and sd have no estimate.
enum class FitStatus { ok, open, separated };
const char* name_of(FitStatus status);

struct PsychometricFit {
    std::optional<double> pse, sd;
    double lapse = 0.0;
    double log_likelihood = 0.0;  // the greatest
    double deviance = 0.0;        // twice the difference from the greatest log likelihood of any probabilities at all
    OpenInterval pse_ci, sd_ci;
    FitStatus status = FitStatus::open;
    bool rises = false;  // false: no curve that rises is likelier than a constant
};

struct PsychometricOptions {
    double level = 0.95;           // of the intervals
    double greatest_lapse = 0.05;  // 0: no lapses, a probit regression
};

// The likeliest curve, with intervals by the profile likelihood: the values of one parameter for which some values of
// the others give a log likelihood within half the chi-squared quantile (one degree of freedom) of the greatest.
// `levels` as merged_levels() returns them, at least two.
PsychometricFit fit_psychometric(std::span<const LevelAnswers> levels, const PsychometricOptions& options);

// The estimates alone, for resampling. sd is 0 where a step is likeliest, infinite where no rising curve is likelier
// than a constant; PSE is NaN in both cases. `start` is a curve near which to search first, such as that of all people.
PsychometricCurve likeliest_curve(std::span<const LevelAnswers> levels, double greatest_lapse,
                                  const std::optional<PsychometricCurve>& start = std::nullopt);

}  // namespace palpa::study
