#include "study/power.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "files/text.h"
#include "study/statistics.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

constexpr double kUnknown = std::numeric_limits<double>::quiet_NaN();
const std::string kIgnoresClustering = "ignores clustering";

void add_pairs_found(const std::vector<PairResult>& pairs, const char* quantity, std::vector<Finding>& out) {
    for (const PairResult& pair : pairs) {
        const PeopleTest& test = pair.people;
        out.push_back({quantity, pair.a, pair.b, "t", "", test.p, test.difference, test.ci});
        out.push_back({quantity, pair.a, pair.b, "permutation", "", test.p_permutation});
        if (pair.bootstrap)
            out.push_back({quantity, pair.a, pair.b, "bootstrap", "", kUnknown, test.difference, *pair.bootstrap});
        if (pair.replication) {
            const Replication& r = *pair.replication;
            out.push_back({quantity, pair.a, pair.b, "Li et al.", "replication", r.significant ? 0.0 : 1.0,
                           test.difference, r.newcombe});
        }
        if (pair.paired) {
            out.push_back({quantity, pair.a, pair.b, "McNemar", kIgnoresClustering, pair.mcnemar_p, test.difference,
                           pair.newcombe_paired});
        }
    }
}

void add_share_found(const std::string& quantity, const std::string& condition, const std::optional<Share>& share,
                     std::vector<Finding>& out) {
    if (!share) return;
    out.push_back({quantity, condition, "", "Wilson", share->one_each ? "" : kIgnoresClustering, kUnknown, share->x.p(),
                   share->wilson});
    if (share->bootstrap)
        out.push_back({quantity, condition, "", "bootstrap", "", kUnknown, share->x.p(), *share->bootstrap});
}

void add_choices_found(const Report& report, std::vector<Finding>& out) {
    for (const ChoiceResult& choice : report.choices) {
        if (!choice.comparison.empty()) continue;
        add_share_found("correct", choice.condition, choice.correct, out);
        if (!choice.over_people) continue;
        const PeopleTest& test = *choice.over_people;
        out.push_back({"correct",
                       choice.condition,
                       "",
                       "t against one half",
                       "",
                       test.p,
                       0.5 + test.difference,
                       {0.5 + test.ci.low, 0.5 + test.ci.high}});
    }
}

void add_merits_found(const FreeResponseReport& found, std::vector<Finding>& out) {
    for (const MeritResult& result : found.tests) {
        for (const MeritPair& pair : result.test.pairs) {
            out.push_back({name_of(result.merit), found.conditions[pair.a], found.conditions[pair.b],
                           "Obuchowski-Rockette", "", pair.p, pair.difference, pair.ci});
        }
        for (std::size_t i = 0; i < result.test.conditions.size(); ++i) {
            const MeritOfCondition& one = result.test.conditions[i];
            out.push_back({name_of(result.merit), found.conditions[i], "", "Obuchowski-Rockette", "", kUnknown,
                           one.mean, one.ci});
        }
    }
}

using PowerKey = std::tuple<double, double, int, std::string, std::string, std::string, std::string>;

PowerKey power_key(const PowerRow& row, int participants) {
    const Finding& f = row.finding;
    return {row.effect, row.noise, participants, f.quantity, f.a, f.b, f.method};
}

struct EstimateMean {
    double sum = 0.0, squares = 0.0;
    std::int64_t n = 0;
    void add(double x) {
        if (!std::isfinite(x)) return;
        sum += x;
        squares += x * x;
        ++n;
    }
    double mean() const { return n > 0 ? sum / static_cast<double>(n) : kUnknown; }
    double standard_error() const {
        if (n < 2) return kUnknown;
        const auto count = static_cast<double>(n);
        const double variance = std::max(0.0, squares / count - mean() * mean()) * count / (count - 1.0);
        return std::sqrt(variance / count);
    }
};

// The estimates of a quantity, by whichever method has them in the most studies: one that has an interval in some studies
// alone would give a mean over chosen studies.
EstimateMean most_estimates(const std::map<PowerKey, EstimateMean>& estimates, PowerKey key) {
    std::get<6>(key).clear();  // the first key of all methods
    EstimateMean most;
    for (auto it = estimates.lower_bound(key); it != estimates.end(); ++it) {
        PowerKey same = it->first;
        std::get<6>(same).clear();
        if (same != key) break;
        if (it->second.n > most.n) most = it->second;
    }
    return most;
}

// Else an interval alone.
bool is_test(const Finding& finding) {
    return finding.method != "bootstrap" && finding.method != "Wilson" &&
           (!finding.b.empty() || finding.method == "t against one half");
}

bool is_log_odds(const Finding& finding) { return finding.quantity == "log odds"; }

// The true value of what a row estimates, and its error.
void set_truth(const Finding& what, double effect, const EstimateMean& of_most, PowerResult& result) {
    const bool difference = !what.b.empty();
    if (what.label == kSameGroups) {
        result.truth = 0.0;
    } else if (is_log_odds(what)) {
        result.truth = effect == 0.0 && difference ? 0.0 : kUnknown;
    } else if (effect == 0.0 && difference) {
        result.truth = 0.0;
    } else {
        result.truth = of_most.mean();
        result.truth_se = of_most.standard_error();
    }
}

std::string number_cell(double x) { return std::isfinite(x) ? fixed(x, 4) : kNone; }

}  // namespace

std::vector<Finding> findings_of(const Report& report) {
    std::vector<Finding> out;
    if (report.primary) {
        const PrimaryResult& primary = *report.primary;
        out.push_back({name_of(primary.stated.quantity), primary.stated.sides[0], primary.stated.sides[1], "primary",
                       primary.stated.of_groups ? kSameGroups : "", primary.p, primary.people.difference,
                       primary.people.ci});
    }
    add_pairs_found(report.pairs, "sensitivity", out);
    add_pairs_found(report.ppv_pairs, "ppv", out);
    add_pairs_found(report.choice_pairs, "correct", out);
    for (const GroupResult& group : report.group_comparisons) {
        const std::string under = group.condition + (group.condition_b.empty() ? "" : " - " + group.condition_b);
        out.push_back({name_of(group.quantity), group.group_a + ", " + under, group.group_b + ", " + under, "groups",
                       kSameGroups, group.people.p, group.people.difference, group.people.ci});
    }
    for (const ConditionResult& one : report.conditions) {
        add_share_found("sensitivity", one.name, one.se, out);
        add_share_found("ppv", one.name, one.ppv, out);
    }
    add_choices_found(report, out);
    add_merits_found(report.free_response, out);
    for (const MixedPair& pair : report.mixed.pairs) {
        out.push_back({"log odds",
                       pair.a,
                       pair.b,
                       "mixed model",
                       "",
                       pair.p,
                       std::log(pair.odds_ratio),
                       {std::log(pair.ci.low), std::log(pair.ci.high)}});
    }
    return out;
}

double PowerShare::standard_error() const {
    return n > 0 ? std::sqrt(rate() * (1.0 - rate()) / static_cast<double>(n)) : kUnknown;
}

Interval PowerShare::interval() const {
    return n > 0 ? wilson({hits, n}, z_of_level(0.95)) : Interval{kUnknown, kUnknown};
}

std::vector<PowerResult> summarise_power(const std::vector<PowerRow>& rows, std::int64_t studies, double alpha) {
    int most = 0;
    for (const PowerRow& row : rows) most = std::max(most, row.participants);
    std::map<PowerKey, EstimateMean> estimates;
    std::map<PowerKey, std::size_t> places;
    std::vector<PowerResult> results;
    for (const PowerRow& row : rows) {
        estimates[power_key(row, row.participants)].add(row.finding.estimate);
        const auto [it, fresh] = places.emplace(power_key(row, row.participants), results.size());
        if (!fresh) continue;
        const Finding& f = row.finding;
        results.push_back({row.effect, row.noise, row.participants, {f.quantity, f.a, f.b, f.method, f.label}});
    }
    for (PowerResult& result : results) {
        const PowerRow probe{result.effect, result.noise, result.participants, result.what};
        result.mean_estimate = estimates[power_key(probe, result.participants)].mean();
        set_truth(result.what, result.effect, most_estimates(estimates, power_key(probe, most)), result);
    }
    for (const PowerRow& row : rows) {
        PowerResult& result = results[places[power_key(row, row.participants)]];
        const Finding& f = row.finding;
        if (!f.label.empty()) result.what.label = f.label;  // what holds in one study is said of all
        if (!std::isnan(f.p)) ++result.tested;
        if (f.p < alpha) ++result.rejections.hits;
        if (is_test(f)) result.rejections.n = studies;  // those in which it cannot be computed do not reject
        if (!f.has_interval() || std::isnan(result.truth)) continue;
        ++result.coverage.n;
        if (f.ci.low <= result.truth && result.truth <= f.ci.high) ++result.coverage.hits;
    }
    std::stable_sort(results.begin(), results.end(), [](const PowerResult& a, const PowerResult& b) {
        return std::tie(a.effect, a.noise, a.participants) < std::tie(b.effect, b.noise, b.participants);
    });
    return results;
}

namespace {

files::Json share_json(const PowerShare& share) {
    if (share.n == 0) return nullptr;
    const Interval ci = share.interval();
    return {{"rate", share.rate()},
            {"hits", share.hits},
            {"studies", share.n},
            {"monte_carlo_se", share.standard_error()},
            {"monte_carlo_ci", {ci.low, ci.high}}};
}

}  // namespace

files::Json power_json(const std::vector<PowerResult>& results) {
    files::Json json = files::Json::array();
    for (const PowerResult& one : results) {
        json.push_back({{"effect", one.effect},
                        {"noise", one.noise},
                        {"participants", one.participants},
                        {"quantity", one.what.quantity},
                        {"a", one.what.a},
                        {"b", one.what.b.empty() ? files::Json(nullptr) : files::Json(one.what.b)},
                        {"method", one.what.method},
                        {"label", one.what.label},
                        {one.effect == 0.0 ? "type_I_error" : "power", share_json(one.rejections)},
                        {"tested", one.rejections.n > 0 ? files::Json(one.tested) : files::Json(nullptr)},
                        {"coverage", share_json(one.coverage)},
                        {"mean_estimate", files::number_or_null(one.mean_estimate)},
                        {"true_value", files::number_or_null(one.truth)},
                        {"true_value_se", files::number_or_null(one.truth_se)}});
    }
    return json;
}

ReportTable power_table(const std::vector<PowerResult>& results) {
    ReportTable table{"power", "Tests and intervals over simulated studies", {}, {}};
    const files::Json dictionary = power_dictionary();
    for (const auto& [column, text] : dictionary.items()) table.columns.push_back(column);
    for (const PowerResult& one : results) {
        const PowerShare& r = one.rejections;
        const PowerShare& c = one.coverage;
        const Interval of_r = r.interval(), of_c = c.interval();
        table.rows.push_back({files::short_number(one.effect),
                              files::short_number(one.noise),
                              whole(one.participants),
                              one.what.quantity,
                              one.what.a,
                              one.what.b.empty() ? kNone : one.what.b,
                              one.what.method,
                              one.what.label.empty() ? kNone : one.what.label,
                              number_cell(r.rate()),
                              number_cell(r.standard_error()),
                              number_cell(of_r.low),
                              number_cell(of_r.high),
                              whole(r.n),
                              r.n > 0 ? whole(one.tested) : kNone,
                              number_cell(c.rate()),
                              number_cell(c.standard_error()),
                              number_cell(of_c.low),
                              number_cell(of_c.high),
                              whole(c.n),
                              number_cell(one.mean_estimate),
                              number_cell(one.truth),
                              number_cell(one.truth_se)});
    }
    return table;
}

files::Json power_dictionary() {
    const auto text = [](const char* words) { return files::Json{{"Description", words}}; };
    return {
        {"effect", text("share of the trials under a condition that have its own scene; 0: no condition differs")},
        {"noise", text("factor on the noise of the simulated eye")},
        {"participants", text("of each simulated study")},
        {"quantity", text("sensitivity, ppv, correct, a figure of merit, or log odds")},
        {"a", text("condition or group")},
        {"b", text("condition or group that a is compared with; n/a: a alone")},
        {"method", text("of the test or the interval")},
        {"label", text("replication or ignores clustering: takes trials of one person as independent")},
        {"rejected", text("share of the studies in which p was below alpha: power, or with effect 0 the type I error")},
        {"rejected_se", text("Monte Carlo standard error of rejected")},
        {"rejected_low", text("lower limit of Wilson's 95 % interval of rejected")},
        {"rejected_high", text("upper limit of Wilson's 95 % interval of rejected")},
        {"rejected_n", text("studies; 0: no test")},
        {"tested", text("studies in which the test could be computed; the others count as not rejected")},
        {"covered", text("share of the intervals that hold the true value")},
        {"covered_se", text("Monte Carlo standard error of covered")},
        {"covered_low", text("lower limit of Wilson's 95 % interval of covered")},
        {"covered_high", text("upper limit of Wilson's 95 % interval of covered")},
        {"covered_n", text("intervals that could be computed; 0: none, or the true value is not known")},
        {"mean_estimate", text("mean over studies")},
        {"true_value", text("0 without an effect; else the mean estimate of the largest studies")},
        {"true_value_se", text("Monte Carlo standard error of true_value")}};
}

}  // namespace palpa::study
