#include "study/table_dictionary.h"

#include <algorithm>
#include <array>
#include <string_view>

namespace palpa::study {
namespace {

struct ColumnText {
    std::string_view table;  // empty: of every table that has no description of its own
    std::string_view column;
    std::string_view text;
    std::string_view unit = "";
};

constexpr std::array kColumnTexts{
    // names
    ColumnText{"", "condition", "as the protocol or the table of counts names it"},
    ColumnText{"", "nodule", "as the scene or the table of counts names it"},
    ColumnText{"", "participant", "code without sub-; all or empty: all participants"},
    ColumnText{"", "group", "all: all participants; else the group whose participants the row is of"},
    ColumnText{"plan_participants", "group", "of the participant"},
    ColumnText{
        "plan_participants", "replaced_by",
        "who has the participant's place in the plan now, and plans these tests again once begun; n/a: not replaced"},
    ColumnText{"", "comparison", "stiffness that was compared with the reference; all: all of them"},
    ColumnText{"", "quantity", "what is compared: sensitivity, ppv or correct"},
    ColumnText{"trials", "quantity", "what is measured, with its unit in the name"},
    ColumnText{"", "a", "first condition of the comparison; differences are a - b, ratios a / b"},
    ColumnText{"", "b", "second condition of the comparison"},
    ColumnText{"groups", "a", "first group of the comparison; differences are a - b"},
    ColumnText{"groups", "b", "second group of the comparison"},
    ColumnText{"groups", "condition", "under which the groups are compared"},
    ColumnText{"primary", "condition", "under which two groups are compared; n/a: two conditions are compared"},
    ColumnText{"", "minus_condition",
               "the difference condition - minus_condition is compared, but not of ppv; n/a: the condition alone"},
    ColumnText{"", "higher",
               "which of a and b is higher, by the difference of people where that is known; n/a: neither"},
    // all displays
    ColumnText{"displays", "display", "modality of the condition"},
    ColumnText{"displays", "answers", "logged by the program, or typed in by the experimenter"},
    ColumnText{"displays", "participants", "how many searched under the condition"},
    ColumnText{"displays", "sensitivity", "nodules found, of all"},
    ColumnText{"displays", "sensitivity_low",
               "lower limit of the interval of sensitivity: bootstrap_low of the table sensitivity, or where that is "
               "n/a wilson_low"},
    ColumnText{"displays", "sensitivity_high", "upper limit of the same interval"},
    ColumnText{"displays", "ppv", "marks that are hits, of all (positive predictive value)"},
    ColumnText{"displays", "ppv_low",
               "lower limit of the interval of ppv: bootstrap_low of the table ppv, or where that is n/a wilson_low"},
    ColumnText{"displays", "ppv_high", "upper limit of the same interval"},
    ColumnText{"displays", "median_time_s", "median time of a trial", "s"},
    ColumnText{"displays", "correct", "right choices between two stiffnesses, of all"},
    ColumnText{
        "displays", "correct_low",
        "lower limit of the interval of correct: bootstrap_low of the table choices, or where that is n/a wilson_low"},
    ColumnText{"displays", "correct_high", "upper limit of the same interval"},
    // shares
    ColumnText{"", "k", "how many of n: nodules found, marks that are hits, or right choices"},
    ColumnText{"", "n", "how many there were"},
    ColumnText{"pairs_ignoring_clustering", "n",
               "pairs of nodules that the same participants judged under both conditions"},
    ColumnText{"", "share", "k / n; of psychometric answers stiffer / n"},
    ColumnText{"", "bootstrap_low", "lower limit of the interval from resampled participants"},
    ColumnText{"", "bootstrap_high", "upper limit of the interval from resampled participants"},
    ColumnText{"", "wilson_low", "lower limit of Wilson's score interval"},
    ColumnText{"", "wilson_high", "upper limit of Wilson's score interval"},
    ColumnText{"", "wilson_is", "over participants, or ignores clustering: participants count more than once"},
    // tests
    ColumnText{"", "design", "within: the same participants; between: different participants"},
    ColumnText{"", "people_a", "participants compared in a"},
    ColumnText{"", "people_b", "participants compared in b"},
    ColumnText{"", "left_out", "participants with one of the two only, who are not compared"},
    ColumnText{"", "difference", "a - b, mean over participants"},
    ColumnText{"ppv_pairs", "difference", "a - b of the pooled ratios sum k / sum n"},
    ColumnText{"primary", "difference",
               "a - b, mean over participants; of ppv, a - b of the pooled ratios sum k / sum n"},
    ColumnText{"groups", "difference",
               "a - b, mean over participants; of ppv, a - b of the pooled ratios sum k / sum n"},
    ColumnText{"free_response_tests", "difference", "a - b of the figure of merit"},
    ColumnText{"", "low", "lower limit of the interval at the report's level"},
    ColumnText{"", "high", "upper limit of the interval at the report's level"},
    ColumnText{"", "t", "Student's or Welch's t"},
    ColumnText{"ppv_pairs", "t", "difference over its standard error by the jackknife over participants"},
    ColumnText{"primary", "t",
               "Student's or Welch's t; of ppv, difference over its standard error by the jackknife over participants"},
    ColumnText{"groups", "t",
               "Welch's t; of ppv, difference over its standard error by the jackknife over participants"},
    ColumnText{"", "df", "degrees of freedom"},
    ColumnText{"", "p", "two-sided p of the test, not corrected"},
    ColumnText{"pairs_replication", "p", "of the test of Li et al., which ignores clustering"},
    ColumnText{"ppv_pairs_replication", "p", "of the test of Li et al., which ignores clustering"},
    ColumnText{"", "p_holm", "p corrected by Holm over all pairs of conditions; the rows of each group by themselves"},
    ColumnText{"groups", "p_holm",
               "p corrected by Holm over all comparisons of the same quantity; those with minus_condition apart"},
    ColumnText{"choices", "p_holm",
               "p corrected by Holm over all conditions, and apart from them over all single comparisons; the rows of "
               "each group by themselves"},
    ColumnText{"free_response_tests", "p_holm",
               "p corrected by Holm over all pairs of conditions of the same figure; the rows of each group by "
               "themselves"},
    ColumnText{"", "p_permutation", "p of the permutation of signs, or of groups"},
    ColumnText{"", "permutation", "exact: all permutations; drawn: 20,000 of them"},
    ColumnText{"", "status", "computed, or why it cannot be computed"},
    ColumnText{"", "test", "the test that the protocol states: t or permutation"},
    ColumnText{"", "primary_p", "p of the stated test, not corrected for other comparisons"},
    ColumnText{"", "delta", "a - b of the shares pooled over everybody, also over people who did only one of both"},
    ColumnText{"", "combined_interval", "facing arms of both Wilson intervals, squared and summed"},
    ColumnText{"", "significant", "yes: delta is larger than combined_interval"},
    ColumnText{"", "newcombe_low", "lower limit of Newcombe's interval (method 10), which ignores clustering"},
    ColumnText{"", "newcombe_high", "upper limit of Newcombe's interval (method 10), which ignores clustering"},
    ColumnText{"", "both", "pairs found under both conditions"},
    ColumnText{"", "only_a", "pairs found under a only"},
    ColumnText{"", "only_b", "pairs found under b only"},
    ColumnText{"", "neither", "pairs found under neither"},
    ColumnText{"", "mcnemar_p", "p of McNemar's exact test, which ignores clustering"},
    ColumnText{"", "ignores_clustering_binomial_p",
               "p of the exact binomial test against one half, which ignores clustering"},
    ColumnText{"", "replication_t", "Student's t over answers against one half, which ignores clustering"},
    ColumnText{"", "replication_p", "p of replication_t"},
    // spreads
    ColumnText{"", "mean", "arithmetic mean"},
    ColumnText{"free_response_conditions", "mean", "of the figure of merit over participants"},
    ColumnText{"", "sd", "standard deviation of the sample (n - 1)"},
    ColumnText{"psychometric", "sd", "standard deviation of the noise, in units of x"},
    ColumnText{"", "lower_quartile", "first quartile"},
    ColumnText{"", "median", "second quartile"},
    ColumnText{"", "upper_quartile", "third quartile"},
    // free response
    ColumnText{"", "wafroc", "probability that a lesion is rated above the highest false mark of a lesion-free case"},
    ColumnText{"", "wafroc1", "as wafroc, with the false marks of all cases"},
    ColumnText{"", "afroc", "as wafroc, with every lesion counting the same"},
    ColumnText{"", "hr_auc", "area under the ROC curve inferred from the highest rating of each case"},
    ColumnText{"", "max_llf", "share of the lesions that were marked"},
    ColumnText{"", "max_nlf", "false marks a case"},
    ColumnText{"", "llf_at_half", "share of the lesions found at 0.5 false marks a case"},
    ColumnText{"", "figure", "figure of merit: wafroc, wafroc1, afroc or hr_auc"},
    ColumnText{"", "se", "standard error"},
    ColumnText{"", "f", "F of Obuchowski and Rockette"},
    ColumnText{"", "ndf", "degrees of freedom of the numerator"},
    ColumnText{"", "ddf", "degrees of freedom of the denominator (Hillis)"},
    ColumnText{"", "rating", "marks with this rating or a higher one count at this point"},
    ColumnText{"", "nlf", "false marks a case"},
    ColumnText{"", "llf", "share of the lesions found"},
    // mixed model
    ColumnText{"", "log_odds", "of finding a nodule, for a person and a nodule in the middle"},
    ColumnText{"", "sensitivity", "averaged over the population of people and nodules"},
    ColumnText{"", "odds_ratio", "odds of a / odds of b"},
    ColumnText{"", "likelihood_ratio",
               "twice the difference of log likelihoods, with and without the difference of a and b"},
    // psychometric functions
    ColumnText{"", "axis", "what x is the logarithm of: second/first or comparison/reference"},
    ColumnText{"", "x", "natural logarithm of the ratio of stiffnesses"},
    ColumnText{"", "stiffer", "how often the second, or the comparison, was called the stiffer one"},
    ColumnText{"psychometric_answers", "n", "answers at this level"},
    ColumnText{"psychometric", "n", "answers"},
    ColumnText{"", "pse", "point of subjective equality: x at which half of the answers are stiffer"},
    ColumnText{"", "pse_low", "lower limit of pse; n/a: open"},
    ColumnText{"", "pse_high", "upper limit of pse; n/a: open"},
    ColumnText{"", "sd_low", "lower limit of sd; n/a: open"},
    ColumnText{"", "sd_high", "upper limit of sd; n/a: open"},
    ColumnText{
        "", "jnd_percent",
        "just noticeable difference: how much stiffer a comparison is of which 75 % are felt; n/a: above 10,000 %",
        "%"},
    ColumnText{"", "jnd_percent_low", "lower limit of jnd_percent; n/a: open, or above 10,000 %", "%"},
    ColumnText{"", "jnd_percent_high", "upper limit of jnd_percent; n/a: open, or above 10,000 %", "%"},
    ColumnText{"", "jnd_ratio", "just noticeable difference under a / that under b, in units of x"},
    ColumnText{"", "lapse", "probability of an answer by mistake"},
    ColumnText{"", "deviance", "twice the difference from the greatest log likelihood that any shares would have"},
    ColumnText{"", "intervals", "how the limits were found: profile likelihood, bootstrap, or combined"},
    ColumnText{"psychometric", "status", "ok, open or separated"},
    // staircases
    ColumnText{"", "method", "weighted-up-down or quest-plus"},
    ColumnText{"", "trials", "answers of the staircase"},
    ColumnText{"", "reversals", "how often a right answer followed a wrong one, or a wrong one a right one"},
    ColumnText{"", "target", "share of right answers at the level where weighted up-down settles"},
    ColumnText{"", "threshold_percent",
               "geometric mean level from the second reversal on, as difference from the reference; below 0: softer",
               "%"},
    ColumnText{"", "jnd_low", "lower limit of the 95 % credible interval", "%"},
    ColumnText{"", "jnd_high", "upper limit of the 95 % credible interval", "%"},
    ColumnText{"staircases", "status", "ok, or open: it tells too little"},
    // answers
    ColumnText{"", "item", "id of the question in the protocol"},
    ColumnText{"", "answer", "scale: numbers follow; else the text that n participants gave"},
    ColumnText{"ratings", "n", "answers"},
    // the plan
    ColumnText{"", "planned", "tests that the protocol plans"},
    ColumnText{"", "finished", "tests that are finished"},
    ColumnText{"", "interrupted", "tests that were broken off, each time counted"},
    ColumnText{"", "missing", "tests that are planned and not finished"},
    ColumnText{"", "excluded", "finished tests that the experimenter left out"},
    ColumnText{"", "trial", "number of the trial that is left out; all: all of this participant's"},
    ColumnText{"", "reason", "in words"},
};

const ColumnText* find_text(std::string_view table, std::string_view column) {
    const ColumnText* general = nullptr;
    for (const ColumnText& one : kColumnTexts) {
        if (one.column != column) continue;
        if (one.table == table) return &one;
        if (one.table.empty()) general = &one;
    }
    return general;
}

}  // namespace

files::Json dictionary_of(const ReportTable& table) {
    files::Json out = files::Json::object();
    for (const std::string& column : table.columns) {
        const ColumnText* text = find_text(table.name, column);
        out[column]["Description"] = text ? std::string(text->text) : column;
        if (text && !text->unit.empty()) out[column]["Units"] = std::string(text->unit);
    }
    return out;
}

}  // namespace palpa::study
