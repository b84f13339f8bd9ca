#pragma once
// A trial that the program did not see: by hand on a real phantom, or on a device that the program does not drive. The
// experimenter types in the participant's answers; the log has the form of every other trial.

#include <string>
#include <vector>

#include "study/sample_log.h"
#include "study/trial_log.h"

namespace palpa::study {

inline constexpr int kMissed = -1;  // value in TypedAnswers::nodules

struct TypedAnswers {
    std::vector<int> nodules;  // by nodule of the phantom: kMissed, or the confidence 1 to 5 (0: not given)
    int found = 0;             // this and `missed`: where the phantom's nodules have no names
    int missed = 0;
    int false_marks = 0;
    double duration_s = 0.0;
};

int found_of(const TypedAnswers& answers);
int missed_of(const TypedAnswers& answers);

// Writes settings, marks and events of one run, the row `finish` last; all are on the disk when the function returns.
// `nodules` holds the names of the nodules, as many as answers.nodules. Throws std::runtime_error if something cannot
// be written; the trial then counts as interrupted.
void write_typed_trial(const RunFiles& files, const TrialLabel& label, bool practice, std::int64_t seed,
                       const std::vector<std::string>& nodules, const TypedAnswers& answers);

}  // namespace palpa::study
