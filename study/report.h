#pragma once
// The analysis of a study: the tests of Li et al., and beside them tests that take account of participants who took
// part in several conditions, of the clustering of nodules in participants, and of multiple comparisons.

#include <optional>
#include <string>
#include <vector>

#include "files/json.h"
#include "study/bootstrap.h"
#include "study/observations.h"
#include "study/statistics.h"

namespace palpa::study {

// A proportion with its intervals.
struct Share {
    Proportion x;
    Interval wilson;
    std::optional<Interval> bootstrap;  // over participants; absent if fewer than two are named
};

struct NoduleResult {
    std::string nodule;
    Share se;
};

// The distribution of one quantity over trials or answers, in the quantity's unit.
struct Spread {
    int n = 0;
    double mean = 0.0;
    double sd = 0.0;  // of the sample (n - 1); 0 for a single value
    double lower_quartile = 0.0;
    double median = 0.0;
    double upper_quartile = 0.0;
};

struct ConditionResult {
    std::string name;
    std::int64_t tp = 0;
    std::int64_t fn = 0;
    std::int64_t fp = 0;
    std::optional<Share> se;   // absent: there was nothing to find
    std::optional<Share> ppv;  // absent: nobody marked anything
    std::vector<NoduleResult> nodules;
    int participants = 0;  // 0: not given
    std::optional<Spread> duration_s, path_m, mean_force_N, max_force_N;
};

struct PairResult {
    std::string a;
    std::string b;
    std::string higher;  // a, b or "" if equal
    double delta = 0.0;  // |p_a - p_b|
    double combined_interval = 0.0;
    bool significant = false;            // delta > combined_interval: the paper's test, uncorrected
    Interval newcombe;                   // of p_a - p_b, both taken as independent
    double p = 1.0;                      // of the paper's test
    double p_holm = 1.0;                 // corrected for all pairs of the table
    std::optional<PairedCounts> paired;  // nodules that the same participants judged under both conditions
    Interval newcombe_paired;            // of p_a - p_b; only with `paired`
    double mcnemar_p = 1.0;              // only with `paired`
    std::optional<Interval> bootstrap;   // of p_a - p_b, over participants
    int participants_in_both = 0;
};

struct ChoiceResult {
    std::string condition;
    std::string comparison;  // empty: all comparisons
    Share correct;
    double binomial_p = 1.0;
    std::optional<TTest> over_people;   // the participants' shares against one half
    std::optional<TTest> over_answers;  // answers (0 or 1) against one half, as the paper's t(239); not independent
};

// Answers to one question about one condition.
struct RatingResult {
    std::string condition;
    std::string item;
    std::optional<Spread> spread;  // of answers on a scale; absent for texts
    std::string value;             // the text that was chosen; empty for a scale
    int n = 0;                     // how many chose this text, or answered on the scale
};

struct ReportOptions {
    BootstrapOptions bootstrap;  // its level is that of every interval
};

struct Report {
    ReportOptions options;
    std::vector<ConditionResult> conditions;
    std::vector<PairResult> pairs;  // sensitivity
    std::vector<PairResult> ppv_pairs;
    std::vector<ChoiceResult> choices;
    std::vector<RatingResult> ratings;
    std::vector<std::string> notes;
    int participants = 0;
    std::int64_t trials = 0;  // finished tests; 0 for a table of counts
    std::int64_t practice_trials = 0;
    std::int64_t interrupted_trials = 0;
    std::int64_t excluded_trials = 0;
    std::vector<Progress> progress;  // logs against the plan; empty if the plan is not known
    std::vector<Exclusion> exclusions;
    std::vector<Replacement> replacements;
    bool simulated = false;
};

Report make_report(const Observations& seen, const ReportOptions& options);

Spread spread_of(std::vector<double> values);

files::Json report_json(const Report& report);

// One table of the report, for a .tsv and for Markdown.
struct ReportTable {
    std::string name;  // of the file
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};
std::vector<ReportTable> report_tables(const Report& report);
std::string tsv_text(const ReportTable& table);
std::string report_markdown(const Report& report);  // all tables, with methods and notes

// report_plan.cpp: logs against the plan, exclusions and dropouts.
void add_plan_json(const Report& report, files::Json& json);
std::vector<ReportTable> plan_tables(const Report& report);
std::string plan_summary(const Report& report);  // one paragraph; empty if there is nothing to say

}  // namespace palpa::study
