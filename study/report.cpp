#include "study/report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <tuple>
#include <utility>

#include "files/quantile.h"
#include "files/text.h"
#include "study/rows_by_condition.h"

namespace palpa::study {
namespace {

using People = std::map<int, Contribution>;  // by participant, those who took part

// Above this number of conditions all pairs are too many to compute or to read: 32 conditions make 496.
constexpr std::size_t kMostCompared = 32;

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Both count hits, as a share of the nodules (sensitivity) or of the marks (PPV).
enum class Quantity { sensitivity, ppv };

Contribution part_of(const Observation& row, Quantity quantity) {
    return {row.tp, row.tp + (quantity == Quantity::sensitivity ? row.fn : row.fp)};
}

// Sums the rows of each participant; `nodule` -1 takes all nodules. Empty if some of the rows do not name their
// participant.
People by_participant(const Observations& seen, int condition, int nodule, Quantity quantity) {
    People people;
    for (const Observation& row : rows_of(seen, condition, nodule)) {
        if (row.participant < 0) return {};
        const Contribution part = part_of(row, quantity);
        Contribution& sum = people[row.participant];
        sum.k += part.k;
        sum.n += part.n;
    }
    return people;
}

std::vector<Contribution> contributions(const People& people) {
    std::vector<Contribution> out;
    for (const auto& [participant, sum] : people) out.push_back(sum);
    return out;
}

std::optional<Interval> known(const Interval& ci) {
    if (std::isnan(ci.low)) return std::nullopt;
    return ci;
}

std::optional<Share> share_of(const Observations& seen, int condition, int nodule, Quantity quantity,
                              const ReportOptions& options) {
    Proportion x{0, 0};
    for (const Observation& row : rows_of(seen, condition, nodule)) {
        x.k += part_of(row, quantity).k;
        x.n += part_of(row, quantity).n;
    }
    if (x.n == 0) return std::nullopt;
    const auto people = contributions(by_participant(seen, condition, nodule, quantity));
    return Share{x, wilson(x, z_of_level(options.bootstrap.level)), known(bootstrap_share(people, options.bootstrap))};
}

std::optional<Spread> spread_over(const Observations& seen, int condition, double TrialFigures::*field) {
    std::vector<double> values;
    for (const TrialFigures& trial : seen.trials) {
        if (trial.condition == condition && std::isfinite(trial.*field)) values.push_back(trial.*field);
    }
    if (values.empty()) return std::nullopt;
    return spread_of(std::move(values));
}

ConditionResult condition_result(const Observations& seen, int condition, const ReportOptions& options) {
    ConditionResult out;
    out.name = seen.conditions[at(condition)];
    std::set<int> took_part;
    for (const Observation& row : rows_of(seen, condition)) {
        out.tp += row.tp;
        out.fn += row.fn;
        out.fp += row.fp;
        if (row.participant >= 0) took_part.insert(row.participant);
    }
    out.participants = static_cast<int>(took_part.size());
    out.se = share_of(seen, condition, -1, Quantity::sensitivity, options);
    out.ppv = share_of(seen, condition, -1, Quantity::ppv, options);
    std::set<int> nodules;
    for (const Observation& row : rows_of(seen, condition)) nodules.insert(row.nodule);
    for (const int nodule : nodules) {
        if (nodule < 0) continue;
        const auto se = share_of(seen, condition, nodule, Quantity::sensitivity, options);
        if (se) out.nodules.push_back({seen.nodules[at(nodule)], *se});
    }
    out.duration_s = spread_over(seen, condition, &TrialFigures::duration_s);
    out.path_m = spread_over(seen, condition, &TrialFigures::path_m);
    out.mean_force_N = spread_over(seen, condition, &TrialFigures::mean_force_N);
    out.max_force_N = spread_over(seen, condition, &TrialFigures::max_force_N);
    return out;
}

// Counts the nodules that a participant judged once under each condition, matched by participant, nodule and repeat.
std::optional<PairedCounts> paired_counts(const Observations& seen, int a, int b) {
    const auto key = [](const Observation& row) { return std::tuple(row.nodule, row.participant, row.repeat); };
    const auto judged = [](const Observation& row) {  // sums of several judgements cannot be matched
        return row.participant >= 0 && row.nodule >= 0 && row.tp + row.fn == 1;
    };
    PairedCounts counts;
    const auto under_b = rows_of(seen, b);
    auto other = under_b.begin();
    for (const Observation& row : rows_of(seen, a)) {  // both are sorted by their keys
        while (other != under_b.end() && key(*other) < key(row)) ++other;
        if (other == under_b.end() || key(*other) != key(row) || !judged(row) || !judged(*other)) continue;
        std::int64_t& cell = row.tp == 1 ? (other->tp == 1 ? counts.both : counts.only_a)
                                         : (other->tp == 1 ? counts.only_b : counts.neither);
        ++cell;
    }
    if (counts.n() == 0) return std::nullopt;
    return counts;
}

// What a pair needs of one condition, made once for all its pairs.
struct Compared {
    int condition = 0;
    Share share;
    People people;
};

// Puts two conditions' participants side by side; who took part in one only has n = 0 in the other.
std::pair<std::vector<Contribution>, std::vector<Contribution>> side_by_side(const People& a, const People& b) {
    std::map<int, std::pair<Contribution, Contribution>> both;
    for (const auto& [participant, sum] : a) both[participant].first = sum;
    for (const auto& [participant, sum] : b) both[participant].second = sum;
    std::pair<std::vector<Contribution>, std::vector<Contribution>> out;
    for (const auto& [participant, sums] : both) {
        out.first.push_back(sums.first);
        out.second.push_back(sums.second);
    }
    return out;
}

PairResult pair_result(const Observations& seen, const Compared& one, const Compared& other, Quantity quantity,
                       const ReportOptions& options) {
    const int a = one.condition, b = other.condition;
    const Share &of_a = one.share, &of_b = other.share;
    const double z = z_of_level(options.bootstrap.level);
    const double difference = of_a.x.p() - of_b.x.p();
    PairResult pair;
    pair.a = seen.conditions[at(a)];
    pair.b = seen.conditions[at(b)];
    if (difference != 0.0) pair.higher = difference > 0.0 ? pair.a : pair.b;
    pair.delta = std::abs(difference);
    pair.combined_interval = combined_interval(of_a.x, of_b.x, z);
    pair.significant = pair.delta > pair.combined_interval;
    pair.newcombe = newcombe(of_a.x, of_b.x, z);
    pair.p = combined_p(of_a.x, of_b.x);
    if (quantity == Quantity::sensitivity) pair.paired = paired_counts(seen, a, b);
    if (pair.paired) {
        pair.newcombe_paired = newcombe_paired(*pair.paired, z);
        pair.mcnemar_p = mcnemar_p(*pair.paired);
    }
    if (one.people.empty() || other.people.empty()) return pair;
    const auto [people_a, people_b] = side_by_side(one.people, other.people);
    pair.bootstrap = known(bootstrap_difference(people_a, people_b, options.bootstrap));
    for (std::size_t i = 0; i < people_a.size(); ++i) {
        pair.participants_in_both += people_a[i].n > 0 && people_b[i].n > 0 ? 1 : 0;
    }
    return pair;
}

int place_of(const Observations& seen, const ConditionResult& condition) {
    return static_cast<int>(std::find(seen.conditions.begin(), seen.conditions.end(), condition.name) -
                            seen.conditions.begin());
}

std::vector<PairResult> all_pairs(const Observations& seen, const std::vector<ConditionResult>& conditions,
                                  Quantity quantity, const ReportOptions& options) {
    std::vector<PairResult> pairs;
    if (conditions.size() > kMostCompared) return pairs;
    std::vector<Compared> compared;
    for (const ConditionResult& condition : conditions) {
        const auto& share = quantity == Quantity::sensitivity ? condition.se : condition.ppv;
        const int place = place_of(seen, condition);
        if (share) compared.push_back({place, *share, by_participant(seen, place, -1, quantity)});
    }
    for (std::size_t a = 0; a < compared.size(); ++a) {
        for (std::size_t b = a + 1; b < compared.size(); ++b)
            pairs.push_back(pair_result(seen, compared[a], compared[b], quantity, options));
    }
    std::vector<double> p;
    for (const PairResult& pair : pairs) p.push_back(pair.p);
    const std::vector<double> corrected = holm(p);
    for (std::size_t i = 0; i < pairs.size(); ++i) pairs[i].p_holm = corrected[i];
    return pairs;
}

std::optional<ChoiceResult> choice_result(const Observations& seen, int condition, int comparison,
                                          const ReportOptions& options) {
    ChoiceResult out;
    out.condition = seen.conditions[at(condition)];
    if (comparison >= 0) out.comparison = seen.comparisons[at(comparison)];
    Proportion& x = out.correct.x = {0, 0};
    People people;
    bool all_told = true;
    for (const Choices& row : choice_rows_of(seen, condition, comparison)) {
        x.k += row.correct;
        x.n += row.n;
        all_told = all_told && row.participant >= 0;
        if (row.participant < 0) continue;
        people[row.participant].k += row.correct;
        people[row.participant].n += row.n;
    }
    if (x.n == 0) return std::nullopt;
    constexpr double kChance = 0.5;
    const double level = options.bootstrap.level;
    out.correct.wilson = wilson(x, z_of_level(level));
    out.binomial_p = exact_binomial_p(x, kChance);
    if (x.n >= 2) out.over_answers = t_test_of_answers(x, kChance, level);
    if (!all_told) return out;
    out.correct.bootstrap = known(bootstrap_share(contributions(people), options.bootstrap));
    std::vector<double> shares;
    for (const auto& [participant, one] : people) {
        if (one.n > 0) shares.push_back(static_cast<double>(one.k) / static_cast<double>(one.n));
    }
    if (shares.size() >= 2) out.over_people = t_test(shares, kChance, level);
    return out;
}

// Adds one row for answers on a scale, or one row for each text that was given.
void add_ratings(const Answer& like, const std::vector<Answer>& answers, Report& report) {
    std::vector<double> numbers;
    std::map<std::string, int> texts;
    for (const Answer& one : answers) {
        if (one.condition != like.condition || one.item != like.item || one.value == "n/a") continue;
        double number = 0.0;
        if (files::parse_number(one.value, number) && std::isfinite(number)) numbers.push_back(number);
        ++texts[one.value];
    }
    int n = 0;
    for (const auto& [value, count] : texts) n += count;
    if (n > 0 && n == static_cast<int>(numbers.size())) {
        report.ratings.push_back({like.condition, like.item, spread_of(numbers), "", n});
        return;
    }
    for (const auto& [value, count] : texts)
        report.ratings.push_back({like.condition, like.item, std::nullopt, value, count});
}

void add_ratings(const std::vector<Answer>& answers, Report& report) {
    std::set<std::pair<std::string, std::string>> done;
    for (const Answer& one : answers) {
        if (done.emplace(one.condition, one.item).second) add_ratings(one, answers, report);
    }
}

}  // namespace

Spread spread_of(std::vector<double> values) {
    std::sort(values.begin(), values.end());
    Spread out;
    out.n = static_cast<int>(values.size());
    out.mean = std::accumulate(values.begin(), values.end(), 0.0) / out.n;
    double squares = 0.0;
    for (const double value : values) squares += (value - out.mean) * (value - out.mean);
    out.sd = out.n > 1 ? std::sqrt(squares / (out.n - 1)) : 0.0;
    out.lower_quartile = files::sorted_quantile(values, 0.25);
    out.median = files::sorted_quantile(values, 0.5);
    out.upper_quartile = files::sorted_quantile(values, 0.75);
    return out;
}

Report make_report(const Observations& given, const ReportOptions& options) {
    Observations seen = given;
    sort_rows(seen);
    Report report;
    report.options = options;
    report.notes = seen.notes;
    report.participants = static_cast<int>(seen.participants.size());
    report.trials = static_cast<std::int64_t>(seen.trials.size());
    report.practice_trials = seen.practice_trials;
    report.interrupted_trials = seen.interrupted_trials;
    report.excluded_trials = seen.excluded_trials;
    report.progress = seen.progress;
    report.exclusions = seen.exclusions;
    report.replacements = seen.replacements;
    report.simulated = seen.simulated;
    for (int c = 0; c < static_cast<int>(seen.conditions.size()); ++c) {
        if (!rows_of(seen, c).empty()) report.conditions.push_back(condition_result(seen, c, options));
        std::set<int> comparisons{-1};
        for (const Choices& row : choice_rows_of(seen, c)) comparisons.insert(row.comparison);
        for (const int k : comparisons) {
            if (const auto choice = choice_result(seen, c, k, options)) report.choices.push_back(*choice);
        }
    }
    if (report.conditions.size() > kMostCompared) {
        report.notes.push_back("all pairs of " + std::to_string(report.conditions.size()) +
                               " conditions are not compared: that is done for up to " + std::to_string(kMostCompared));
    }
    add_ratings(seen.answers, report);
    report.pairs = all_pairs(seen, report.conditions, Quantity::sensitivity, options);
    report.ppv_pairs = all_pairs(seen, report.conditions, Quantity::ppv, options);
    return report;
}

}  // namespace palpa::study
