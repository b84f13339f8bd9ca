#include <cmath>
#include <cstdio>

#include "files/text.h"
#include "study/report.h"

namespace palpa::study {
namespace {

using Row = std::vector<std::string>;

const std::string kNone = "n/a";

std::string fixed(double value, int digits) {
    if (!std::isfinite(value)) return kNone;
    char text[64];
    std::snprintf(text, sizeof text, "%.*f", digits, value);
    return text;
}

std::string share_text(double value) { return fixed(value, 4); }
std::string p_text(double p) { return p < 1e-4 ? "<0.0001" : fixed(p, 4); }
std::string whole(std::int64_t value) { return std::to_string(value); }

void add_interval(const std::optional<Interval>& ci, Row& row) {
    row.push_back(ci ? share_text(ci->low) : kNone);
    row.push_back(ci ? share_text(ci->high) : kNone);
}

void add_share(const std::optional<Share>& share, Row& row) {
    row.push_back(share ? whole(share->x.k) : kNone);
    row.push_back(share ? whole(share->x.n) : kNone);
    row.push_back(share ? share_text(share->x.p()) : kNone);
    add_interval(share ? std::optional(share->wilson) : std::nullopt, row);
    add_interval(share ? share->bootstrap : std::nullopt, row);
}

std::vector<std::string> share_columns(Row first) {
    for (const char* column : {"k", "n", "share", "wilson_low", "wilson_high", "bootstrap_low", "bootstrap_high"}) {
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

ReportTable pair_table(const char* name, const char* title, const std::vector<PairResult>& pairs) {
    ReportTable table{
        name,
        title,
        {"a", "b", "higher", "delta", "combined_interval", "significant", "newcombe_low", "newcombe_high", "p",
         "p_holm", "pairs", "paired_low", "paired_high", "mcnemar_p", "bootstrap_low", "bootstrap_high"},
        {}};
    for (const PairResult& pair : pairs) {
        Row row{pair.a,
                pair.b,
                pair.higher.empty() ? kNone : pair.higher,
                share_text(pair.delta),
                share_text(pair.combined_interval),
                pair.significant ? "yes" : "no"};
        add_interval(pair.newcombe, row);
        row.push_back(p_text(pair.p));
        row.push_back(p_text(pair.p_holm));
        row.push_back(pair.paired ? whole(pair.paired->n()) : kNone);
        add_interval(pair.paired ? std::optional(pair.newcombe_paired) : std::nullopt, row);
        row.push_back(pair.paired ? p_text(pair.mcnemar_p) : kNone);
        add_interval(pair.bootstrap, row);
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
    for (const char* column : {"binomial_p", "t_participants", "df", "p_participants", "t_answers", "p_answers"}) {
        table.columns.emplace_back(column);
    }
    for (const ChoiceResult& choice : report.choices) {
        Row row{choice.condition, choice.comparison.empty() ? "all" : choice.comparison};
        add_share(choice.correct, row);
        row.push_back(p_text(choice.binomial_p));
        const auto& people = choice.over_people;
        row.push_back(people ? fixed(people->t, 3) : kNone);
        row.push_back(people ? fixed(people->df, 0) : kNone);
        row.push_back(people ? p_text(people->p) : kNone);
        const auto& answers = choice.over_answers;
        row.push_back(answers ? fixed(answers->t, 3) : kNone);
        row.push_back(answers ? p_text(answers->p) : kNone);
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

std::string escaped(std::string text) {
    for (std::size_t i = 0; (i = text.find('|', i)) != std::string::npos; i += 2) text.replace(i, 1, "\\|");
    return text;
}

}  // namespace

std::vector<ReportTable> report_tables(const Report& report) {
    std::vector<ReportTable> tables;
    const auto add = [&](ReportTable table) {
        if (!table.rows.empty()) tables.push_back(std::move(table));
    };
    add(sensitivity_table(report));
    add(nodule_table(report));
    add(ppv_table(report));
    add(pair_table("pairs", "Sensitivity: all pairs of conditions", report.pairs));
    add(pair_table("ppv_pairs", "Positive predictive value: all pairs of conditions", report.ppv_pairs));
    add(trial_table(report));
    add(choice_table(report));
    add(rating_table(report));
    for (ReportTable& table : plan_tables(report)) add(std::move(table));
    return tables;
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
    if (report.trials > 0) {
        out += "\n" + whole(report.participants) + " participants, " + whole(report.trials) + " finished tests, " +
               whole(report.practice_trials) + " practice trials (not in the tables), " +
               whole(report.interrupted_trials) + " interrupted trials (not in the tables).\n";
    }
    out += plan_summary(report);
    out += "\nIntervals at " + level + ": wilson = Wilson's score interval; bootstrap = percentiles of " +
           whole(report.options.bootstrap.resamples) + " resamples of participants (seed " +
           std::to_string(report.options.bootstrap.seed) +
           "). significant = the difference is larger than the combined interval of Li et al., each pair alone; p = of "
           "that test, p_holm = corrected for all pairs of the table. These treat all nodules and conditions as "
           "independent. paired = Newcombe's interval (1998, method 10) and McNemar's exact test over nodules that the "
           "same people judged under both conditions; bootstrap of a pair resamples people within the design. Paired "
           "and bootstrap columns are of a - b.\n";
    for (const std::string& note : report.notes) out += "\n- " + note;
    if (!report.notes.empty()) out += "\n";
    for (const ReportTable& table : report_tables(report)) {
        out += "\n## " + table.title + "\n\n";
        append_row(table.columns, "| ", " | ", " |\n", out);
        append_row(Row(table.columns.size(), "---"), "| ", " | ", " |\n", out);
        for (Row row : table.rows) {
            for (std::string& cell : row) cell = escaped(cell);
            append_row(row, "| ", " | ", " |\n", out);
        }
    }
    return out;
}

}  // namespace palpa::study
