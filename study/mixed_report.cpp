#include "study/mixed_report.h"

#include <algorithm>
#include <cmath>
#include <map>
#include <tuple>

#include "files/distributions.h"
#include "files/text.h"
#include "study/comparisons.h"
#include "study/report.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

// Cells x parameters^2, summed over the fits: some ten seconds, by estimate.
constexpr double kMostMixedWork = 2e6;
constexpr std::size_t kMostMixedCells = 50'000;

std::size_t place(int i) { return static_cast<std::size_t>(i); }

// A row of one nodule that somebody with a name could find.
bool is_judged_nodule(const Observation& row) { return row.participant >= 0 && row.nodule >= 0 && row.tp + row.fn > 0; }

// Names that the model uses, in the order of their old indices.
struct UsedNames {
    std::vector<std::string> names;
    std::vector<int> moved;
};

UsedNames used_names(const Observations& seen, int Observation::*which, const std::vector<std::string>& names) {
    UsedNames out{{}, std::vector<int>(names.size(), -1)};
    for (const Observation& row : seen.rows) {
        if (is_judged_nodule(row)) out.moved[place(row.*which)] = 0;
    }
    for (std::size_t i = 0; i < names.size(); ++i) {
        if (out.moved[i] < 0) continue;
        out.moved[i] = static_cast<int>(out.names.size());
        out.names.push_back(names[i]);
    }
    return out;
}

// Why there is no model: some hits and misses do not name their person or their nodule. Empty if all do.
std::string unnamed(const UnnamedJudgements& counts) {
    const std::int64_t n = counts.no_participant > 0 ? counts.no_participant : counts.no_nodule;
    if (n == 0) return "";
    return std::string("cannot be computed, because the ") + (counts.no_participant > 0 ? "participant" : "nodule") +
           " of " + whole(n) + " of " + whole(counts.all) + " hits and misses is not known";
}

struct NamedMixed {
    MixedData data;
    std::vector<std::string> conditions;
};

NamedMixed mixed_data(const Observations& seen) {
    const UsedNames conditions = used_names(seen, &Observation::condition, seen.conditions);
    const UsedNames people = used_names(seen, &Observation::participant, seen.participants);
    const UsedNames nodules = used_names(seen, &Observation::nodule, seen.nodules);
    NamedMixed out{{static_cast<int>(conditions.names.size()),
                    static_cast<int>(people.names.size()),
                    static_cast<int>(nodules.names.size()),
                    {}},
                   conditions.names};
    std::map<std::tuple<int, int, int>, std::pair<std::int64_t, std::int64_t>> sums;
    for (const Observation& row : seen.rows) {
        if (!is_judged_nodule(row)) continue;
        if (sums.size() > kMostMixedCells) break;  // too many for a fit
        auto& sum = sums[{conditions.moved[place(row.condition)], people.moved[place(row.participant)],
                          nodules.moved[place(row.nodule)]}];
        sum.first += row.tp;
        sum.second += row.tp + row.fn;
    }
    for (const auto& [key, sum] : sums)
        out.data.cells.push_back({std::get<0>(key), std::get<1>(key), std::get<2>(key), sum.first, sum.second});
    return out;
}

double ratio_of(const MixedFit& fit, const MixedFit& null) {
    return null.status.empty() ? std::max(0.0, 2.0 * (fit.log_likelihood - null.log_likelihood)) : std::nan("");
}

// The work of one fit.
double work_of(const NamedMixed& named) {
    const double parameters = named.data.conditions + 2.0;
    return static_cast<double>(named.data.cells.size()) * parameters * parameters;
}

MixedPair compare_mixed(const NamedMixed& named, const MixedFit& fit, int a, int b, double level, bool wald) {
    std::vector<int> same;
    for (int c = 0, next = 0; c < named.data.conditions; ++c) same.push_back(c == b ? same[place(a)] : next++);
    const double difference = fit.beta[place(a)] - fit.beta[place(b)];
    const double arm = z_of_level(level) * standard_error(fit, a, b);
    MixedPair out{named.conditions[place(a)],
                  named.conditions[place(b)],
                  std::exp(difference),
                  {std::exp(difference - arm), std::exp(difference + arm)}};
    out.wald = wald;
    out.likelihood_ratio = wald ? std::nan("") : ratio_of(fit, fit_mixed_logistic(named.data, same));
    const double z = difference / standard_error(fit, a, b);
    out.p = wald ? 2.0 * files::normal_probability(-std::abs(z)) : files::chi_squared_p(out.likelihood_ratio, 1.0);
    return out;
}

void note_weaknesses(MixedReport& out) {
    constexpr int kFewNodules = 6;
    if (out.nodules < kFewNodules) {
        out.notes.push_back("WARNING: " + whole(out.nodules) +
                            " nodules: their spread can hardly be estimated from fewer than " + whole(kFewNodules) +
                            ", and intervals over other nodules are too narrow");
    }
    if (!out.pairs.empty() && out.pairs.front().wald) {
        out.notes.push_back(
            "Pairs are tested by Wald's test, because so many likelihood-ratio tests would take too long");
    }
    if (out.fit.prior) {
        out.notes.push_back(
            "Separation: under a condition everything was found, or nothing. Each condition's log odds has "
            "a normal prior with mean 0 and standard deviation 3, in the tests too");
    }
    if (out.fit.covariance.empty()) {
        out.notes.push_back(
            "A spread is estimated as 0: standard errors hold for these spreads, and the sensitivity over the "
            "population has no interval");
    }
}

void compare_all(const NamedMixed& named, double level, MixedReport& out) {
    for (int c = 0; c < named.data.conditions; ++c) {
        out.conditions.push_back({named.conditions[place(c)], out.fit.beta[place(c)], standard_error(out.fit, c, -1),
                                  averaged_share(out.fit, c, level)});
    }
    out.df = named.data.conditions - 1;
    if (out.df == 0) return;
    out.likelihood_ratio =
        ratio_of(out.fit, fit_mixed_logistic(named.data, std::vector<int>(place(named.data.conditions), 0)));
    out.p = files::chi_squared_p(out.likelihood_ratio, out.df);
    const double fits = 2.0 + 0.5 * named.data.conditions * out.df;
    const bool wald = fits * work_of(named) > kMostMixedWork;
    std::vector<double> p;
    for (int a = 0; a < named.data.conditions; ++a) {
        for (int b = a + 1; b < named.data.conditions; ++b) {
            out.pairs.push_back(compare_mixed(named, out.fit, a, b, level, wald));
            p.push_back(out.pairs.back().p);
        }
    }
    p = holm_of_known(p);
    for (std::size_t i = 0; i < p.size(); ++i) out.pairs[i].p_holm = p[i];
}

files::Json two(const Interval& ci) { return {files::number_or_null(ci.low), files::number_or_null(ci.high)}; }

files::Json mixed_condition_json(const MixedCondition& one) {
    return {{"condition", one.condition},
            {"log_odds", one.log_odds},
            {"se", files::number_or_null(one.se)},
            {"sensitivity", one.share.share},
            {"sensitivity_ci", one.share.ci ? two(*one.share.ci) : files::Json(nullptr)}};
}

files::Json mixed_pair_json(const MixedPair& pair) {
    return {{"a", pair.a},
            {"b", pair.b},
            {"odds_ratio", pair.odds_ratio},
            {"ci", two(pair.ci)},
            {"likelihood_ratio", files::number_or_null(pair.likelihood_ratio)},
            {"df", 1},
            {"test", pair.wald ? "Wald" : "likelihood ratio"},
            {"p", files::number_or_null(pair.p)},
            {"p_holm", files::number_or_null(pair.p_holm)}};
}

}  // namespace

MixedReport mixed_report(const Observations& seen, double level) {
    MixedReport out;
    const UnnamedJudgements counts = unnamed_judgements(seen);
    out.there = counts.all > 0;
    out.status = unnamed(counts);
    if (!out.there || !out.status.empty()) return out;
    const NamedMixed named = mixed_data(seen);
    out.participants = named.data.participants;
    out.nodules = named.data.nodules;
    if (named.data.cells.size() > kMostMixedCells || 2.0 * work_of(named) > kMostMixedWork) {
        out.status =
            "is not computed for so many conditions, people and nodules: cells x (conditions + 2)^2 is above " +
            whole(static_cast<std::int64_t>(0.5 * kMostMixedWork));
        return out;
    }
    out.fit = fit_mixed_logistic(named.data);
    out.status = out.fit.status;
    if (!out.status.empty()) return out;
    compare_all(named, level, out);
    note_weaknesses(out);
    return out;
}

void add_mixed(const MixedReport& found, files::Json& report) {
    if (!found.there) return;
    files::Json& json = report["mixed_logistic"];
    json["status"] = found.status.empty() ? "computed" : found.status;
    const auto known = [](int n) { return n > 0 ? files::Json(n) : files::Json(nullptr); };
    json["participants"] = known(found.participants);
    json["nodules"] = known(found.nodules);
    json["notes"] = found.notes;
    if (!found.status.empty()) return;
    json["log_likelihood"] = found.fit.log_likelihood;
    json["spread_participants"] = found.fit.s_participants;
    json["spread_nodules"] = found.fit.s_nodules;
    json["prior_sd"] = found.fit.prior ? files::Json(kPriorSpread) : files::Json(nullptr);
    json["standard_errors"] = found.fit.covariance.empty() ? "given the spreads" : "Hessian";
    json["conditions"] = files::Json::array();
    for (const MixedCondition& one : found.conditions) json["conditions"].push_back(mixed_condition_json(one));
    if (found.df > 0) {
        json["test"] = {{"likelihood_ratio", files::number_or_null(found.likelihood_ratio)},
                        {"df", found.df},
                        {"p", files::number_or_null(found.p)}};
    }
    json["pairs"] = files::Json::array();
    for (const MixedPair& pair : found.pairs) json["pairs"].push_back(mixed_pair_json(pair));
}

std::vector<ReportTable> mixed_tables(const MixedReport& found) {
    ReportTable conditions{"mixed_conditions",
                           "Mixed logistic model: sensitivity over people and nodules of the population",
                           {"condition", "log_odds", "se", "sensitivity", "low", "high"},
                           {}};
    for (const MixedCondition& one : found.conditions) {
        std::vector<std::string> row{one.condition, fixed(one.log_odds, 4), fixed(one.se, 4),
                                     share_text(one.share.share)};
        add_interval(one.share.ci, row);
        conditions.rows.push_back(row);
    }
    ReportTable pairs{"mixed_pairs",
                      "Mixed logistic model: odds ratios of conditions, with likelihood-ratio tests",
                      {"a", "b", "odds_ratio", "low", "high", "likelihood_ratio", "df", "p", "p_holm"},
                      {}};
    for (const MixedPair& pair : found.pairs) {
        pairs.rows.push_back({pair.a, pair.b, files::short_number(pair.odds_ratio), files::short_number(pair.ci.low),
                              files::short_number(pair.ci.high), fixed(pair.likelihood_ratio, 4), "1", p_text(pair.p),
                              p_text(pair.p_holm)});
    }
    return {conditions, pairs};
}

std::string mixed_methods(const MixedReport& found) {
    if (!found.there) return "";
    if (!found.status.empty()) return "\nThe mixed logistic model " + found.status + ".\n";
    std::string out = "\nMixed logistic model: log odds of finding a nodule = condition + person + nodule, with " +
                      whole(found.participants) + " people and " + whole(found.nodules) +
                      " nodules as crossed normal effects of standard deviation " + fixed(found.fit.s_participants, 3) +
                      " and " + fixed(found.fit.s_nodules, 3) + " (Laplace's approximation, as lme4's glmer).";
    if (found.df > 0) {
        out += " All conditions alike: likelihood ratio " + fixed(found.likelihood_ratio, 3) + ", " + whole(found.df) +
               " df, p " + p_text(found.p) + ".";
    }
    out += " sensitivity = averaged over the population of people and nodules.\n";
    for (const std::string& note : found.notes) out += "\n- " + note;
    return found.notes.empty() ? out : out + "\n";
}

std::string lme4_script(const MixedReport& found) {
    if (!found.there || !found.status.empty()) return "";
    std::string out =
        "# Fits the mixed logistic model of report.md with lme4: Rscript mixed_model.R, in this folder.\n"
        "library(lme4)\n"
        "rows <- read.delim(\"nodules_long.tsv\", colClasses = \"character\", na.strings = \"n/a\", quote = \"\")\n"
        "rows$found <- as.integer(rows$found)\n"
        "rows$missed <- as.integer(rows$missed)\n"
        "rows$condition <- factor(rows$condition, levels = unique(rows$condition))\n"
        "precise <- glmerControl(optimizer = \"bobyqa\", tolPwrss = 1e-13)\n";
    if (found.fit.prior)
        out +=
            "# Separation: glmer has no prior, so its log odds of such a condition run away. Compare the others "
            "only.\n";
    out +=
        "with_conditions <- glmer(cbind(found, missed) ~ 0 + condition + (1 | participant) + (1 | nodule), rows, "
        "binomial,\n"
        "                         control = precise)\n"
        "print(summary(with_conditions))\n";
    if (found.df > 0) {
        out +=
            "one_for_all <- glmer(cbind(found, missed) ~ 1 + (1 | participant) + (1 | nodule), rows, binomial,\n"
            "                     control = precise)\n"
            "print(anova(one_for_all, with_conditions))\n";
    }
    return out;
}

}  // namespace palpa::study
