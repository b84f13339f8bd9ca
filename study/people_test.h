#pragma once
// Tests over participants: the person is the unit, however many nodules and trials each of them judged.

#include <cstdint>
#include <string>

#include "study/people.h"
#include "study/statistics.h"

namespace palpa::study {

enum class Design {
    against_chance,  // one condition against a known share
    within,          // the same people under both conditions
    between,         // other people under each
};

struct PeopleTest {
    Design design = Design::within;
    int people_a = 0;
    int people_b = 0;         // within: the same people as people_a
    int left_out = 0;         // took part in one condition only, where others took part in both
    double difference = 0.0;  // a - b, or a - chance; NaN if it cannot be computed
    Interval ci;              // of `difference`, by t; NaN as t
    double t = 0.0;           // NaN if it cannot be computed
    double df = 0.0;
    double p = 1.0;              // two-sided, of t
    double p_permutation = 1.0;  // two-sided, of signs or of groups (study/permutation.h)
    bool permutation_exact = true;
    bool permutation_unfit = false;  // pooled counts whose permutation would not keep its level: p_permutation is NaN
    std::string status;              // empty, or "cannot be computed, because ..."
};

struct PeopleTestOptions {
    double level = 0.95;      // of `ci`
    std::uint64_t seed = 1;   // of permutations that are drawn
    bool permutation = true;  // false leaves p_permutation NaN
};

// Compares a and b; entry i of both belongs to the same participant. If anybody took part in both, these people are
// compared with themselves: Student's t of their differences d_i, and the permutation of signs. Otherwise Welch's t of
// the two groups (df by Satterthwaite), and the permutation of groups.
//
// With Average::pooled the standard error is the jackknife's over people, of the difference of the ratios
// sum k / sum n (Efron & Tibshirani, An Introduction to the Bootstrap, 1993, section 11.5), and what is permuted is
// k_i - r n_i with the ratio r of both conditions together, which no exchange changes. An exchange also exchanges how many
// there are to count: where one condition has 1.25 times as many as the other, and fewer than five in all are of the rarer
// kind (false marks among right ones), that alone decides, and there is no permutation. Of null data drawn for 8 to 40 people
// with 1 to 6 marks each it rejected 4 to 24 % at 0.05 with one or two false marks, about 5 % at most with five and more.
PeopleTest compare_people(const People& a, const People& b, Average average, const PeopleTestOptions& options);

// Compares the mean of the people's shares with `chance`: Student's t, and the permutation of signs of k_i - chance n_i,
// which is exact for answers by guessing if `chance` is one half.
PeopleTest compare_with_chance(const People& people, double chance, const PeopleTestOptions& options);

// Compares how much two groups of people differ between a and b (the interaction of a mixed design): Welch's t of the
// differences d_i of both groups, and the permutation of groups. Average::people.
PeopleTest compare_differences(const People& a_first, const People& b_first, const People& a_second,
                               const People& b_second, const PeopleTestOptions& options);

}  // namespace palpa::study
