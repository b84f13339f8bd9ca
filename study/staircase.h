#pragma once
// Staircases: forced choices whose comparison follows from the answers so far, to find how small a difference a person
// can feel. Every function is one of the answers alone, so that a study goes on with the right level after a crash, and
// a log can be checked.

#include <optional>
#include <string>
#include <vector>

#include "study/protocol.h"

namespace palpa::study {

// One answer under a condition.
struct StaircaseAnswer {
    int level = 0;                 // index in StaircaseTask::comparisons_kPa
    bool reference_first = false;  // else the comparison came first
    bool correct = false;          // the softer one was called softer
};

// Returns the level of the next pair, after these answers in their order. In the next pair the reference comes first or
// second.
//
// Weighted up-down: after a right answer one level towards the reference, after a wrong one `steps_after_wrong` levels
// away from it. Where a share p of the answers is right, the level neither rises nor falls on average if
//
//   p = k / (k + 1)        k = steps_after_wrong, with levels at equal distances of ln(comparison / reference)
//
// so k = 3 finds the level at which 75 % are right.
// Source: Kaernbach, Perception & Psychophysics 49 (1991) 227.
//
// QUEST+: the level whose answer is expected to leave the least entropy in the posterior of PSE, sd and lapse (below).
// Source: Watson, Journal of Vision 17(3):10 (2017), equations 4 to 10.
int next_level(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers, bool reference_first);

// Returns how many answers were given at a level that next_level() does not ask for after the answers before them. Levels
// that tell QUEST+ equally much all count as asked for.
int answers_at_other_levels(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers);

// The psychometric function of the posterior:
//
//   P(second is called stiffer) = lapse + (1 - 2 lapse) Phi((x - pse) / sd)        x = ln(second / first)
//
// on a grid: pse from -0.6 to 0.6; sd from 0.02 to 1.5, equally spaced in its logarithm; lapse 0, 0.02 and 0.04. The
// prior is uniform on this grid for sd and lapse, and normal for pse with a standard deviation of 0.2.
struct PosteriorPoint {
    double pse = 0.0;
    double sd = 0.0;
    double lapse = 0.0;
    double weight = 0.0;  // all add up to 1
};
std::vector<PosteriorPoint> posterior_of(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers);

// Returns P(answer is right) at this point for a pair whose difference is `difference` = ln(comparison / reference).
double share_right(const PosteriorPoint& point, double difference, bool reference_first);

// What the answers tell. Differences are ln(comparison / reference): below 0 where the comparison is the softer one.
struct StaircaseEstimate {
    int trials = 0;
    int reversals = 0;             // changes from right to wrong answers or back
    std::optional<double> target;  // share of right answers that weighted up-down finds
    // Weighted up-down: geometric mean level from the second reversal on; absent with fewer than 4 reversals. It lies above the
    // level sought if a step is not small against sd, since the psychometric function is curved between the levels.
    std::optional<double> threshold;
    // Mean of ln(sd) in the posterior, times 0.6745, and its 95 % credible interval: the difference of which 75 % are
    // felt by a person without bias and lapses, on the stiffer side.
    double jnd = 0.0;
    double jnd_low = 0.0;
    double jnd_high = 0.0;
    // ok; or open: a limit of the interval lies beyond the last but one point of the grid of sd, as both do without
    // any answer; and of weighted up-down fewer than 4 reversals, or more than a tenth of the answers asked for a level that
    // is not there
    std::string status;
};
StaircaseEstimate estimate_of(const StaircaseTask& task, const std::vector<StaircaseAnswer>& answers);

// Returns a difference of logarithms in per cent of the reference: 100 (e^x - 1).
double percent_of(double difference);

}  // namespace palpa::study
