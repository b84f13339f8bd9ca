#include "study/comparisons.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <tuple>

#include "study/contributions.h"

namespace palpa::study {
namespace {

constexpr const char* kNoNames = "cannot be computed, because the counts do not name their participants";

std::size_t nth(int i) { return static_cast<std::size_t>(i); }

PeopleTestOptions people_options(const BootstrapOptions& options, bool permutation) {
    return {options.level, options.seed, permutation};
}

PeopleTest unknown_test(const std::string& status) {
    constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
    PeopleTest test;
    test.difference = test.t = test.df = test.p = test.p_permutation = kNotKnown;
    test.ci = {kNotKnown, kNotKnown};
    test.status = status;
    return test;
}

Average average_of(Quantity quantity) { return quantity == Quantity::ppv ? Average::pooled : Average::people; }

std::vector<Proportion> pooled_shares(const Observations& seen, Quantity quantity) {
    std::vector<Proportion> shares(seen.conditions.size(), Proportion{0, 0});
    if (quantity == Quantity::correct) {
        for (const Choices& row : seen.choices) {
            shares[nth(row.condition)].k += row.correct;
            shares[nth(row.condition)].n += row.n;
        }
        return shares;
    }
    for (const Observation& row : seen.rows) {
        shares[nth(row.condition)].k += row.tp;
        shares[nth(row.condition)].n += row.tp + (quantity == Quantity::sensitivity ? row.fn : row.fp);
    }
    return shares;
}

// A nodule that somebody judged once in a trial.
struct Judgement {
    int participant, nodule, repeat;
    bool hit;
    auto key() const { return std::tie(participant, nodule, repeat); }
};

std::vector<std::vector<Judgement>> judgements_by_condition(const Observations& seen) {
    std::vector<std::vector<Judgement>> all(seen.conditions.size());
    for (const Observation& row : seen.rows) {
        // sums of several judgements cannot be matched
        if (row.participant < 0 || row.nodule < 0 || row.tp + row.fn != 1) continue;
        all[nth(row.condition)].push_back({row.participant, row.nodule, row.repeat, row.tp == 1});
    }
    for (auto& one : all) {
        std::stable_sort(one.begin(), one.end(),
                         [](const Judgement& x, const Judgement& y) { return x.key() < y.key(); });
    }
    return all;
}

// Counts the nodules that a participant judged once under each condition, matched by participant, nodule and repeat.
std::optional<PairedCounts> paired_counts(const std::vector<Judgement>& a, const std::vector<Judgement>& b) {
    PairedCounts counts;
    for (auto x = a.begin(), y = b.begin(); x != a.end() && y != b.end();) {
        if (x->key() < y->key()) {
            ++x;
        } else if (y->key() < x->key()) {
            ++y;
        } else {
            ++(x->hit ? (y->hit ? counts.both : counts.only_a) : (y->hit ? counts.only_b : counts.neither));
            ++x;
            ++y;
        }
    }
    if (counts.n() == 0) return std::nullopt;
    return counts;
}

Replication replicate(const Proportion& a, const Proportion& b, double z) {
    Replication out;
    out.delta = a.p() - b.p();
    out.combined_interval = combined_interval(a, b, z);
    out.significant = std::abs(out.delta) > out.combined_interval;
    out.newcombe = newcombe(a, b, z);
    out.p = combined_p(a, b);
    return out;
}

bool anybody_in_both(const People& a, const People& b) {
    for (std::size_t i = 0; i < std::min(a.size(), b.size()); ++i) {
        if (a[i] && b[i]) return true;
    }
    return false;
}

void leave_out_who_has_nothing_to_count(People& people) {
    for (auto& one : people) {
        if (one && one->n == 0) one.reset();
    }
}

// The people who took part in the other condition too.
People of_both(const People& people, const People& other) {
    People out = people;
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!other[i]) out[i].reset();
    }
    return out;
}

// The interval is of the difference that stands beside it, and of the same people.
Interval bootstrap_of(People a, People b, Average average, const BootstrapOptions& options) {
    if (average == Average::people) {
        leave_out_who_has_nothing_to_count(a);
        leave_out_who_has_nothing_to_count(b);
    }
    return anybody_in_both(a, b) ? bootstrap_difference(of_both(a, b), of_both(b, a), average, options)
                                 : bootstrap_difference(a, b, average, options);
}

void take_people(const People& a, const People& b, Quantity quantity, bool resample, const BootstrapOptions& options,
                 PairResult& pair) {
    if (a.empty() || b.empty()) {
        pair.people = unknown_test(kNoNames);
        return;
    }
    pair.people = compare_people(a, b, average_of(quantity), people_options(options, resample));
    if (resample) {
        const Interval ci = bootstrap_of(a, b, average_of(quantity), options);
        if (!std::isnan(ci.low)) pair.bootstrap = ci;
    }
    for (std::size_t i = 0; i < a.size(); ++i) pair.participants_in_both += a[i] && b[i] ? 1 : 0;
}

void correct_for_number(std::vector<PairResult>& pairs) {
    std::vector<double> p, p_permutation, p_replication;
    for (const PairResult& pair : pairs) {
        p.push_back(pair.people.p);
        p_permutation.push_back(pair.people.p_permutation);
        if (pair.replication) p_replication.push_back(pair.replication->p);
    }
    p = holm_of_known(p);
    p_permutation = holm_of_known(p_permutation);
    p_replication = holm_of_known(p_replication);
    for (std::size_t i = 0; i < pairs.size(); ++i) {
        pairs[i].p_holm = p[i];
        pairs[i].p_permutation_holm = p_permutation[i];
        if (pairs[i].replication) pairs[i].replication->p_holm = p_replication[i];
    }
}

People of_group(const Observations& seen, const People& people, int group) {
    People out = people;
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (seen.group_of[i] != group) out[i].reset();
    }
    return out;
}

bool anybody(const People& people) {
    return std::any_of(people.begin(), people.end(), [](const auto& one) { return one.has_value(); });
}

// By condition and group; empty where nobody of the group took part.
using PeopleOfGroups = std::vector<std::vector<People>>;

PeopleOfGroups split(const Observations& seen, Quantity quantity) {
    PeopleOfGroups out;
    for (const People& people : people_by_condition(seen, quantity)) {
        auto& groups = out.emplace_back();
        for (int g = 0; g < static_cast<int>(seen.groups.size()); ++g) {
            People one = people.empty() ? People{} : of_group(seen, people, g);
            groups.push_back(anybody(one) ? std::move(one) : People{});
        }
    }
    return out;
}

std::size_t pairs_of(std::size_t n) { return n < 2 ? 0 : n * (n - 1) / 2; }

// Calls take(i, j) for all i < j < n.
template <class Take>
void each_pair(std::size_t n, const Take& take) {
    for (std::size_t i = 0; i < n; ++i) {
        for (std::size_t j = i + 1; j < n; ++j) take(i, j);
    }
}

void add_group_results(std::vector<GroupResult> some, std::vector<GroupResult>& all) {
    std::vector<double> p;
    for (const GroupResult& one : some) p.push_back(one.people.p);
    p = holm_of_known(p);
    for (std::size_t i = 0; i < some.size(); ++i) some[i].p_holm = p[i];
    all.insert(all.end(), some.begin(), some.end());
}

int index_in(const std::vector<std::string>& names, const std::string& name) {
    const auto it = std::find(names.begin(), names.end(), name);
    return it == names.end() ? -1 : static_cast<int>(it - names.begin());
}

PeopleTest test_of_primary(const Observations& seen, const PrimaryComparison& stated, const BootstrapOptions& options) {
    std::array<People, 2> sides;
    for (std::size_t s = 0; s < 2; ++s) {
        const std::string& name = stated.of_groups ? stated.condition : stated.sides[s];
        const int condition = index_in(seen.conditions, name);
        const int group = stated.of_groups ? index_in(seen.groups, stated.sides[s]) : -1;
        const auto unknown = [&](const std::string& missing) {
            PeopleTest test = unknown_test("cannot be computed, because no log of '" + missing + "' counts");
            if (stated.of_groups) test.design = Design::between;
            return test;
        };
        if (condition < 0) return unknown(name);
        if (stated.of_groups && group < 0) return unknown(stated.sides[s]);
        sides[s] = people_of(seen, condition, stated.quantity);
        if (sides[s].empty()) return unknown(name);
        if (stated.of_groups) sides[s] = of_group(seen, sides[s], group);
    }
    return compare_people(sides[0], sides[1], average_of(stated.quantity), people_options(options, true));
}

}  // namespace

std::vector<double> holm_of_known(const std::vector<double>& p) {
    std::vector<double> known, out = p;
    for (const double one : p) {
        if (!std::isnan(one)) known.push_back(one);
    }
    const std::vector<double> corrected = holm(known);
    auto next = corrected.begin();
    for (double& one : out) {
        if (!std::isnan(one)) one = *next++;
    }
    return out;
}

bool resamples(std::size_t pairs, std::size_t participants) {
    return pairs <= kMostResampledPairs && pairs * participants <= kMostResampledPeople;
}

std::vector<PairResult> compare_conditions(const Observations& seen, Quantity quantity,
                                           const BootstrapOptions& options) {
    const double z = z_of_level(options.level);
    const std::vector<Proportion> shares = pooled_shares(seen, quantity);
    const auto counted = std::count_if(shares.begin(), shares.end(), [](const Proportion& x) { return x.n > 0; });
    if (static_cast<std::size_t>(counted) > kMostCompared) return {};
    const std::vector<People> people = people_by_condition(seen, quantity);
    const auto judgements =
        quantity == Quantity::sensitivity ? judgements_by_condition(seen) : std::vector<std::vector<Judgement>>();
    std::vector<std::size_t> compared;
    for (std::size_t c = 0; c < shares.size(); ++c) {
        if (shares[c].n > 0) compared.push_back(c);
    }
    const bool resample = resamples(pairs_of(compared.size()), seen.participants.size());
    std::vector<PairResult> pairs;
    each_pair(compared.size(), [&](std::size_t i, std::size_t j) {
        const std::size_t a = compared[i], b = compared[j];
        PairResult pair;
        pair.a = seen.conditions[a];
        pair.b = seen.conditions[b];
        take_people(people[a], people[b], quantity, resample, options, pair);
        const double of_people = pair.people.difference;
        const double difference = std::isnan(of_people) ? shares[a].p() - shares[b].p() : of_people;
        if (std::abs(difference) > 1e-12) pair.higher = difference > 0.0 ? pair.a : pair.b;
        if (quantity != Quantity::correct) pair.replication = replicate(shares[a], shares[b], z);
        if (!judgements.empty()) pair.paired = paired_counts(judgements[a], judgements[b]);
        if (pair.paired) {
            pair.newcombe_paired = newcombe_paired(*pair.paired, z);
            pair.mcnemar_p = mcnemar_p(*pair.paired);
        }
        pairs.push_back(std::move(pair));
    });
    correct_for_number(pairs);
    return pairs;
}

std::vector<GroupResult> compare_groups(const Observations& seen, const BootstrapOptions& options) {
    std::vector<GroupResult> all;
    if (seen.groups.size() < 2 || seen.conditions.size() > kMostCompared) return all;
    const std::size_t comparisons =
        pairs_of(seen.groups.size()) * (seen.conditions.size() + pairs_of(seen.conditions.size()));
    const PeopleTestOptions how = people_options(options, resamples(comparisons, seen.participants.size()));
    for (const Quantity quantity : {Quantity::sensitivity, Quantity::ppv, Quantity::correct}) {
        const PeopleOfGroups people = split(seen, quantity);
        std::vector<GroupResult> single, interactions;
        each_pair(seen.groups.size(), [&](std::size_t g, std::size_t h) {
            const GroupResult like{quantity, "", "", seen.groups[g], seen.groups[h], {}, 1.0};
            for (std::size_t c = 0; c < people.size(); ++c) {
                if (people[c][g].empty() || people[c][h].empty()) continue;
                single.push_back(like);
                single.back().condition = seen.conditions[c];
                single.back().people = compare_people(people[c][g], people[c][h], average_of(quantity), how);
            }
            // people without marks have no PPV of their own
            if (quantity == Quantity::ppv) return;
            each_pair(people.size(), [&](std::size_t a, std::size_t b) {
                if (interactions.size() >= kMostResampledPairs) return;
                if (!anybody_in_both(people[a][g], people[b][g]) || !anybody_in_both(people[a][h], people[b][h]))
                    return;
                interactions.push_back(like);
                interactions.back().condition = seen.conditions[a];
                interactions.back().condition_b = seen.conditions[b];
                interactions.back().people =
                    compare_differences(people[a][g], people[b][g], people[a][h], people[b][h], how);
            });
        });
        add_group_results(std::move(single), all);
        add_group_results(std::move(interactions), all);
    }
    return all;
}

std::optional<PrimaryResult> primary_result(const Observations& seen, const BootstrapOptions& options) {
    if (!seen.primary) return std::nullopt;
    PrimaryResult out;
    out.stated = *seen.primary;
    out.people = test_of_primary(seen, *seen.primary, options);
    out.p = out.stated.test == PrimaryTest::t ? out.people.p : out.people.p_permutation;
    return out;
}

}  // namespace palpa::study
