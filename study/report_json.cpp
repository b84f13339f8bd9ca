#include <cmath>
#include <utility>

#include "study/report.h"

namespace palpa::study {
namespace {

files::Json interval(const Interval& ci) { return {ci.low, ci.high}; }

void add_share(const std::string& key, const std::optional<Share>& share, files::Json& json) {
    json[key] = share ? files::Json(share->x.p()) : files::Json(nullptr);
    json[key + "_ci"] = share ? interval(share->wilson) : files::Json(nullptr);
    if (share) json[key + "_n"] = share->x.n;
    if (share && share->bootstrap) json[key + "_bootstrap_ci"] = interval(*share->bootstrap);
}

void add_spread(const char* key, double scale, const std::optional<Spread>& spread, files::Json& json) {
    if (!spread) return;
    json[key] = {
        {"n", spread->n},
        {"mean", scale * spread->mean},
        {"sd", scale * spread->sd},
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

files::Json pair_json(const PairResult& pair) {
    files::Json json{{"a", pair.a},
                     {"b", pair.b},
                     {"delta", pair.delta},
                     {"higher", pair.higher.empty() ? files::Json(nullptr) : files::Json(pair.higher)},
                     {"combined_interval", pair.combined_interval},
                     {"significant", pair.significant},
                     {"newcombe_ci", interval(pair.newcombe)},
                     {"p", pair.p},
                     {"p_holm", pair.p_holm}};
    if (pair.paired) {
        json["paired"] = {{"n", pair.paired->n()},           {"both", pair.paired->both},
                          {"only_a", pair.paired->only_a},   {"only_b", pair.paired->only_b},
                          {"neither", pair.paired->neither}, {"newcombe_ci", interval(pair.newcombe_paired)},
                          {"mcnemar_p", pair.mcnemar_p}};
    }
    if (pair.bootstrap) json["bootstrap_ci"] = interval(*pair.bootstrap);
    if (pair.participants_in_both > 0) json["participants_in_both"] = pair.participants_in_both;
    return json;
}

files::Json t_json(const TTest& test) {
    return {{"mean", test.mean},
            {"t", files::number_or_null(test.t)},
            {"df", test.df},
            {"p", test.p},
            {"ci", interval(test.ci)}};
}

files::Json choice_json(const ChoiceResult& choice) {
    files::Json json{{"condition", choice.condition},
                     {"comparison", choice.comparison.empty() ? files::Json(nullptr) : files::Json(choice.comparison)}};
    json["correct"] = choice.correct.x.k;
    json["n"] = choice.correct.x.n;
    add_share("share", choice.correct, json);
    json["chance"] = 0.5;
    json["binomial_p"] = choice.binomial_p;
    if (choice.over_people) json["t_over_participants"] = t_json(*choice.over_people);
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
    json["methods"] = {{"se_ci", "Wilson score"},
                       {"combined_interval", "Li et al.: square root of the sum of squared facing Wilson arms"},
                       {"p_holm", "Holm over all pairs of the list, p of the combined interval"},
                       {"paired", "Newcombe 1998 method 10 for pairs; McNemar's exact test"},
                       {"bootstrap_ci", "percentile bootstrap over participants"},
                       {"bootstrap_resamples", report.options.bootstrap.resamples},
                       {"bootstrap_seed", report.options.bootstrap.seed}};
    json["participants"] = report.participants;
    json["trials"] = report.trials;
    json["practice_trials"] = report.practice_trials;
    json["interrupted_trials"] = report.interrupted_trials;
    add_plan_json(report, json);
    files::Json::object_t conditions;
    for (const ConditionResult& condition : report.conditions)
        conditions.emplace_back(condition.name, condition_json(condition));
    json["conditions"] = std::move(conditions);
    json["pairs"] = files::Json::array();
    for (const PairResult& pair : report.pairs) json["pairs"].push_back(pair_json(pair));
    json["ppv_pairs"] = files::Json::array();
    for (const PairResult& pair : report.ppv_pairs) json["ppv_pairs"].push_back(pair_json(pair));
    if (!report.choices.empty()) json["choices"] = files::Json::array();
    for (const ChoiceResult& choice : report.choices) json["choices"].push_back(choice_json(choice));
    for (const RatingResult& rating : report.ratings) json["ratings"].push_back(rating_json(rating));
    json["notes"] = report.notes;
    return json;
}

}  // namespace palpa::study
