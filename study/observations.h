#pragma once
// The results of a study, in one form whether they come from a table of counts or from logs. Names are kept once; rows
// hold their indices.

#include <cstdint>
#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::study {

// Hits and misses of one nodule in one trial, or their sums over many trials. False marks belong to no nodule.
struct Observation {
    int condition = 0;
    int participant = -1;  // -1: not told
    int nodule = -1;       // -1: not told, or all
    int repeat = 0;        // which trial of this participant under this condition: matches pairs
    std::int64_t tp = 0;
    std::int64_t fn = 0;
    std::int64_t fp = 0;
};

// One finished trial, as its log gives it. NaN: the log does not hold this figure.
struct TrialFigures {
    int condition = 0;
    int participant = 0;
    double duration_s = 0.0;
    double path_m = 0.0;        // while pressing
    double mean_force_N = 0.0;  // while pressing
    double max_force_N = 0.0;
};

// Forced choices: `correct` of `n`.
struct Choices {
    int condition = 0;
    int participant = -1;
    int comparison = -1;  // which stimulus against the reference; -1: not told, or all
    std::int64_t correct = 0;
    std::int64_t n = 0;
};

// An answer to one of the protocol's questions; a number, or one of its choices as it was written.
struct Answer {
    std::string condition;  // n/a: asked before the trials
    std::string item;
    std::string value;
};

struct Observations {
    std::vector<std::string> conditions;  // in the order of their first row
    std::vector<std::string> participants;
    std::vector<std::string> nodules;
    std::vector<std::string> comparisons;
    std::vector<Observation> rows;
    std::vector<TrialFigures> trials;
    std::vector<Choices> choices;
    std::vector<Answer> answers;
    std::vector<std::string> notes;  // what a reader must know: interrupted trials, lines cut off, clocks set back
    bool simulated = false;          // some of it, at least
    std::int64_t practice_trials = 0;
    std::int64_t interrupted_trials = 0;
};

// Returns the index of the name; a new name is added.
int index_of(std::string_view name, std::vector<std::string>& names);

// COUNTS.tsv: columns condition, tp, fn, fp, optionally n (= tp + fn, checked), nodule, participant; or, for forced
// choices, condition, correct, n, optionally participant, comparison. `fp` may be n/a in rows that name a nodule.
// Throws InputError with file, line and column: counts that are negative or not whole, tp + fn that is not n,
// correct > n, the same condition, nodule and participant twice.
Observations read_counts(const std::filesystem::path& tsv);

}  // namespace palpa::study
