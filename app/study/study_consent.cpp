// Who takes part in a study, and who stops before its end.

#include <filesystem>

#include "app/study/study_run.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

// Removes what tells the experimenter about a person who did not agree. Nothing else of this person is on the disk.
void forget(const fs::path& subject) {
    std::error_code none;
    fs::remove(subject / "now.json", none);
    fs::remove(subject, none);  // stays if it holds anything
}

}  // namespace

void answer_consent(bool given, StudyRun& run) {
    run.consented = given;
    if (given) return go_on(run);
    forget(run.directory / ("sub-" + run.code));
    same_person(false, run);
    run.note = "Without agreement nobody takes part, and nothing was kept.";
}

void want_to_leave(StudyRun& run) {
    if (run.progress.known && !trial_goes_on(run)) enter(step::Leaving{}, run);
}

void leave_study(study::Withdrawal how, StudyRun& run) {
    if (how == study::Withdrawal::none) return go_on(run);
    run.unkept_answers = true;
    if (kept(run, [&] { study::withdraw(run.directory, run.code, how); })) enter(step::Withdrawn{}, run);
}

}  // namespace palpa::app
