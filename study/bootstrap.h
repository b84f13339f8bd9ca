#pragma once
// Bootstrap over participants, since people are independent, but the nodules and trials of one person are not.

#include <cstdint>
#include <span>
#include <vector>

#include "study/statistics.h"

namespace palpa::study {

struct BootstrapOptions {
    int resamples = 2000;
    std::uint64_t seed = 1;
    double level = 0.95;
};

// What one participant contributed to a condition: k of n. n = 0: the participant was not in it.
struct Contribution {
    std::int64_t k = 0;
    std::int64_t n = 0;
};

// Percentile interval of sum k / sum n over participants drawn with replacement. Resamples whose sum of n is 0 are left
// out. The limits are NaN if fewer than two participants contributed.
Interval bootstrap_share(std::span<const Contribution> people, const BootstrapOptions& options);

// The same interval of the difference a - b; entry i of both belongs to the same participant. People who were in both
// conditions, only in a and only in b are drawn each from among themselves, so that a resample has the design of the
// study.
Interval bootstrap_difference(std::span<const Contribution> a, std::span<const Contribution> b,
                              const BootstrapOptions& options);

}  // namespace palpa::study
