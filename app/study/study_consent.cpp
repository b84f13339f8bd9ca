// Who takes part in a study, and who stops before its end.

#include <algorithm>
#include <charconv>
#include <cstdio>
#include <filesystem>
#include <system_error>

#include "app/study/study_run.h"
#include "study/exclusions.h"

namespace palpa::app {
namespace {

namespace fs = std::filesystem;

// The number that a code of at most nine digits is, else 0.
std::size_t number_of(const std::string& code) {
    std::size_t number = 0;
    const auto [end, error] = std::from_chars(code.data(), code.data() + code.size(), number);
    const bool whole = error == std::errc() && end == code.data() + code.size();
    return whole && code.size() <= 9 ? number : 0;
}

}  // namespace

std::string free_code(const StudyRun& run) {
    std::vector<std::string> notes;
    const std::vector<study::Person> people = study::read_people(run.directory, notes);
    std::size_t last = people.size();
    for (const study::Person& p : people) last = std::max(last, number_of(p.code));
    for (std::size_t number = last + 1;; ++number) {
        char code[24];
        std::snprintf(code, sizeof code, "%02zu", number);
        const auto same = [&](const study::Person& p) { return p.code == code; };
        // whoever answers the first questions is not among the people yet
        const bool begun = fs::exists(run.directory / (std::string("sub-") + code));
        if (!begun && std::none_of(people.begin(), people.end(), same)) return code;
    }
}

void forget_unasked(const StudyRun& run) {
    const fs::path subject = run.directory / ("sub-" + run.code);
    std::error_code none;
    fs::remove(subject / "now.json", none);
    fs::remove(subject, none);  // stays if it holds anything
}

void answer_consent(bool given, StudyRun& run) {
    run.consented = given;
    if (given) return go_on(run);
    forget_unasked(run);
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

std::string words_of_replaced(const std::string& code, const std::string& successor) {
    return code + " was replaced by " + successor + "; enter that code.";
}

bool left_elsewhere(StudyRun& run) {
    auto how = study::Withdrawal::none;
    std::string successor;
    const bool read = kept(run, [&] {
        how = study::withdrawal_of(run.directory, run.code);
        successor = study::replaced_by(run.directory, run.code);
    });
    if (!read) return true;
    if (how != study::Withdrawal::none) {
        enter(step::Withdrawn{}, run);
        return true;
    }
    if (successor.empty()) return false;
    const std::string code = run.code;
    same_person(false, run);
    run.note = words_of_replaced(code, successor);
    return true;
}

}  // namespace palpa::app
