#include "study/report.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>
#include <numeric>
#include <set>
#include <utility>

#include "files/quantile.h"
#include "files/text.h"
#include "study/contributions.h"
#include "study/rows_by_condition.h"

namespace palpa::study {
namespace {

std::size_t at(int i) { return static_cast<std::size_t>(i); }

std::optional<Interval> known(const Interval& ci) {
    if (std::isnan(ci.low)) return std::nullopt;
    return ci;
}

// The pooled share of these people, or of all counts if they name nobody.
Share share_of(const Proportion& x, const People& people, const BootstrapOptions& options) {
    Share share{x, wilson(x, z_of_level(options.level)), std::nullopt, false};
    share.one_each = !people.empty() &&
                     std::all_of(people.begin(), people.end(), [](const auto& one) { return !one || one->n <= 1; });
    if (!share.one_each) share.bootstrap = known(bootstrap_share(people, options));
    return share;
}

std::optional<Share> share_of(const Observations& seen, int condition, int nodule, Quantity quantity,
                              const ReportOptions& options) {
    Proportion x{0, 0};
    for (const Observation& row : rows_of(seen, condition, nodule)) {
        x.k += row.tp;
        x.n += row.tp + (quantity == Quantity::sensitivity ? row.fn : row.fp);
    }
    if (x.n == 0) return std::nullopt;
    return share_of(x, people_who_took_part(seen, condition, quantity, nodule), options.bootstrap);
}

std::optional<Spread> spread_over(const Observations& seen, int condition, double TrialFigures::*field) {
    std::vector<double> values;
    for (const TrialFigures& trial : seen.trials) {
        if (trial.condition == condition && std::isfinite(trial.*field)) values.push_back(trial.*field);
    }
    if (values.empty()) return std::nullopt;
    return spread_of(std::move(values));
}

std::set<int> people_with_tests(const Observations& seen) {
    std::set<int> people;
    for (const Observation& row : seen.rows) people.insert(row.participant);
    for (const Choices& row : seen.choices) people.insert(row.participant);
    for (const StifferAnswers& row : seen.stiffer) people.insert(row.participant);
    people.erase(-1);
    return people;
}

// Why participants with logs are not in the tables. `seen`: of everybody.
void count_people_without(const Observations& seen, Report& report) {
    const auto has_logs = [&](const std::string& code) {
        return std::find(seen.participants.begin(), seen.participants.end(), code) != seen.participants.end();
    };
    std::set<std::string> tested, excluded, replaced;
    for (const int person : people_with_tests(seen)) tested.insert(seen.participants[static_cast<std::size_t>(person)]);
    const auto is_replaced = [&](const std::string& code) {
        return std::any_of(seen.replacements.begin(), seen.replacements.end(),
                           [&](const Replacement& one) { return one.participant == code; });
    };
    for (const Exclusion& one : seen.exclusions) {  // somebody each of whose tests is left out, too
        const bool last_test = tested.count(one.participant) == 0 && !is_replaced(one.participant);
        if (has_logs(one.participant) && (!one.trial || last_test)) excluded.insert(one.participant);
    }
    for (const Replacement& one : seen.replacements)
        if (has_logs(one.participant) && excluded.count(one.participant) == 0) replaced.insert(one.participant);
    report.withdrawn_people = seen.withdrawn_people;
    report.people_without_trial = seen.people_without_trial;
    report.excluded_people = static_cast<int>(excluded.size());
    report.replaced_people = static_cast<int>(replaced.size());
    const int with_logs = static_cast<int>(seen.participants.size()) + seen.withdrawn_people;
    report.people_without = with_logs - report.participants;
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

std::optional<ChoiceResult> choice_result(const Observations& seen, int condition, int comparison,
                                          const ReportOptions& options) {
    ChoiceResult out;
    out.condition = seen.conditions[at(condition)];
    if (comparison >= 0) out.comparison = seen.comparisons[at(comparison)];
    Proportion x{0, 0};
    for (const Choices& row : choice_rows_of(seen, condition, comparison)) {
        x.k += row.correct;
        x.n += row.n;
    }
    if (x.n == 0) return std::nullopt;
    constexpr double kChance = 0.5;
    const double level = options.bootstrap.level;
    const People people = people_who_took_part(seen, condition, Quantity::correct, comparison);
    out.correct = share_of(x, people, options.bootstrap);
    out.binomial_p = exact_binomial_p(x, kChance);
    if (x.n >= 2) out.over_answers = t_test_of_answers(x, kChance, level);
    if (!people.empty()) out.over_people = compare_with_chance(people, kChance, {level, options.bootstrap.seed, true});
    return out;
}

// Holm's correction over the conditions, and apart from them over all single comparisons.
void correct_choices(std::vector<ChoiceResult>& choices) {
    for (const bool single : {false, true}) {
        std::vector<ChoiceResult*> family;
        std::vector<double> p;
        for (ChoiceResult& one : choices) {
            if (one.comparison.empty() == single || !one.over_people) continue;
            family.push_back(&one);
            p.push_back(one.over_people->p);
        }
        p = holm_of_known(p);
        for (std::size_t i = 0; i < family.size(); ++i) family[i]->p_holm = p[i];
    }
}

// Says that the pairs of very many conditions are not compared.
void note_many_conditions(Report& report) {
    const auto choices = std::count_if(report.choices.begin(), report.choices.end(),
                                       [](const ChoiceResult& one) { return one.comparison.empty(); });
    const std::size_t most = std::max(report.conditions.size(), static_cast<std::size_t>(choices));
    if (most <= kMostCompared) return;
    report.notes.push_back("all pairs of " + std::to_string(most) +
                           " conditions are not compared: that is done for up to " + std::to_string(kMostCompared));
}

// Names the conditions with so few people that intervals over people cover too seldom.
void note_few_people(Report& report) {
    constexpr int kFew = 10;
    constexpr int kMostNamed = 20;
    std::string few;
    int number = 0;
    const auto add = [&](const std::string& name, int people) {
        if (people == 0 || people >= kFew || ++number > kMostNamed) return;
        few += (few.empty() ? "" : ", ") + name + " (" + std::to_string(people) + ")";
    };
    for (const ConditionResult& one : report.conditions) add(one.name, one.participants);
    for (const ChoiceResult& one : report.choices) {
        if (one.comparison.empty() && one.over_people) add(one.condition, one.over_people->people_a);
    }
    for (const Report& group : report.groups) {
        int people = 0;
        for (const ConditionResult& one : group.conditions) people = std::max(people, one.participants);
        for (const ChoiceResult& one : group.choices)
            people = std::max(people, one.over_people ? one.over_people->people_a : 0);
        add("group " + group.group, people);
    }
    if (few.empty()) return;
    if (number > kMostNamed) few += " and " + std::to_string(number - kMostNamed) + " others";
    report.notes.push_back("WARNING: fewer than " + std::to_string(kFew) + " people: " + few +
                           ". Bootstrap intervals of so few cover less than they say, and no test can show much");
}

// Returns of how many people the smallest resampled set is, 0 if nobody is resampled.
std::size_t fewest_resampled(const Report& report) {
    std::size_t fewest = 0;
    const auto add = [&](std::size_t people) {
        if (people > 0 && (fewest == 0 || people < fewest)) fewest = people;
    };
    for (const ConditionResult& one : report.conditions) {
        if ((one.se && one.se->bootstrap) || (one.ppv && one.ppv->bootstrap)) add(at(one.participants));
    }
    for (const ChoiceResult& one : report.choices) {
        if (one.correct.bootstrap && one.over_people) add(at(one.over_people->people_a));
    }
    for (const auto* pairs : {&report.pairs, &report.ppv_pairs, &report.choice_pairs}) {
        for (const PairResult& one : *pairs) {
            const bool within = one.people.design == Design::within;
            if (one.bootstrap) add(at(one.people.people_a + (within ? 0 : one.people.people_b)));
        }
    }
    for (const PsychometricResult& one : report.psychometrics.curves) {
        if (one.method == IntervalMethod::bootstrap) add(at(one.participants));
    }
    for (const Report& group : report.groups) add(fewest_resampled(group));
    return fewest;
}

// The jackknife's error, and so the t test of PPV, does not hold where one condition has far fewer marks than another.
void note_uneven_marks(Report& report) {
    constexpr std::int64_t kUneven = 2;
    if (report.ppv_pairs.empty()) return;
    const auto marks = [](const ConditionResult& one) { return one.tp + one.fp; };
    const ConditionResult* most = nullptr;
    const ConditionResult* fewest = nullptr;
    for (const ConditionResult& one : report.conditions) {
        if (marks(one) == 0) continue;
        if (most == nullptr || marks(one) > marks(*most)) most = &one;
        if (fewest == nullptr || marks(one) < marks(*fewest)) fewest = &one;
    }
    if (most == nullptr || marks(*most) <= kUneven * marks(*fewest)) return;
    report.notes.push_back(
        "WARNING: " + most->name + " has " + std::to_string(marks(*most)) +
        " marks (hits and false ones, each nodule once), " + fewest->name + " " + std::to_string(marks(*fewest)) +
        ". With so uneven numbers the t test of PPV does not keep its level; its permutation does, from five false "
        "marks on");
}

// Says why tests of PPV have no permutation.
void note_unfit_permutations(Report& report) {
    const auto unfit = [](const auto& pair) { return pair.people.permutation_unfit; };
    const auto any_unfit = [&](const auto& pairs) { return std::any_of(pairs.begin(), pairs.end(), unfit); };
    if (!any_unfit(report.ppv_pairs) && !any_unfit(report.group_comparisons)) return;
    report.notes.push_back(
        "tests of PPV without a permutation: one side has more than 1.25 times the marks of the other, and fewer than "
        "five of all are false (or right); an exchange of the sides would say which has more marks");
}

// Says how many hits and misses the tables of nodules leave out.
void note_unnamed_nodules(const Observations& seen, Report& report) {
    const UnnamedJudgements counts = unnamed_judgements(seen);
    const bool table = std::any_of(report.conditions.begin(), report.conditions.end(),
                                   [](const auto& one) { return !one.nodules.empty(); });
    if (!table || counts.no_nodule == 0) return;
    report.notes.push_back("The tables of nodules (nodules, pairs_ignoring_clustering) leave out " +
                           std::to_string(counts.no_nodule) + " of " + std::to_string(counts.all) +
                           " hits and misses, because " +
                           (seen.from_logs ? "their logs have no settings that name the nodules"
                                           : "the counts do not name their nodules"));
}

// Says that the level asks for more resamples than there are: the limits are then near the least and the greatest draw.
// Of fewer than ten people it speaks as of ten, since note_few_people() warns of them.
void note_few_resamples(Report& report) {
    constexpr std::size_t kFew = 10;
    constexpr double kMost = 1e6;  // that can be asked for
    const std::size_t people = fewest_resampled(report);
    const BootstrapOptions& options = report.options.bootstrap;
    const double needed = resamples_needed(options.level, std::max(people, kFew));
    if (people == 0 || needed <= options.resamples) return;
    const std::string level = files::short_number(100.0 * options.level) + " %";
    report.notes.push_back(
        "WARNING: bootstrap intervals at " + level + " of " + std::to_string(people) + " people need " +
        (needed > kMost
             ? "more than the 1000000 resamples that can be asked for, so choose a lower level"
             : "at least " + std::to_string(static_cast<std::int64_t>(needed)) + " resamples (--resamples)") +
        "; of " + std::to_string(options.resamples) + " too few lie beyond the limits to tell where these are");
}

// Adds one row for answers on a scale, or one row for each text that was given.
void add_ratings(const Answer& like, const std::vector<Answer>& answers, Report& report) {
    std::vector<double> numbers;
    std::map<std::string, int> texts;
    for (const Answer& one : answers) {
        if (one.condition != like.condition || one.item != like.item || one.value == "n/a") continue;
        double number = 0.0;
        if (!one.chosen && files::parse_number(one.value, number) && std::isfinite(number)) numbers.push_back(number);
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
    out.sd = out.n > 1 ? std::sqrt(squares / (out.n - 1)) : std::numeric_limits<double>::quiet_NaN();
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
    report.participants = static_cast<int>(people_with_tests(seen).size());
    count_people_without(seen, report);
    report.trials = static_cast<std::int64_t>(seen.trials.size());
    report.forced_choices = seen.from_logs ? static_cast<std::int64_t>(seen.stiffer.size()) : 0;
    report.practice_trials = seen.practice_trials;
    report.interrupted_trials = seen.interrupted_trials;
    report.excluded_trials = seen.excluded_trials;
    report.withdrawn_trials = seen.withdrawn_trials;
    report.progress = seen.progress;
    const auto other = [&](const ConditionDisplay& one) { return one.display != seen.displays.front().display; };
    if (std::any_of(seen.displays.begin(), seen.displays.end(), other)) report.displays = seen.displays;
    report.exclusions = seen.exclusions;
    report.replacements = seen.replacements;
    report.simulated = seen.simulated;
    report.staircases = seen.staircases;
    for (int c = 0; c < static_cast<int>(seen.conditions.size()); ++c) {
        if (!rows_of(seen, c).empty()) report.conditions.push_back(condition_result(seen, c, options));
        std::set<int> comparisons{-1};
        for (const Choices& row : choice_rows_of(seen, c)) comparisons.insert(row.comparison);
        for (const int k : comparisons) {
            if (const auto choice = choice_result(seen, c, k, options)) report.choices.push_back(*choice);
        }
    }
    correct_choices(report.choices);
    report.psychometrics = psychometrics_of(seen, options.greatest_lapse, options.bootstrap);
    report.notes.insert(report.notes.end(), report.psychometrics.notes.begin(), report.psychometrics.notes.end());
    note_many_conditions(report);
    add_ratings(seen.answers, report);
    report.primary = primary_result(seen, options.bootstrap);
    report.pairs = compare_conditions(seen, Quantity::sensitivity, options.bootstrap);
    report.ppv_pairs = compare_conditions(seen, Quantity::ppv, options.bootstrap);
    report.choice_pairs = compare_conditions(seen, Quantity::correct, options.bootstrap);
    report.free_response = free_response_report(seen, options.bootstrap.level);
    report.mixed = mixed_report(seen, options.bootstrap.level);
    if (seen.groups.size() >= 2) {
        report.group_comparisons = compare_groups(seen, options.bootstrap);
        for (int g = 0; g < static_cast<int>(seen.groups.size()); ++g) {
            Observations part = only_group(seen, g);
            part.groups.clear();
            part.primary.reset();
            part.notes.clear();
            report.groups.push_back(make_report(part, options));
            report.groups.back().group = seen.groups[at(g)];
            report.groups.back().people_without =
                static_cast<int>(std::count(seen.group_of.begin(), seen.group_of.end(), g)) -
                report.groups.back().participants;
        }
    }
    const auto pairs = std::max({report.pairs.size(), report.ppv_pairs.size(), report.choice_pairs.size()});
    if (!resamples(pairs, seen.participants.size())) {
        report.notes.push_back("Of " + std::to_string(pairs) + " pairs of conditions and " +
                               std::to_string(seen.participants.size()) +
                               " people the bootstrap and the permutation tests are left out");
    }
    note_few_people(report);
    note_few_resamples(report);
    note_uneven_marks(report);
    note_unfit_permutations(report);
    note_unnamed_nodules(seen, report);
    return report;
}

}  // namespace palpa::study
