#pragma once
// Probabilities and quantiles of the distributions that intervals and tests use, by Boost.Math. Its headers are slow to
// compile, so only one source includes them. A wrong argument is a bug (assert); nothing throws.

#include <cstdint>

namespace palpa::files {

// Returns x with P(X <= x) = p for a standard normal X, 0 < p < 1.
double normal_quantile(double p);

// Returns P(X <= x) of a standard normal X.
double normal_probability(double x);

// Returns the two-sided p value of Student's t with df degrees of freedom, P(|T| >= |t|); 0 for an infinite t, NaN for
// NaN.
double student_p(double t, double df);

// Returns the t that |T| exceeds with probability 1 - level, 0 < level < 1.
double student_quantile(double level, double df);

// Returns P(X >= x) of the chi-squared distribution with df degrees of freedom; 1 for x <= 0, NaN for NaN.
double chi_squared_p(double x, double df);

// Returns P(F >= f) of the F distribution; df2 may be infinite. 1 for f <= 0, NaN for NaN.
double f_distribution_p(double f, double df1, double df2);

// Returns the probability of k hits in n trials that each hit with probability `chance`, 0 < chance < 1.
double binomial_probability(std::int64_t k, std::int64_t n, double chance);

// Returns the probability of k hits or fewer, 0 <= k <= n.
double binomial_at_most(std::int64_t k, std::int64_t n, double chance);

}  // namespace palpa::files
