#include "study/psychometric_report.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <map>
#include <utility>

#include "files/input_error.h"
#include "files/text.h"
#include "study/report.h"

namespace palpa::study {
namespace {

constexpr int kFewPeople = 10;

// The answers under one condition, by person; those of nobody in particular are apart.
struct ConditionAnswers {
    std::vector<PersonAnswers> people;  // as many as the study has
    PersonAnswers unnamed;
    ResampledCurves resamples;  // with IntervalMethod::bootstrap
};
using Key = std::pair<StiffnessAxis, int>;  // axis, condition

std::map<Key, ConditionAnswers> answers_by_condition(const Observations& seen) {
    std::map<Key, ConditionAnswers> out;
    for (const StifferAnswers& row : seen.stiffer) {
        ConditionAnswers& answers = out[{row.axis, row.condition}];
        answers.people.resize(seen.participants.size());
        PersonAnswers& whose =
            row.participant < 0 ? answers.unnamed : answers.people[static_cast<std::size_t>(row.participant)];
        whose.push_back({row.x, row.stiffer, row.n});
    }
    for (auto& [key, answers] : out) {
        for (PersonAnswers& person : answers.people) person = merged_levels(std::move(person));
        answers.unnamed = merged_levels(std::move(answers.unnamed));
    }
    return out;
}

int people_in(const ConditionAnswers& answers) {
    return static_cast<int>(
        std::count_if(answers.people.begin(), answers.people.end(), [](const PersonAnswers& p) { return !p.empty(); }));
}

// With answers of two people or more, and none of nobody in particular, people are resampled.
IntervalMethod method_for(const ConditionAnswers& answers) {
    return answers.unnamed.empty() && people_in(answers) >= 2 ? IntervalMethod::bootstrap : IntervalMethod::profile;
}

PsychometricResult fitted_result(PersonAnswers levels, const Psychometrics& found, double level) {
    PsychometricResult out;
    out.levels = std::move(levels);
    for (const LevelAnswers& one : out.levels) out.n += one.n;
    out.fitted = out.levels.size() >= 2;
    if (out.fitted) out.fit = fit_psychometric(out.levels, {level, found.greatest_lapse});
    return out;
}

PsychometricResult result_of_all(ConditionAnswers& answers, const Psychometrics& found,
                                 const BootstrapOptions& options) {
    PersonAnswers all = pooled_answers(answers.people);
    all.insert(all.end(), answers.unnamed.begin(), answers.unnamed.end());
    PsychometricResult out = fitted_result(merged_levels(std::move(all)), found, options.level);
    out.participants = people_in(answers);
    out.method = method_for(answers);
    if (!out.fitted || out.method == IntervalMethod::profile) return out;
    answers.resamples = resampled_curves(answers.people, found.greatest_lapse, options);
    const CurveIntervals ci = intervals_of(answers.resamples, options.level);
    out.fit.pse_ci = out.fit.pse ? ci.pse : OpenInterval{};
    out.fit.sd_ci = out.fit.sd ? ci.sd : OpenInterval{};
    if (out.fit.status != FitStatus::separated)
        out.fit.status = out.fit.pse_ci.closed() && out.fit.sd_ci.closed() ? FitStatus::ok : FitStatus::open;
    return out;
}

void note(const PsychometricResult& curve, Psychometrics& found) {
    const std::string whose = "condition " + files::shown(curve.condition) +
                              (curve.participant.empty() ? "" : ", participant " + files::shown(curve.participant));
    if (!curve.fitted) {
        found.notes.push_back(whose + ": all answers are at one level, ln(" + name_of(curve.axis) + ") = " +
                              files::short_number(curve.levels.front().x) + ": no curve goes through one level");
    }
    if (curve.method == IntervalMethod::bootstrap && curve.participants < kFewPeople) {
        found.notes.push_back(whose + ": the psychometric function's bootstrap draws from " +
                              std::to_string(curve.participants) + " people; with fewer than " +
                              std::to_string(kFewPeople) + " its intervals hold the truth less often than they say");
    }
}

PsychometricPair pair_of(const PsychometricResult& a, const PsychometricResult& b, const ConditionAnswers& of_a,
                         const ConditionAnswers& of_b, double greatest_lapse, const BootstrapOptions& options) {
    PsychometricPair out;
    out.a = a.condition;
    out.b = b.condition;
    const bool by_people = a.method == IntervalMethod::bootstrap && b.method == IntervalMethod::bootstrap;
    out.method = by_people ? IntervalMethod::bootstrap : IntervalMethod::profile;
    const bool both = a.fit.sd && b.fit.sd;
    if (both) out.jnd_ratio = *a.fit.sd / *b.fit.sd;
    if (!both && !by_people) return out;  // resamples have limits also where a curve is flat or a step
    out.ci = by_people ? bootstrap_jnd_ratio({of_a.people, of_a.resamples}, {of_b.people, of_b.resamples},
                                             greatest_lapse, options)
                       : independent_jnd_ratio(a.fit, b.fit);
    return out;
}

// The people who answered under the other condition too.
ConditionAnswers of_both(const ConditionAnswers& answers, const ConditionAnswers& other) {
    ConditionAnswers out{answers.people, {}, {}};
    for (std::size_t i = 0; i < out.people.size(); ++i) {
        if (other.people[i].empty()) out.people[i].clear();
    }
    return out;
}

// As in the other tables of pairs: if anybody answered under both conditions, such people alone are compared.
PsychometricPair compared(const PsychometricResult& a, const PsychometricResult& b, const ConditionAnswers& of_a,
                          const ConditionAnswers& of_b, const Psychometrics& found, const BootstrapOptions& options) {
    ConditionAnswers both_a = of_both(of_a, of_b), both_b = of_both(of_b, of_a);
    const int both = people_in(both_a);
    const int left_out = people_in(of_a) + people_in(of_b) - 2 * both;
    const bool named = of_a.unnamed.empty() && of_b.unnamed.empty();
    if (both == 0 || left_out == 0 || !named) return pair_of(a, b, of_a, of_b, found.greatest_lapse, options);
    PsychometricResult from_a = result_of_all(both_a, found, options), from_b = result_of_all(both_b, found, options);
    from_a.condition = a.condition;
    from_b.condition = b.condition;
    PsychometricPair out = pair_of(from_a, from_b, both_a, both_b, found.greatest_lapse, options);
    out.left_out = left_out;
    return out;
}

files::Json number(std::optional<double> value) { return value ? files::number_or_null(*value) : nullptr; }
files::Json limits(const OpenInterval& ci) { return {number(ci.low), number(ci.high)}; }

std::optional<double> percent(std::optional<double> sd) {
    constexpr double kMost_percent = 1e4;  // a hundred times as stiff: answers say nothing of it
    if (!sd || !(jnd_percent_of_sd(*sd) <= kMost_percent)) return std::nullopt;
    return jnd_percent_of_sd(*sd);
}
OpenInterval percent(const OpenInterval& sd) { return {percent(sd.low), percent(sd.high)}; }

files::Json curve_json(const PsychometricResult& curve) {
    const PsychometricFit& fit = curve.fit;
    files::Json json{{"condition", curve.condition}};
    json["participant"] = curve.participant.empty() ? files::Json(nullptr) : files::Json(curve.participant);
    if (curve.participants > 0) json["participants"] = curve.participants;
    json["n"] = curve.n;
    json["levels"] = curve.levels.size();
    json["axis"] = name_of(curve.axis);
    json["pse"] = number(fit.pse);
    json["pse_ci"] = limits(fit.pse_ci);
    json["sd"] = number(fit.sd);
    json["sd_ci"] = limits(fit.sd_ci);
    json["jnd_percent"] = number(percent(fit.sd));
    json["jnd_percent_ci"] = limits(percent(fit.sd_ci));
    json["lapse"] = curve.fitted ? files::Json(fit.lapse) : files::Json(nullptr);
    json["deviance"] = curve.fitted ? files::Json(fit.deviance) : files::Json(nullptr);
    json["status"] = name_of(fit.status);
    json["intervals"] = name_of(curve.method);
    return json;
}

std::string cell(std::optional<double> value, int digits) {
    if (!value || !std::isfinite(*value)) return "n/a";
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, *value);
    return text;
}

ReportTable curve_table(const Psychometrics& found) {
    ReportTable table{
        "psychometric",
        "Psychometric functions",
        {"condition", "participant", "n", "axis", "pse", "pse_low", "pse_high", "sd", "sd_low", "sd_high",
         "jnd_percent", "jnd_percent_low", "jnd_percent_high", "lapse", "deviance", "status", "intervals"},
        {}};
    for (const PsychometricResult& curve : found.curves) {
        const PsychometricFit& fit = curve.fit;
        const OpenInterval jnd = percent(fit.sd_ci);
        table.rows.push_back({curve.condition, curve.participant.empty() ? "all" : curve.participant,
                              std::to_string(curve.n), name_of(curve.axis), cell(fit.pse, 4), cell(fit.pse_ci.low, 4),
                              cell(fit.pse_ci.high, 4), cell(fit.sd, 4), cell(fit.sd_ci.low, 4),
                              cell(fit.sd_ci.high, 4), cell(percent(fit.sd), 1), cell(jnd.low, 1), cell(jnd.high, 1),
                              curve.fitted ? cell(fit.lapse, 4) : "n/a", curve.fitted ? cell(fit.deviance, 3) : "n/a",
                              name_of(fit.status), name_of(curve.method)});
    }
    return table;
}

ReportTable answer_table(const Psychometrics& found) {
    ReportTable table{"psychometric_answers",
                      "How often the stiffer one was called so, by level",
                      {"condition", "axis", "x", "stiffer", "n", "share"},
                      {}};
    for (const PsychometricResult& curve : found.curves) {
        if (!curve.participant.empty()) continue;
        for (const LevelAnswers& level : curve.levels) {
            table.rows.push_back({curve.condition, name_of(curve.axis), cell(level.x, 4), std::to_string(level.stiffer),
                                  std::to_string(level.n),
                                  cell(static_cast<double>(level.stiffer) / static_cast<double>(level.n), 4)});
        }
    }
    return table;
}

ReportTable jnd_pair_table(const Psychometrics& found) {
    ReportTable table{"psychometric_pairs",
                      "Just noticeable differences: ratios of all pairs of conditions",
                      {"a", "b", "left_out", "jnd_ratio", "low", "high", "intervals"},
                      {}};
    for (const PsychometricPair& pair : found.pairs) {
        table.rows.push_back({pair.a, pair.b, std::to_string(pair.left_out), cell(pair.jnd_ratio, 4),
                              cell(pair.ci.low, 4), cell(pair.ci.high, 4), name_of(pair.method)});
    }
    return table;
}

}  // namespace

const char* name_of(StiffnessAxis axis) {
    return axis == StiffnessAxis::second_first ? "second/first" : "comparison/reference";
}
const char* name_of(IntervalMethod method) {
    return method == IntervalMethod::profile ? "profile likelihood" : "bootstrap over people";
}

Psychometrics psychometrics_of(const Observations& seen, double greatest_lapse, const BootstrapOptions& options) {
    Psychometrics found;
    found.greatest_lapse = greatest_lapse;
    std::vector<std::pair<std::size_t, const ConditionAnswers*>> of_all;  // index in curves
    std::vector<StiffnessAxis> axes;
    std::map<Key, ConditionAnswers> answers = answers_by_condition(seen);
    for (auto& [key, here] : answers) {
        const auto& [axis, condition] = key;
        const auto add = [&, axis = axis, condition = condition](PsychometricResult curve) {
            curve.condition = seen.conditions[static_cast<std::size_t>(condition)];
            curve.axis = axis;
            note(curve, found);
            found.curves.push_back(std::move(curve));
        };
        of_all.emplace_back(found.curves.size(), &here);
        axes.push_back(axis);
        add(result_of_all(here, found, options));
        for (std::size_t person = 0; person < here.people.size(); ++person) {
            if (here.people[person].empty()) continue;
            PsychometricResult curve = fitted_result(here.people[person], found, options.level);
            curve.participant = seen.participants[person];
            curve.participants = 1;
            add(std::move(curve));
        }
    }
    if (of_all.size() > kMostCompared) {
        found.notes.push_back("JNDs of " + std::to_string(of_all.size()) +
                              " conditions are not compared in pairs: that is done for up to " +
                              std::to_string(kMostCompared));
        return found;
    }
    for (std::size_t i = 0; i < of_all.size(); ++i) {
        for (std::size_t j = i + 1; j < of_all.size(); ++j) {
            if (axes[i] != axes[j]) continue;
            found.pairs.push_back(compared(found.curves[of_all[i].first], found.curves[of_all[j].first],
                                           *of_all[i].second, *of_all[j].second, found, options));
        }
    }
    return found;
}

void add_psychometrics(const Psychometrics& found, files::Json& report) {
    if (found.curves.empty()) return;
    report["methods"]["psychometric"] = "maximum likelihood of l + (1 - 2 l) Phi((x - PSE)/sd), l from 0 to " +
                                        files::short_number(found.greatest_lapse) +
                                        "; JND = 0.6745 sd, in per cent 100 (exp(JND) - 1)";
    report["psychometric"] = files::Json::array();
    for (const PsychometricResult& curve : found.curves) report["psychometric"].push_back(curve_json(curve));
    report["psychometric_pairs"] = files::Json::array();
    for (const PsychometricPair& pair : found.pairs) {
        report["psychometric_pairs"].push_back({{"a", pair.a},
                                                {"b", pair.b},
                                                {"left_out", pair.left_out},
                                                {"jnd_ratio", number(pair.jnd_ratio)},
                                                {"ci", limits(pair.ci)},
                                                {"intervals", name_of(pair.method)}});
    }
}

std::vector<ReportTable> psychometric_tables(const Psychometrics& found) {
    if (found.curves.empty()) return {};
    return {curve_table(found), jnd_pair_table(found), answer_table(found)};
}

std::string psychometric_methods(const Psychometrics& found) {
    if (found.curves.empty()) return "";
    return "\nPsychometric functions: the likeliest l + (1 - 2 l) Phi((x - PSE)/sd) with a lapse l from 0 to " +
           files::short_number(found.greatest_lapse) +
           ". x is ln(second/first), the answer that the second was stiffer, or ln(comparison/reference), the answer "
           "that the comparison was. JND = 0.6745 sd, in per cent e^JND - 1. Intervals of one person, or where people "
           "are not named, are by the profile likelihood, of all people by bootstrap over them. open = a limit does "
           "not exist, since the answers do not exclude chance or a step; separated = a step explains the answers "
           "best, so there is no estimate.\n";
}

}  // namespace palpa::study
