#include "study/report.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "files/quantile.h"
#include "files/text.h"

namespace palpa::study {
namespace {

using People = std::vector<Contribution>;  // index: participant

std::size_t at(int i) { return static_cast<std::size_t>(i); }

// Both count hits, as a share of the nodules (sensitivity) or of the marks (PPV).
enum class Quantity { sensitivity, ppv };

Contribution part_of(const Observation& row, Quantity quantity) {
    return {row.tp, row.tp + (quantity == Quantity::sensitivity ? row.fn : row.fp)};
}

// Sums the rows of each participant; `nodule` -1 takes all nodules. Empty if some of the rows do not name their
// participant.
People by_participant(const Observations& seen, int condition, int nodule, Quantity quantity) {
    People people(seen.participants.size());
    for (const Observation& row : seen.rows) {
        if (row.condition != condition || (nodule >= 0 && row.nodule != nodule)) continue;
        if (row.participant < 0) return {};
        const Contribution part = part_of(row, quantity);
        people[at(row.participant)].k += part.k;
        people[at(row.participant)].n += part.n;
    }
    return people;
}

std::optional<Interval> known(const Interval& ci) {
    if (std::isnan(ci.low)) return std::nullopt;
    return ci;
}

std::optional<Share> share_of(const Observations& seen, int condition, int nodule, Quantity quantity,
                              const ReportOptions& options) {
    Proportion x{0, 0};
    for (const Observation& row : seen.rows) {
        if (row.condition != condition || (nodule >= 0 && row.nodule != nodule)) continue;
        x.k += part_of(row, quantity).k;
        x.n += part_of(row, quantity).n;
    }
    if (x.n == 0) return std::nullopt;
    const People people = by_participant(seen, condition, nodule, quantity);
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
    std::vector<bool> took_part(seen.participants.size(), false);
    for (const Observation& row : seen.rows) {
        if (row.condition != condition) continue;
        out.tp += row.tp;
        out.fn += row.fn;
        out.fp += row.fp;
        if (row.participant >= 0) took_part[at(row.participant)] = true;
    }
    out.participants = static_cast<int>(std::count(took_part.begin(), took_part.end(), true));
    out.se = share_of(seen, condition, -1, Quantity::sensitivity, options);
    out.ppv = share_of(seen, condition, -1, Quantity::ppv, options);
    for (int nodule = 0; nodule < static_cast<int>(seen.nodules.size()); ++nodule) {
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
    std::map<std::array<int, 3>, std::array<int, 2>> found;  // -1: not judged
    for (const Observation& row : seen.rows) {
        if ((row.condition != a && row.condition != b) || row.participant < 0 || row.nodule < 0) continue;
        if (row.tp + row.fn != 1) continue;  // sums of several judgements cannot be matched
        auto [it, fresh] = found.try_emplace({row.participant, row.nodule, row.repeat}, std::array<int, 2>{-1, -1});
        it->second[row.condition == a ? 0 : 1] = static_cast<int>(row.tp);
    }
    PairedCounts counts;
    for (const auto& [key, hit] : found) {
        if (hit[0] < 0 || hit[1] < 0) continue;
        std::int64_t& cell =
            hit[0] == 1 ? (hit[1] == 1 ? counts.both : counts.only_a) : (hit[1] == 1 ? counts.only_b : counts.neither);
        ++cell;
    }
    if (counts.n() == 0) return std::nullopt;
    return counts;
}

PairResult pair_result(const Observations& seen, int a, int b, const Share& of_a, const Share& of_b, Quantity quantity,
                       const ReportOptions& options) {
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
    const People people_a = by_participant(seen, a, -1, quantity);
    const People people_b = by_participant(seen, b, -1, quantity);
    if (people_a.empty() || people_b.empty()) return pair;
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
    const auto share = [&](std::size_t i) {
        return quantity == Quantity::sensitivity ? conditions[i].se : conditions[i].ppv;
    };
    for (std::size_t a = 0; a < conditions.size(); ++a) {
        for (std::size_t b = a + 1; b < conditions.size(); ++b) {
            if (!share(a) || !share(b)) continue;
            pairs.push_back(pair_result(seen, place_of(seen, conditions[a]), place_of(seen, conditions[b]), *share(a),
                                        *share(b), quantity, options));
        }
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
    People people(seen.participants.size());
    bool all_told = true;
    for (const Choices& row : seen.choices) {
        if (row.condition != condition || (comparison >= 0 && row.comparison != comparison)) continue;
        x.k += row.correct;
        x.n += row.n;
        all_told = all_told && row.participant >= 0;
        if (row.participant < 0) continue;
        people[at(row.participant)].k += row.correct;
        people[at(row.participant)].n += row.n;
    }
    if (x.n == 0) return std::nullopt;
    constexpr double kChance = 0.5;
    const double level = options.bootstrap.level;
    out.correct.wilson = wilson(x, z_of_level(level));
    out.binomial_p = exact_binomial_p(x, kChance);
    if (x.n >= 2) {
        std::vector<double> answers(at(static_cast<int>(x.n)), 0.0);
        std::fill(answers.begin(), answers.begin() + x.k, 1.0);
        out.over_answers = t_test(answers, kChance, level);
    }
    if (!all_told) return out;
    out.correct.bootstrap = known(bootstrap_share(people, options.bootstrap));
    std::vector<double> shares;
    for (const Contribution& one : people) {
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

Report make_report(const Observations& seen, const ReportOptions& options) {
    Report report;
    report.options = options;
    report.notes = seen.notes;
    report.participants = static_cast<int>(seen.participants.size());
    report.trials = static_cast<std::int64_t>(seen.trials.size());
    report.practice_trials = seen.practice_trials;
    report.interrupted_trials = seen.interrupted_trials;
    report.simulated = seen.simulated;
    for (int c = 0; c < static_cast<int>(seen.conditions.size()); ++c) {
        const auto here = [&](const Observation& row) { return row.condition == c; };
        const bool marked = std::any_of(seen.rows.begin(), seen.rows.end(), here);
        if (marked) report.conditions.push_back(condition_result(seen, c, options));
        for (int k = -1; k < static_cast<int>(seen.comparisons.size()); ++k) {
            if (const auto choice = choice_result(seen, c, k, options)) report.choices.push_back(*choice);
        }
    }
    report.psychometrics = psychometrics_of(seen, options.greatest_lapse, options.bootstrap);
    report.notes.insert(report.notes.end(), report.psychometrics.notes.begin(), report.psychometrics.notes.end());
    add_ratings(seen.answers, report);
    report.pairs = all_pairs(seen, report.conditions, Quantity::sensitivity, options);
    report.ppv_pairs = all_pairs(seen, report.conditions, Quantity::ppv, options);
    return report;
}

}  // namespace palpa::study
