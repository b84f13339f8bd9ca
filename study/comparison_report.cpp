#include "study/comparison_report.h"

#include "study/table_text.h"

namespace palpa::study {
namespace {

using Cells = std::vector<std::string>;

const char* design_name(Design design) {
    return design == Design::within ? "within" : design == Design::between ? "between" : "against chance";
}

files::Json pair_of(const Interval& ci) { return {files::number_or_null(ci.low), files::number_or_null(ci.high)}; }

files::Json replication_json(const Replication& r) {
    return {{"delta", r.delta},
            {"combined_interval", r.combined_interval},
            {"significant", r.significant},
            {"newcombe_ci", pair_of(r.newcombe)},
            {"p", r.p},
            {"p_holm", r.p_holm}};
}

files::Json pair_json(const PairResult& pair) {
    files::Json json{{"a", pair.a},
                     {"b", pair.b},
                     {"higher", pair.higher.empty() ? files::Json(nullptr) : files::Json(pair.higher)}};
    json.update(people_test_json(pair.people));
    json["p_holm"] = files::number_or_null(pair.p_holm);
    json["p_permutation_holm"] = files::number_or_null(pair.p_permutation_holm);
    json["bootstrap_ci"] = pair.bootstrap ? pair_of(*pair.bootstrap) : files::Json(nullptr);
    json["participants_in_both"] = pair.participants_in_both;
    if (pair.replication) json["replication"] = replication_json(*pair.replication);
    if (pair.paired) {
        json["ignores_clustering"] = {{"n", pair.paired->n()},           {"both", pair.paired->both},
                                      {"only_a", pair.paired->only_a},   {"only_b", pair.paired->only_b},
                                      {"neither", pair.paired->neither}, {"newcombe_ci", pair_of(pair.newcombe_paired)},
                                      {"mcnemar_p", pair.mcnemar_p}};
    }
    return json;
}

files::Json pairs_json(const std::vector<PairResult>& pairs) {
    files::Json json = files::Json::array();
    for (const PairResult& pair : pairs) json.push_back(pair_json(pair));
    return json;
}

files::Json primary_json(const PrimaryResult& primary) {
    files::Json json{{"quantity", name_of(primary.stated.quantity)}};
    json[primary.stated.of_groups ? "groups" : "conditions"] = {primary.stated.sides[0], primary.stated.sides[1]};
    if (primary.stated.of_groups) json["condition"] = primary.stated.condition;
    json["test"] = name_of(primary.stated.test);
    const files::Json test = people_test_json(primary.people);
    for (const auto& entry : test.items()) json[entry.key() == "p" ? "p_t" : entry.key()] = entry.value();
    json["p"] = files::number_or_null(primary.p);
    return json;
}

files::Json group_json(const GroupResult& result) {
    files::Json json{{"quantity", name_of(result.quantity)}, {"condition", result.condition}};
    if (!result.condition_b.empty()) json["condition_b"] = result.condition_b;
    json["a"] = result.group_a;
    json["b"] = result.group_b;
    json.update(people_test_json(result.people));
    json["p_holm"] = files::number_or_null(result.p_holm);
    return json;
}

// The cells of a test over participants, in the order of kTestColumns.
const Cells kTestColumns{"design", "people_a", "people_b", "left_out", "difference",    "low",        "high",
                         "t",      "df",       "p",        "p_holm",   "p_permutation", "permutation"};

void add_test(const PeopleTest& test, const std::string& p_holm, Cells& row) {
    row.insert(row.end(), {design_name(test.design), whole(test.people_a), whole(test.people_b), whole(test.left_out),
                           share_text(test.difference)});
    add_interval(test.ci, row);
    row.insert(row.end(), {fixed(test.t, 3), fixed(test.df, 1), p_text(test.p), p_holm, p_text(test.p_permutation),
                           std::isnan(test.p_permutation) ? kNone
                           : test.permutation_exact       ? "exact"
                                                          : "drawn"});
}

Cells columns_of(Cells first, const Cells& last) {
    first.insert(first.end(), kTestColumns.begin(), kTestColumns.end());
    first.insert(first.end(), last.begin(), last.end());
    return first;
}

std::string status_of(const PeopleTest& test) {
    if (!test.status.empty()) return test.status;
    return test.permutation_unfit ? "computed, but for the permutation: few false (or right) marks, uneven in number"
                                  : "computed";
}

ReportTable people_table(const char* name, const char* title, const std::vector<PairResult>& pairs) {
    ReportTable table{name, title, columns_of({"a", "b", "higher"}, {"bootstrap_low", "bootstrap_high", "status"}), {}};
    for (const PairResult& pair : pairs) {
        Cells row{pair.a, pair.b, pair.higher.empty() ? kNone : pair.higher};
        add_test(pair.people, p_text(pair.p_holm), row);
        add_interval(pair.bootstrap, row);
        row.push_back(status_of(pair.people));
        table.rows.push_back(row);
    }
    return table;
}

ReportTable replication_table(const char* name, const char* title, const std::vector<PairResult>& pairs) {
    ReportTable table{
        name,
        title,
        {"a", "b", "delta", "combined_interval", "significant", "newcombe_low", "newcombe_high", "p", "p_holm"},
        {}};
    for (const PairResult& pair : pairs) {
        if (!pair.replication) continue;
        const Replication& r = *pair.replication;
        Cells row{pair.a, pair.b, share_text(r.delta), share_text(r.combined_interval), r.significant ? "yes" : "no"};
        add_interval(r.newcombe, row);
        row.push_back(p_text(r.p));
        row.push_back(p_text(r.p_holm));
        table.rows.push_back(row);
    }
    return table;
}

ReportTable mcnemar_table(const std::vector<PairResult>& pairs) {
    ReportTable table{
        "pairs_ignoring_clustering",
        "Sensitivity: pairs of nodules, ignores clustering",
        {"a", "b", "n", "both", "only_a", "only_b", "neither", "newcombe_low", "newcombe_high", "mcnemar_p"},
        {}};
    for (const PairResult& pair : pairs) {
        if (!pair.paired) continue;
        Cells row{pair.a, pair.b, whole(pair.paired->n())};
        for (const std::int64_t cell :
             {pair.paired->both, pair.paired->only_a, pair.paired->only_b, pair.paired->neither})
            row.push_back(whole(cell));
        add_interval(pair.newcombe_paired, row);
        row.push_back(p_text(pair.mcnemar_p));
        table.rows.push_back(row);
    }
    return table;
}

ReportTable primary_table(const Report& report) {
    ReportTable table{"primary",
                      "The primary comparison, as the protocol states it",
                      columns_of({"quantity", "a", "b", "condition", "test", "primary_p"}, {"status"}),
                      {}};
    if (!report.primary) return table;
    const PrimaryComparison& stated = report.primary->stated;
    Cells row{name_of(stated.quantity), stated.sides[0],
              stated.sides[1],          stated.of_groups ? stated.condition : kNone,
              name_of(stated.test),     p_text(report.primary->p)};
    add_test(report.primary->people, kNone, row);
    row.push_back(status_of(report.primary->people));
    table.rows.push_back(row);
    return table;
}

ReportTable group_table(const Report& report) {
    ReportTable table{"groups",
                      "Comparisons of groups",
                      columns_of({"quantity", "condition", "minus_condition", "a", "b"}, {"status"}),
                      {}};
    for (const GroupResult& result : report.group_comparisons) {
        Cells row{name_of(result.quantity), result.condition, result.condition_b.empty() ? kNone : result.condition_b,
                  result.group_a, result.group_b};
        add_test(result.people, p_text(result.p_holm), row);
        row.push_back(status_of(result.people));
        table.rows.push_back(row);
    }
    return table;
}

}  // namespace

files::Json people_test_json(const PeopleTest& test) {
    return {{"design", design_name(test.design)},
            {"people_a", test.people_a},
            {"people_b", test.people_b},
            {"left_out", test.left_out},
            {"difference", files::number_or_null(test.difference)},
            {"ci", pair_of(test.ci)},
            {"t", files::number_or_null(test.t)},
            {"df", files::number_or_null(test.df)},
            {"p", files::number_or_null(test.p)},
            {"p_permutation", files::number_or_null(test.p_permutation)},
            {"permutation", test.permutation_exact ? "exact" : "drawn"},
            {"status", status_of(test)}};
}

void add_comparisons(const Report& report, files::Json& json) {
    json["primary"] = report.primary ? primary_json(*report.primary) : files::Json(nullptr);
    json["pairs"] = pairs_json(report.pairs);
    json["ppv_pairs"] = pairs_json(report.ppv_pairs);
    if (!report.choice_pairs.empty()) json["choice_pairs"] = pairs_json(report.choice_pairs);
    for (const GroupResult& result : report.group_comparisons) json["group_comparisons"].push_back(group_json(result));
}

std::vector<ReportTable> comparison_tables(const Report& report) {
    return {
        primary_table(report),
        people_table("pairs", "Sensitivity: all pairs of conditions, over participants", report.pairs),
        people_table("ppv_pairs", "Positive predictive value: all pairs of conditions, over participants",
                     report.ppv_pairs),
        people_table("choice_pairs", "Forced choices: all pairs of conditions, over participants", report.choice_pairs),
        group_table(report),
        mcnemar_table(report.pairs),
        replication_table("pairs_replication", "Sensitivity: replication of the test of Li et al.", report.pairs),
        replication_table("ppv_pairs_replication", "Positive predictive value: replication of the test of Li et al.",
                          report.ppv_pairs)};
}

}  // namespace palpa::study
