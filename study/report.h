#pragma once
// The analysis of a study: the tests of Li et al., and beside them tests that take account of participants who took
// part in several conditions, of the clustering of nodules in participants, and of multiple comparisons.

#include <optional>
#include <string>
#include <vector>

#include "files/json.h"
#include "study/bootstrap.h"
#include "study/comparisons.h"
#include "study/free_response_report.h"
#include "study/mixed_report.h"
#include "study/observations.h"
#include "study/psychometric_report.h"
#include "study/statistics.h"

namespace palpa::study {

// A proportion with its intervals.
struct Share {
    Proportion x;
    Interval wilson;                    // ignores clustering, unless `one_each`
    std::optional<Interval> bootstrap;  // over participants; absent if it cannot be computed, and with `one_each`
    bool one_each = false;              // nobody counts more than once, so Wilson's interval is over participants
};

struct NoduleResult {
    std::string nodule;
    Share se;
};

// The distribution of one quantity over trials or answers, in the quantity's unit.
struct Spread {
    int n = 0;
    double mean = 0.0;
    double sd = 0.0;  // of the sample (n - 1); NaN for a single value
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

struct ChoiceResult {
    std::string condition;
    std::string comparison;  // empty: all comparisons
    Share correct;
    double binomial_p = 1.0;
    std::optional<PeopleTest> over_people;  // against one half; absent if some answers name no participant
    double p_holm = 1.0;                    // of over_people->p: over the conditions, or over all their comparisons
    std::optional<TTest> over_answers;      // answers (0 or 1) against one half, as the paper's t(239): a replication
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
    BootstrapOptions bootstrap;    // its level is that of every interval
    double greatest_lapse = 0.05;  // of psychometric functions
};

struct Report {
    ReportOptions options;
    std::vector<ConditionResult> conditions;
    std::optional<PrimaryResult> primary;  // absent: the protocol states none
    std::vector<PairResult> pairs;         // sensitivity
    std::vector<PairResult> ppv_pairs;
    std::vector<PairResult> choice_pairs;
    std::vector<GroupResult> group_comparisons;
    std::vector<ChoiceResult> choices;
    FreeResponseReport free_response;
    MixedReport mixed;
    Psychometrics psychometrics;
    std::vector<RatingResult> ratings;
    std::vector<StaircaseResult> staircases;
    std::vector<std::string> notes;
    int participants = 0;             // with a test in the tables
    int people_without = 0;           // with logs but no test in the tables: those below, or broken off before
    int people_without_trial = 0;     // besides: in the study's list, but no trial of theirs began
    int withdrawn_people = 0;         // who withdrew their data
    int excluded_people = 0;          // whom the experimenter left out
    int replaced_people = 0;          // and who are not left out already
    std::int64_t trials = 0;          // finished tests in which nodules were to be found; 0 for a table of counts
    std::int64_t forced_choices = 0;  // finished tests in which two surfaces were compared; 0 for a table of counts
    std::int64_t practice_trials = 0;
    std::int64_t interrupted_trials = 0;
    std::int64_t excluded_trials = 0;  // those of participants who withdrew their data among them
    std::int64_t withdrawn_trials = 0;
    std::vector<ConditionDisplay> displays;  // empty unless the conditions are on different displays
    std::vector<Progress> progress;          // logs against the plan; empty if the plan is not known
    std::vector<Exclusion> exclusions;
    std::vector<Replacement> replacements;
    bool simulated = false;
    std::string group;           // empty: everybody
    std::vector<Report> groups;  // of two groups and more: the same of each, without comparisons of groups
};

// What Wilson's interval of a share is over.
inline const char* wilson_is(const Share& share) { return share.one_each ? "over participants" : "ignores clustering"; }

Report make_report(const Observations& seen, const ReportOptions& options);

Spread spread_of(std::vector<double> values);

files::Json report_json(const Report& report);

// One table of the report, for a .tsv and for Markdown. With groups the last column is `group`: first come the rows of
// all people, then those of each group.
struct ReportTable {
    std::string name;  // of the file
    std::string title;
    std::vector<std::string> columns;
    std::vector<std::vector<std::string>> rows;
};
std::vector<ReportTable> report_tables(const Report& report);
const std::vector<std::string>& table_names();  // of all tables that a report may have
std::string tsv_text(const ReportTable& table);
std::string report_markdown(const Report& report);  // all tables, with methods and notes

// report_displays.cpp: one line for each condition, where they are on different displays.
void add_displays_json(const Report& report, files::Json& json);
ReportTable display_table(const Report& report);

// report_plan.cpp: logs against the plan, exclusions and dropouts.
void add_plan_json(const Report& report, files::Json& json);
std::vector<ReportTable> plan_tables(const Report& report);
std::string plan_summary(const Report& report);  // one paragraph; empty if there is nothing to say

}  // namespace palpa::study
