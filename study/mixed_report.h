#pragma once
// Sensitivity by the crossed mixed logistic model (study/mixed_logistic.h): likelihood-ratio tests, odds ratios, and the
// sensitivity over the population of people and nodules.

#include <string>
#include <vector>

#include "files/json.h"
#include "study/mixed_logistic.h"

namespace palpa::study {

struct MixedCondition {
    std::string condition;
    double log_odds = 0.0;  // of a person and a nodule in the middle
    double se = 0.0;
    AveragedShare share;
};

struct MixedPair {
    std::string a, b;
    double odds_ratio = 1.0;        // odds of a / odds of b
    Interval ci;                    // exp(log odds ratio -+ z SE)
    double likelihood_ratio = 0.0;  // twice the difference of log likelihood to the model with one log odds for both
    double p = 1.0;                 // chi-squared with 1 degree of freedom; with `wald` of log odds ratio / SE
    double p_holm = 1.0;            // over all pairs
    bool wald = false;              // so many pairs that their likelihood ratios (NaN) are not computed
};

struct MixedReport {
    bool there = false;  // there were nodules to find
    std::string status;  // empty, or why there are no numbers
    MixedFit fit;
    int participants = 0;  // 0: not all are known
    int nodules = 0;       // 0: not all are known
    std::vector<MixedCondition> conditions;
    std::vector<MixedPair> pairs;
    double likelihood_ratio = 0.0;  // of all conditions against one log odds for all
    int df = 0;
    double p = 1.0;
    std::vector<std::string> notes;
};

struct ReportTable;
struct Observations;

// Up to one million cells (condition, person, nodule) x (conditions + 2)^2, so 50,000 cells of two conditions and
// 20,408 of five; beyond, the status says so. Pairs of many conditions are tested by Wald's test.
MixedReport mixed_report(const Observations& seen, double level);

void add_mixed(const MixedReport& found, files::Json& report);  // `mixed_logistic`, if there is any
std::vector<ReportTable> mixed_tables(const MixedReport& found);
std::string mixed_methods(const MixedReport& found);  // a paragraph; empty without a model

// An R script for lme4 that reads nodules_long.tsv (study/long_tables.h) beside it and fits the same model; empty without a model.
std::string lme4_script(const MixedReport& found);

}  // namespace palpa::study
