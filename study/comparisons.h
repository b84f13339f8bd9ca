#pragma once
// Which condition is better, and which group? Tests over participants keep their level however many nodules and trials
// a person judged. Beside them stand the paper's interval, as a replication, and McNemar's test, which both take the
// nodules of one person as independent.

#include <optional>
#include <string>
#include <vector>

#include "study/bootstrap.h"
#include "study/observations.h"
#include "study/people_test.h"
#include "study/statistics.h"

namespace palpa::study {

// The test of Li et al., which takes all nodules of all people as independent.
struct Replication {
    double delta = 0.0;  // p_a - p_b of the pooled shares
    double combined_interval = 0.0;
    bool significant = false;  // |delta| > combined_interval, uncorrected
    Interval newcombe;         // of p_a - p_b
    double p = 1.0;
    double p_holm = 1.0;  // corrected for all pairs of conditions
};

struct PairResult {
    std::string a;  // of the two, the one that the protocol names first
    std::string b;
    std::string
        higher;  // a, b or "" if equal: by the difference of people, or by the pooled shares where that is not known
    PeopleTest people;
    double p_holm = 1.0;                // of people.p, over the pairs of conditions that can be tested
    double p_permutation_holm = 1.0;    // of people.p_permutation
    std::optional<Interval> bootstrap;  // of p_a - p_b, over participants
    int participants_in_both = 0;
    std::optional<Replication> replication;  // of sensitivity and PPV
    std::optional<PairedCounts> paired;      // nodules that the same participants judged under both conditions
    Interval newcombe_paired;                // of p_a - p_b; only with `paired`
    double mcnemar_p = 1.0;                  // only with `paired`
};

// Within what p_holm is corrected, for all tables of a report.
inline constexpr const char* kHolmFamilies =
    "over all pairs of conditions of one quantity or figure; between groups over all comparisons of one quantity, "
    "interactions apart; of choices against chance over all conditions, single comparisons apart; the rows of each "
    "group by themselves";

// Compares all conditions that have a share, in the order of seen.conditions. Above kMostResampledPairs pairs, or above
// kMostResampledPeople people in all pairs together, what resamples people (bootstrap, permutation) is left out: it would
// take minutes, and of so many people Student's t needs no check.
inline constexpr std::size_t kMostResampledPairs = 1000;
inline constexpr std::size_t kMostResampledPeople = 100'000;
bool resamples(std::size_t pairs, std::size_t participants);
// Above this number of conditions (100 make 4,950 pairs) no pair is compared: nobody reads so many.
inline constexpr std::size_t kMostCompared = 100;
std::vector<PairResult> compare_conditions(const Observations& seen, Quantity quantity,
                                           const BootstrapOptions& options);

// One condition between two groups; or with `condition_b` how much the two conditions' difference differs between the
// groups, which is the interaction of a mixed design. Of PPV no interaction is tested.
struct GroupResult {
    Quantity quantity = Quantity::sensitivity;
    std::string condition;
    std::string condition_b;  // empty: one condition
    std::string group_a;
    std::string group_b;
    PeopleTest people;
    double p_holm = 1.0;  // over all comparisons of groups of this quantity, with interactions apart
};
// None above kMostCompared conditions.
std::vector<GroupResult> compare_groups(const Observations& seen, const BootstrapOptions& options);

// The comparison that the protocol states, uncorrected.
struct PrimaryResult {
    PrimaryComparison stated;
    PeopleTest people;
    double p = 1.0;  // of the stated test
};
std::optional<PrimaryResult> primary_result(const Observations& seen, const BootstrapOptions& options);

// Holm's correction of those p values that are known; the others stay NaN.
std::vector<double> holm_of_known(const std::vector<double>& p);

}  // namespace palpa::study
