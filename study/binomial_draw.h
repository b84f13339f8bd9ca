#pragma once
// Random numbers of the binomial distribution in a time that does not grow with n.

#include <cstdint>

#include "study/random.h"

namespace palpa::study {

// Returns how many of n trials hit, each with probability `chance`, 0 <= chance <= 1. Few hits are counted one by one;
// otherwise transformed rejection. Source: Hoermann, J. Statist. Comput. Simul. 46 (1993) 101, algorithm BTRS.
std::int64_t binomial_draw(std::int64_t n, double chance, Random& random);

}  // namespace palpa::study
