#pragma once
// Permutation tests. Under the null hypothesis the conditions of one person, or the groups of all people, could be
// exchanged: the p value is the share of the exchanges whose statistic is at least as far from 0 as the observed one.
// Source: Fisher, The Design of Experiments (1935), section 21; Pitman, J. Roy. Statist. Soc. Suppl. 4 (1937) 119.

#include <cstdint>
#include <span>
#include <vector>

namespace palpa::study {

struct Permutation {
    double p = 1.0;     // two-sided
    bool exact = true;  // false: from random exchanges, p = (1 + as far) / (1 + exchanges)
};

// All exchanges are counted up to this number of people (of sign_permutation: of those who differ), and above it
// kExchanges of them are drawn.
inline constexpr int kMostExactPeople = 32;
inline constexpr int kExchanges = 20000;

// Flips the sign of each difference in turn; the statistic is the sum of all differences. With n people who differ no p
// value is below 2/2^n. Needs at least one value.
Permutation sign_permutation(std::span<const double> differences, std::uint64_t seed);

// Gives each person to one of two groups of the observed sizes; the statistic is the difference of the groups' means.
// Needs at least one value in each group.
Permutation group_permutation(std::span<const double> a, std::span<const double> b, std::uint64_t seed);

}  // namespace palpa::study
