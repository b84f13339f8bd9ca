#pragma once
// Bootstrap over participants, since people are independent, but the nodules and trials of one person are not.

#include <cstddef>
#include <cstdint>

#include "study/people.h"
#include "study/statistics.h"

namespace palpa::study {

struct BootstrapOptions {
    int resamples = 2000;
    std::uint64_t seed = 1;
    double level = 0.95;
};

// Interval of sum k / sum n over participants drawn with replacement, from all who took part, also those whose n is 0.
// Resamples whose sum of n is 0 are left out. The limits are NaN if fewer than two people have an n above 0, or if the
// resamples do not vary.
//
// The limits are the quantiles of the resamples at
//
//     Phi(-z / (1 + a z)) and Phi(z / (1 - a z))      z = t sqrt(m / (m - S)),  a = sum e_i^3 / (6 (sum e_i^2)^1.5)
//
// for m people in S strata (here 1), with t: Student's quantile of the level with m - S degrees of freedom, and
// e_i = k_i - share n_i. z is further out than the normal quantile, as Student's interval of a mean is wider than the
// plain one (Hesterberg, The American Statistician 69 (2015) 371, section 4.2); a corrects for skewed people (the
// acceleration of Efron, J. Amer. Statist. Assoc. 82 (1987) 171, without his correction of bias). Plain percentiles
// cover too seldom with few people.
Interval bootstrap_share(const People& people, const BootstrapOptions& options);

// The same, with a = 0, of the difference a - b of two shares; entry i of both belongs to the same participant. Participants
// of both conditions, of a only and of b only are resampled separately, so that every resample has the design of the
// study. Average::people: of the means of the people's own shares, of those who have something to count.
Interval bootstrap_difference(const People& a, const People& b, Average average, const BootstrapOptions& options);

// Returns how many resamples put ten of them beyond each limit of bootstrap_share() with a = 0, which is 10 / Phi(-z),
// rounded up to two digits. With fewer a limit is near the least or the greatest resample, whatever the level.
double resamples_needed(double level, std::size_t people);

}  // namespace palpa::study
