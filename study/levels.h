#pragma once
// Do the tests of the report keep their level, and do its intervals cover? Answers of people who differ are drawn from
// a model, and every test and interval judges them as it judges a study.
//
//     P(find nodule l) = 1 / (1 + exp(-(b_l + u +- (effect + w) / 2)))      b = 1, 0, -1 for the three nodules
//
// with + under the second condition, u ~ N(0, 1) for each person, and w ~ N(0, slope_sd^2): the law helps some people
// and hinders others. Without an effect neither condition is better on average, which is the null hypothesis.
// Every trial has false marks of a Poisson distribution with mean 0.607 exp(v), where v ~ N(-1/8, 1/4) for each person.
// Forced choices are ten for each repeat, right with logit 0 (guessing on average) or 0.8, and the spread of `slope_sd`.
//
// Tests of groups have these people in both groups together; intervals of groups have as many people in each. Intervals
// are judged with an effect of 0.8 logits.

#include <cstdint>
#include <string>
#include <vector>

namespace palpa::study {

struct LevelCase {
    int people = 12;
    int repeats = 1;      // trials under each condition
    double slope_sd = 1;  // logits
};

struct LevelOptions {
    int studies = 2000;    // for each case
    int resamples = 1000;  // of the bootstrap
    std::uint64_t seed = 1;
    double level = 0.95;
    bool coverage = true;  // false: only the tests
};

// How often something happened.
struct Rate {
    std::string name;
    std::string label;  // replication or "ignores clustering", as in the report; empty for what should keep its level
    int hits = 0;
    int n = 0;  // studies in which it could be computed
    double rate() const { return static_cast<double>(hits) / n; }
};

struct LevelResult {
    LevelCase the_case;
    std::vector<Rate> rejections;  // of a true null hypothesis; what cannot be computed does not reject
    std::vector<Rate> coverage;    // of the true value, where the interval can be computed
};

LevelResult measure_levels(const LevelCase& the_case, const LevelOptions& options);

// Both tables in Markdown.
std::string levels_markdown(const std::vector<LevelResult>& results, const LevelOptions& options);

}  // namespace palpa::study
