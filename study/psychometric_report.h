#pragma once
// The psychometric functions of a study: one of each person under each condition, one of all people, and the ratios of
// the JNDs of all pairs of conditions.

#include <string>
#include <vector>

#include "files/json.h"
#include "study/observations.h"
#include "study/psychometric_people.h"

namespace palpa::study {

// Where the intervals come from: the profile likelihood of independent answers, or the bootstrap over people.
enum class IntervalMethod { profile, bootstrap };

struct PsychometricResult {
    std::string condition;
    std::string participant;  // empty: all answers of the condition
    int participants = 0;     // how many people answered; 0: not given
    StiffnessAxis axis = StiffnessAxis::second_first;
    std::vector<LevelAnswers> levels;
    std::int64_t n = 0;
    bool fitted = false;  // false: one level only
    PsychometricFit fit;  // its intervals are those of `method`
    IntervalMethod method = IntervalMethod::profile;
};

// a's JND divided by b's, in units of x, of all answers of each condition.
struct PsychometricPair {
    std::string a, b;
    int left_out = 0;  // people with answers under one of both, where others have answers under both: not compared
    std::optional<double> jnd_ratio;
    OpenInterval ci;
    IntervalMethod method = IntervalMethod::profile;
};

struct Psychometrics {
    double greatest_lapse = 0.05;
    std::vector<PsychometricResult> curves;  // by condition: all answers, then each person
    std::vector<PsychometricPair> pairs;
    std::vector<std::string> notes;
};

struct ReportTable;

// Without forced choices whose levels are known there are no curves.
Psychometrics psychometrics_of(const Observations& seen, double greatest_lapse, const BootstrapOptions& options);

const char* name_of(StiffnessAxis axis);
const char* name_of(IntervalMethod method);

// Adds `psychometric` and `psychometric_pairs` to the report's object; nothing without curves.
void add_psychometrics(const Psychometrics& found, files::Json& report);
std::vector<ReportTable> psychometric_tables(const Psychometrics& found);
std::string psychometric_methods(const Psychometrics& found);  // a paragraph for the report; empty without curves

}  // namespace palpa::study
