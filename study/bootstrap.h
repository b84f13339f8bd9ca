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

// What one participant contributed to a condition: k of n. n is 0 for a participant who did not take part in it.
struct Contribution {
    std::int64_t k = 0;
    std::int64_t n = 0;
};

// Percentile interval of sum k / sum n over participants drawn with replacement. Resamples whose sum of n is 0 are left
// out. The limits are NaN if fewer than two participants contributed.
Interval bootstrap_share(std::span<const Contribution> people, const BootstrapOptions& options);

// Percentile interval of the difference a - b of two such shares; entry i of both spans belongs to the same
// participant. Participants of both conditions, of a only and of b only are resampled separately, so that every
// resample has the design of the study. The limits are NaN if either condition has fewer than two participants.
Interval bootstrap_difference(std::span<const Contribution> a, std::span<const Contribution> b,
                              const BootstrapOptions& options);

}  // namespace palpa::study
