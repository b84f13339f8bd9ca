#pragma once
// Proportions and their intervals, as studies of palpation report them. Counts in, numbers out; no files.

#include <cstdint>
#include <span>
#include <vector>

namespace palpa::study {

// `k` of `n`. All functions need 0 <= k <= n and n >= 1.
struct Proportion {
    std::int64_t k = 0;
    std::int64_t n = 1;
    double p() const { return static_cast<double>(k) / static_cast<double>(n); }
};

struct Interval {
    double low = 0.0;
    double high = 0.0;
};

// Returns the two-sided standard score of a confidence level: 0.95 -> 1.959963984540054.
double z_of_level(double level);

// Wilson's score interval (1927), as in Li et al., section 4:
//
//     (p + z^2/2n +- z sqrt(p (1-p)/n + z^2/4n^2)) / (1 + z^2/n)
//
// written so that k = 0 gives exactly 0 and k = n exactly 1.
Interval wilson(const Proportion& x, double z);

// The paper's "combined interval" of the two proportions, p1 <= p2:
//
//     CI = sqrt((U1 - p1)^2 + (L2 - p2)^2)          U1, L2: Wilson's limits that face each other
//
// The paper calls p2 - p1 significant where it is greater than CI. CI is the arm of newcombe() that faces zero.
double combined_interval(const Proportion& a, const Proportion& b, double z);

// Newcombe's hybrid score interval of p_a - p_b for independent samples. Source: Newcombe, Statistics in Medicine 17
// (1998) 873, method 10 (without continuity correction).
Interval newcombe(const Proportion& a, const Proportion& b, double z);

// The p value that belongs to the combined interval: 2 P(X > z) for the z at which |p_a - p_b| equals it. So
// p < 1 - level exactly where the paper's test says significant.
double combined_p(const Proportion& a, const Proportion& b);

// The same items judged under two conditions.
struct PairedCounts {
    std::int64_t both = 0;  // found under both
    std::int64_t only_a = 0;
    std::int64_t only_b = 0;
    std::int64_t neither = 0;
    std::int64_t n() const { return both + only_a + only_b + neither; }
};

// Newcombe's interval of p_a - p_b for pairs, square-and-add with the correlation of the two. Source: Newcombe,
// Statistics in Medicine 17 (1998) 2635, method 10: a positive numerator of the correlation is reduced by n/2, to 0 at
// least.
Interval newcombe_paired(const PairedCounts& counts, double z);

// Two-sided p value of McNemar's exact test: the pairs that differ, against one half. 1 if none differ.
double mcnemar_p(const PairedCounts& counts);

// Two-sided p value of the exact binomial test: the probability of all outcomes that are at most as likely as the
// observed one (to 1e-7 of its probability, so that rounding does not split ties). Needs 0 < chance < 1. Above 10,000 of
// them the two tails are taken as a whole, in a time that does not depend on n.
double exact_binomial_p(const Proportion& x, double chance);

// Student's t test of the mean of `values` against `chance`. Needs at least two values.
struct TTest {
    double mean = 0.0;
    double t = 0.0;  // NaN, as p and ci, if all values are equal: there is no variance to compare with
    double df = 0.0;
    double p = 1.0;  // two-sided
    Interval ci;     // of the mean
};
TTest t_test(std::span<const double> values, double chance, double level);  // `level`: of the interval

// The same for answers that are 1 (k of them) or 0. Needs n >= 2.
TTest t_test_of_answers(const Proportion& x, double chance, double level);

// Holm's step-down correction (Scand. J. Statist. 6 (1979) 65): returns the adjusted p values in the order of `p`.
std::vector<double> holm(std::span<const double> p);

}  // namespace palpa::study
