#pragma once
// The results of a study, in one form for tables of counts and for logs. Names are kept once; rows hold their indices.

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "study/exclusions.h"
#include "study/judged_cases.h"
#include "study/planned.h"
#include "study/primary.h"
#include "study/staircase_history.h"

namespace palpa::study {

// Hits and misses of one nodule in one trial, or their sums over many trials. False marks belong to no nodule.
struct Observation {
    int condition = 0;
    int participant = -1;  // -1: not given
    int nodule = -1;       // -1: not given, or all nodules
    int repeat = 0;        // index of this participant's trial under this condition, to match pairs
    std::int64_t tp = 0;
    std::int64_t fn = 0;
    std::int64_t fp = 0;
};

// One finished trial, as its log gives it. NaN: the log does not hold this value.
struct TrialFigures {
    int condition = 0;
    int participant = 0;
    double duration_s = 0.0;
    double path_m = 0.0;        // while pressing
    double mean_force_N = 0.0;  // while pressing
    double max_force_N = 0.0;
};

// Forced choices: `correct` of `n` answers were right.
struct Choices {
    int condition = 0;
    int participant = -1;
    int comparison = -1;  // which stimulus was compared with the reference; -1: not given, or all
    std::int64_t correct = 0;
    std::int64_t n = 0;
};

// What the stiffness of forced choices is compared with: x = ln(second / first), or ln(comparison / reference) where the
// reference stays under one condition and in tables of counts.
enum class StiffnessAxis { second_first, comparison_reference };

// Forced choices at one level: how often the second surface, or the comparison, was called the stiffer one.
struct StifferAnswers {
    int condition = 0;
    int participant = -1;  // -1: not given
    StiffnessAxis axis = StiffnessAxis::second_first;
    double x = 0.0;
    std::int64_t stiffer = 0;
    std::int64_t n = 0;
};

// An answer to one of the protocol's questions: a number, or the text that was chosen or typed.
struct Answer {
    std::string condition;  // n/a: asked before the trials
    std::string item;
    std::string value;
    int participant = -1;  // -1: not given
    bool chosen = false;   // one of the question's texts, which may look like numbers
};

// How a condition of the protocol presents its tissue.
struct ConditionDisplay {
    std::string condition;
    std::string display;    // modality, as the protocol names it
    bool typed_in = false;  // the program does not see the answers: the experimenter types them in
};

struct Observations {
    std::vector<std::string> conditions;  // in the order of the protocol, else of their first row
    std::vector<std::string> participants;
    std::vector<std::string> groups;
    std::vector<int> group_of;                 // by participant, -1: none; shorter than participants if nobody has one
    std::optional<PrimaryComparison> primary;  // as the protocol states it
    std::vector<std::string> nodules;
    std::vector<std::string> comparisons;
    std::vector<Observation> rows;
    std::vector<TrialFigures> trials;
    std::vector<Choices> choices;
    std::vector<JudgedCase> judged;       // the same hits and false marks with their ratings, by case
    std::vector<StifferAnswers> stiffer;  // the same choices, for psychometric functions
    std::vector<Answer> answers;
    std::vector<StaircaseResult> staircases;
    std::vector<std::string> notes;  // for the reader of a report: interrupted trials, cut lines, clocks set back
    bool from_logs = false;          // not from a table of counts
    bool simulated = false;          // at least one trial is simulated
    std::int64_t practice_trials = 0;
    std::int64_t interrupted_trials = 0;
    std::int64_t excluded_trials = 0;        // finished tests that are left out
    std::int64_t withdrawn_trials = 0;       // those among them of participants who withdrew their data
    int withdrawn_people = 0;                // these participants, of whom `participants` has none
    int people_without_trial = 0;            // in the study's list, but no trial of theirs began
    std::vector<ConditionDisplay> displays;  // in the order of the protocol; empty for tables of counts
    std::vector<Progress> progress;          // logs against the plan; empty if the plan is not known
    std::vector<Exclusion> exclusions;       // as the experimenter decided
    std::vector<Replacement> replacements;   // whose trials are all excluded
};

// Hits and misses, and those among them that do not name their participant or their nodule.
struct UnnamedJudgements {
    std::int64_t all = 0;
    std::int64_t no_participant = 0;
    std::int64_t no_nodule = 0;
};
UnnamedJudgements unnamed_judgements(const Observations& seen);

// Returns the index of `name`, which is added if it is new.
int index_of(std::string_view name, std::vector<std::string>& names);

// Reads a table of counts. Its columns are condition, tp, fn, fp and optionally n (= tp + fn, checked), nodule,
// participant, group; or, for forced choices, condition, correct, n and optionally participant, comparison, group. `fp` may be n/a in
// rows that name a nodule. Throws InputError with file, line and column for an unknown column, a count that is negative
// or not whole, n other than tp + fn, correct > n, a name that is none (study/names.h), and rows that would be counted
// twice: with the same condition, participant and nodule or comparison, or rows of nodules (comparisons, participants)
// beside a row for all of them. A table with a column stiffer is read by study/stiffer_counts.h,
// one with a column kind by study/marks_table.h.
Observations read_counts(const std::filesystem::path& tsv, const RatingScale& scale = {});

}  // namespace palpa::study
