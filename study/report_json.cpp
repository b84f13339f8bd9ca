#include <cmath>
#include <utility>

#include "study/comparison_report.h"
#include "study/report.h"
#include "study/staircase_report.h"

namespace palpa::study {
namespace {

files::Json interval(const Interval& ci) { return {files::number_or_null(ci.low), files::number_or_null(ci.high)}; }

void add_share(const std::string& key, const std::optional<Share>& share, files::Json& json) {
    json[key] = share ? files::Json(share->x.p()) : files::Json(nullptr);
    json[key + "_ci"] = share ? interval(share->wilson) : files::Json(nullptr);
    if (!share) return;
    json[key + "_ci_label"] = share->one_each ? "over participants" : "ignores clustering";
    json[key + "_n"] = share->x.n;
    json[key + "_bootstrap_ci"] = share->bootstrap ? interval(*share->bootstrap) : files::Json(nullptr);
}

void add_spread(const char* key, double scale, const std::optional<Spread>& spread, files::Json& json) {
    if (!spread) return;
    json[key] = {
        {"n", spread->n},
        {"mean", scale * spread->mean},
        {"sd", files::number_or_null(scale * spread->sd)},
        {"quartiles", {scale * spread->lower_quartile, scale * spread->median, scale * spread->upper_quartile}}};
}

files::Json condition_json(const ConditionResult& condition) {
    files::Json json{{"tp", condition.tp}, {"fn", condition.fn}, {"fp", condition.fp}};
    add_share("se", condition.se, json);
    add_share("ppv", condition.ppv, json);
    if (condition.participants > 0) json["participants"] = condition.participants;
    files::Json::object_t nodules;  // names are not looked up as they are added: there may be very many
    for (const NoduleResult& nodule : condition.nodules) {
        files::Json entry{{"tp", nodule.se.x.k}, {"fn", nodule.se.x.n - nodule.se.x.k}};
        add_share("se", nodule.se, entry);
        nodules.emplace_back(nodule.nodule, std::move(entry));
    }
    if (!nodules.empty()) json["nodules"] = std::move(nodules);
    add_spread("time_s", 1.0, condition.duration_s, json);
    add_spread("path_mm", 1e3, condition.path_m, json);
    add_spread("mean_force_N", 1.0, condition.mean_force_N, json);
    add_spread("max_force_N", 1.0, condition.max_force_N, json);
    return json;
}

// The paper's t test over answers.
files::Json t_json(const TTest& test) {
    return {{"label", "replication"},
            {"mean", test.mean},
            {"t", files::number_or_null(test.t)},
            {"df", test.df},
            {"p", files::number_or_null(test.p)},
            {"ci", interval(test.ci)},
            {"status",
             std::isnan(test.t) ? "cannot be computed, because all answers are the same: no variance" : "computed"}};
}

files::Json chance_json(const ChoiceResult& choice) {
    const PeopleTest& test = *choice.over_people;
    files::Json json{{"mean", files::number_or_null(0.5 + test.difference)}};
    json.update(people_test_json(test));
    json["ci"] = {files::number_or_null(0.5 + test.ci.low), files::number_or_null(0.5 + test.ci.high)};
    json["p_holm"] = files::number_or_null(choice.p_holm);
    return json;
}

files::Json choice_json(const ChoiceResult& choice) {
    files::Json json{{"condition", choice.condition},
                     {"comparison", choice.comparison.empty() ? files::Json(nullptr) : files::Json(choice.comparison)}};
    json["correct"] = choice.correct.x.k;
    json["n"] = choice.correct.x.n;
    add_share("share", choice.correct, json);
    json["chance"] = 0.5;
    json["ignores_clustering"] = {{"binomial_p", choice.binomial_p}};
    if (choice.over_people) json["t_over_participants"] = chance_json(choice);
    if (choice.over_answers) json["t_over_answers"] = t_json(*choice.over_answers);
    return json;
}

files::Json rating_json(const RatingResult& rating) {
    files::Json json{{"condition", rating.condition}, {"item", rating.item}, {"n", rating.n}};
    if (rating.spread) {
        json["mean"] = rating.spread->mean;
        json["sd"] = files::number_or_null(rating.spread->sd);
        json["median"] = rating.spread->median;
        json["quartiles"] = {rating.spread->lower_quartile, rating.spread->upper_quartile};
    } else {
        json["answer"] = rating.value;
    }
    return json;
}

}  // namespace

files::Json report_json(const Report& report) {
    files::Json json;
    json["simulated"] = report.simulated;
    json["level"] = report.options.bootstrap.level;
    json["z"] = z_of_level(report.options.bootstrap.level);
    json["methods"] = {
        {"se_ci", "Wilson score"},
        {"pairs", "paired t over participants, Welch's t between groups; permutation of signs or groups"},
        {"ppv_pairs", "as pairs, of the ratio sum k / sum n, with the jackknife's standard error"},
        {"p_holm", std::string("Holm of the tests that can be computed, ") + kHolmFamilies},
        {"replication", "Li et al.: the combined interval of the facing Wilson arms"},
        {"ignores_clustering", "Newcombe 1998 method 10 for pairs; McNemar's exact test; exact binomial"},
        {"bootstrap_ci", "bootstrap over participants: expanded percentiles, with acceleration"},
        {"bootstrap_resamples", report.options.bootstrap.resamples},
        {"bootstrap_seed", report.options.bootstrap.seed}};
    json["participants"] = report.participants;
    json["trials"] = report.trials;
    json["forced_choices"] = report.forced_choices;
    json["practice_trials"] = report.practice_trials;
    json["interrupted_trials"] = report.interrupted_trials;
    add_displays_json(report, json);
    add_plan_json(report, json);
    files::Json::object_t conditions;
    for (const ConditionResult& condition : report.conditions)
        conditions.emplace_back(condition.name, condition_json(condition));
    json["conditions"] = std::move(conditions);
    add_comparisons(report, json);
    add_free_response(report.free_response, json);
    add_mixed(report.mixed, json);
    if (!report.choices.empty()) json["choices"] = files::Json::array();
    for (const ChoiceResult& choice : report.choices) json["choices"].push_back(choice_json(choice));
    add_psychometrics(report.psychometrics, json);
    for (const StaircaseResult& result : report.staircases) json["staircases"].push_back(staircase_json(result));
    for (const RatingResult& rating : report.ratings) json["ratings"].push_back(rating_json(rating));
    for (const Report& group : report.groups) json["groups"][group.group] = report_json(group);
    json["notes"] = report.notes;
    return json;
}

}  // namespace palpa::study
