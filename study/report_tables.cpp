#include <algorithm>

#include "files/text.h"
#include "study/comparison_report.h"
#include "study/permutation.h"
#include "study/report.h"
#include "study/staircase_report.h"
#include "study/table_text.h"

namespace palpa::study {
namespace {

using Row = std::vector<std::string>;

void add_share(const std::optional<Share>& share, Row& row) {
    row.push_back(share ? whole(share->x.k) : kNone);
    row.push_back(share ? whole(share->x.n) : kNone);
    row.push_back(share ? share_text(share->x.p()) : kNone);
    add_interval(share ? share->bootstrap : std::nullopt, row);
    add_interval(share ? std::optional(share->wilson) : std::nullopt, row);
    row.push_back(share ? wilson_is(*share) : kNone);
}

std::vector<std::string> share_columns(Row first) {
    for (const char* column :
         {"k", "n", "share", "bootstrap_low", "bootstrap_high", "wilson_low", "wilson_high", "wilson_is"}) {
        first.emplace_back(column);
    }
    return first;
}

ReportTable sensitivity_table(const Report& report) {
    ReportTable table{"sensitivity", "Sensitivity by condition", share_columns({"condition"}), {}};
    for (const ConditionResult& condition : report.conditions) {
        Row row{condition.name};
        add_share(condition.se, row);
        table.rows.push_back(row);
    }
    return table;
}

ReportTable nodule_table(const Report& report) {
    ReportTable table{"nodules", "Sensitivity by condition and nodule", share_columns({"condition", "nodule"}), {}};
    for (const ConditionResult& condition : report.conditions) {
        for (const NoduleResult& nodule : condition.nodules) {
            Row row{condition.name, nodule.nodule};
            add_share(nodule.se, row);
            table.rows.push_back(row);
        }
    }
    return table;
}

ReportTable ppv_table(const Report& report) {
    ReportTable table{"ppv", "Positive predictive value by condition", share_columns({"condition"}), {}};
    for (const ConditionResult& condition : report.conditions) {
        Row row{condition.name};
        add_share(condition.ppv, row);
        table.rows.push_back(row);
    }
    return table;
}

ReportTable trial_table(const Report& report) {
    ReportTable table{"trials",
                      "Time, path and force per trial",
                      {"condition", "quantity", "n", "mean", "sd", "lower_quartile", "median", "upper_quartile"},
                      {}};
    const auto add = [&](const ConditionResult& condition, const char* name, double scale,
                         const std::optional<Spread>& s) {
        if (!s) return;
        table.rows.push_back({condition.name, name, whole(s->n), fixed(scale * s->mean, 3), fixed(scale * s->sd, 3),
                              fixed(scale * s->lower_quartile, 3), fixed(scale * s->median, 3),
                              fixed(scale * s->upper_quartile, 3)});
    };
    for (const ConditionResult& condition : report.conditions) {
        add(condition, "time_s", 1.0, condition.duration_s);
        add(condition, "path_mm", 1e3, condition.path_m);
        add(condition, "mean_force_N", 1.0, condition.mean_force_N);
        add(condition, "max_force_N", 1.0, condition.max_force_N);
    }
    return table;
}

ReportTable choice_table(const Report& report) {
    ReportTable table{"choices", "Forced choices against chance (0.5)", share_columns({"condition", "comparison"}), {}};
    for (const char* column : {"t", "df", "p", "p_holm", "p_permutation", "ignores_clustering_binomial_p",
                               "replication_t", "replication_p", "status"}) {
        table.columns.emplace_back(column);
    }
    for (const ChoiceResult& choice : report.choices) {
        Row row{choice.condition, choice.comparison.empty() ? "all" : choice.comparison};
        add_share(choice.correct, row);
        const auto& people = choice.over_people;
        row.push_back(people ? fixed(people->t, 3) : kNone);
        row.push_back(people ? fixed(people->df, 0) : kNone);
        row.push_back(people ? p_text(people->p) : kNone);
        row.push_back(people ? p_text(choice.p_holm) : kNone);
        row.push_back(people ? p_text(people->p_permutation) : kNone);
        row.push_back(p_text(choice.binomial_p));
        const auto& answers = choice.over_answers;
        row.push_back(answers ? fixed(answers->t, 3) : kNone);
        row.push_back(answers ? p_text(answers->p) : kNone);
        row.push_back(!people                  ? "cannot be computed, because the counts do not name their participants"
                      : people->status.empty() ? "computed"
                                               : people->status);
        table.rows.push_back(row);
    }
    return table;
}

ReportTable rating_table(const Report& report) {
    ReportTable table{"ratings",
                      "Answers of the participants",
                      {"condition", "item", "answer", "n", "mean", "sd", "lower_quartile", "median", "upper_quartile"},
                      {}};
    for (const RatingResult& r : report.ratings) {
        Row row{r.condition, r.item, r.spread ? "scale" : r.value, whole(r.n)};
        const Spread s = r.spread.value_or(Spread{});
        for (const double x : {s.mean, s.sd, s.lower_quartile, s.median, s.upper_quartile})
            row.push_back(r.spread ? fixed(x, 2) : kNone);
        table.rows.push_back(row);
    }
    return table;
}

void append_row(const Row& row, const char* before, const char* between, const char* after, std::string& out) {
    out += before;
    for (std::size_t i = 0; i < row.size(); ++i) out.append(i == 0 ? "" : between).append(row[i]);
    out += after;
}

// Adds the column `group`, and below the rows of all people those of each group.
void add_groups(const Report& report, std::vector<ReportTable>& tables) {
    for (ReportTable& table : tables) {
        table.columns.emplace_back("group");
        for (Row& row : table.rows) row.emplace_back("all");
    }
    for (const Report& group : report.groups) {
        for (ReportTable& part : report_tables(group)) {
            const auto whole_table = std::find_if(tables.begin(), tables.end(),
                                                  [&](const ReportTable& table) { return table.name == part.name; });
            if (whole_table == tables.end()) continue;
            for (Row& row : part.rows) {
                row.push_back(group.group);
                whole_table->rows.push_back(std::move(row));
            }
        }
    }
}

}  // namespace

std::vector<ReportTable> report_tables(const Report& report) {
    std::vector<ReportTable> tables{display_table(report), sensitivity_table(report), nodule_table(report),
                                    ppv_table(report)};
    for (ReportTable& table : comparison_tables(report)) tables.push_back(std::move(table));
    for (ReportTable& table : free_response_tables(report.free_response)) tables.push_back(std::move(table));
    for (ReportTable& table : mixed_tables(report.mixed)) tables.push_back(std::move(table));
    for (const auto make : {trial_table, choice_table}) tables.push_back(make(report));
    for (ReportTable& table : psychometric_tables(report.psychometrics)) tables.push_back(std::move(table));
    tables.push_back(staircase_table(report));
    tables.push_back(rating_table(report));
    std::erase_if(tables, [](const ReportTable& table) { return table.rows.empty(); });
    if (!report.groups.empty()) add_groups(report, tables);
    for (ReportTable& table : plan_tables(report)) {
        if (!table.rows.empty()) tables.push_back(std::move(table));
    }
    return tables;
}

const std::vector<std::string>& table_names() {
    static const std::vector<std::string> names{"displays",
                                                "sensitivity",
                                                "nodules",
                                                "ppv",
                                                "primary",
                                                "pairs",
                                                "ppv_pairs",
                                                "choice_pairs",
                                                "groups",
                                                "pairs_ignoring_clustering",
                                                "pairs_replication",
                                                "ppv_pairs_replication",
                                                "free_response",
                                                "free_response_conditions",
                                                "free_response_tests",
                                                "froc",
                                                "mixed_conditions",
                                                "mixed_pairs",
                                                "trials",
                                                "choices",
                                                "psychometric",
                                                "psychometric_pairs",
                                                "psychometric_answers",
                                                "staircases",
                                                "ratings",
                                                "plan",
                                                "plan_participants",
                                                "exclusions"};
    return names;
}

std::string tsv_text(const ReportTable& table) {
    std::string out;
    append_row(table.columns, "", "\t", "\n", out);
    for (const Row& row : table.rows) append_row(row, "", "\t", "\n", out);
    return out;
}

std::string report_markdown(const Report& report) {
    std::string out = report.simulated ? "# Report on SIMULATED participants\n" : "# Report\n";
    const std::string level = files::short_number(100.0 * report.options.bootstrap.level) + " %";
    if (report.simulated) out += "\nNo person took part: hands and eyes were simulated by `palpa study simulate`.\n";
    const std::int64_t tests = report.trials + report.forced_choices;
    if (tests + report.practice_trials + report.interrupted_trials > 0) {
        out += "\n" + number_of(report.participants, "participant") + ", " + number_of(tests, "finished test") +
               (report.trials > 0 && report.forced_choices > 0
                    ? " (" + whole(report.trials) + " of nodules, " + whole(report.forced_choices) + " forced choices)"
                    : "") +
               ", " + number_of(report.practice_trials, "practice trial") + " (not in the tables), " +
               number_of(report.interrupted_trials, "interrupted trial") + " (not in the tables).\n";
        if (report.people_without > 0) {
            out += "\n" + number_of(report.people_without, "more participant") +
                   (report.people_without == 1 ? " has" : " have") + " logs, but no test in the tables.\n";
        }
        if (report.people_without_trial > 0)
            out += "\n" + number_of(report.people_without_trial, "more participant") +
                   (report.people_without_trial == 1 ? " has" : " have") + " no trial.\n";
    }
    out += plan_summary(report);
    out +=
        "\nTests are over participants: design within = Student's t of each person's difference a - b, design "
        "between = Welch's t of two groups; of positive predictive value it is the difference of the pooled ratios sum "
        "k / "
        "sum n, with the standard error of the jackknife over participants in these t tests; p_permutation = exact "
        "permutation of signs, or of groups (drawn above " +
        whole(kMostExactPeople) + " people who differ, or of both groups). p_holm = corrected by Holm " +
        kHolmFamilies + ". " + (report.groups.empty() ? "" : "Interactions of PPV are not tested. ") +
        (report.primary ? "The primary comparison is not corrected. " : "No protocol states a primary comparison. ") +
        "Intervals at " + level +
        " (the staircases' table has its own): low, high = of the difference, by t; bootstrap = from " +
        whole(report.options.bootstrap.resamples) + " resamples of participants (seed " +
        std::to_string(report.options.bootstrap.seed) +
        "); wilson = Wilson's score interval, which ignores clustering where people count more than once. Two kinds "
        "of tables take the nodules of one person as independent and reject too often: *replication* is the test of "
        "Li et al. (significant = the difference is larger than the combined interval, each pair alone), *ignores "
        "clustering* is McNemar's exact test with Newcombe's interval (1998, method 10).\n";
    out += free_response_methods(report.free_response);
    out += mixed_methods(report.mixed);
    for (const Report& group : report.groups) {
        if (!group.mixed.status.empty())
            out += "\nThe mixed logistic model of group " + group.group + " " + group.mixed.status + ".\n";
    }
    out += psychometric_methods(report.psychometrics);
    for (const std::string& note : report.notes) out += "\n- " + note;
    if (!report.notes.empty()) out += "\n";
    for (const ReportTable& table : report_tables(report)) {
        out += "\n## " + table.title + "\n\n";
        append_row(table.columns, "| ", " | ", " |\n", out);
        append_row(Row(table.columns.size(), "---"), "| ", " | ", " |\n", out);
        for (Row row : table.rows) {
            for (std::string& cell : row) cell = markdown_cell(cell);
            append_row(row, "| ", " | ", " |\n", out);
        }
    }
    return out;
}

}  // namespace palpa::study
