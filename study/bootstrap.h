#pragma once
// Bootstrap over participants: the nodules and trials of one person are not independent, people are.

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

// What one participant contributed to a condition: k of n. n = 0: was not in it.
struct Contribution {
    std::int64_t k = 0;
    std::int64_t n = 0;
};

// Percentile interval of sum k / sum n over participants drawn with replacement. Resamples without any n are left
// out. NaN limits with fewer than two participants who contributed.
Interval bootstrap_share(std::span<const Contribution> people, const BootstrapOptions& options);

// The same of the difference a - b, entry by entry the same participant. People who were in both conditions, only in
// a and only in b are drawn each from among themselves, so that a resample has the design of the study.
Interval bootstrap_difference(std::span<const Contribution> a, std::span<const Contribution> b,
                              const BootstrapOptions& options);

}  // namespace palpa::study
