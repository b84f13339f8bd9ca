#include <doctest/doctest.h>
#include <filesystem>

#include "files/text.h"
#include "study/ratings.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "study/study_folder.h"
#include "study/typed_trial.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

TrialLabel label_of_trial(int trial, const char* condition) {
    TrialLabel label;
    label.condition = condition;
    label.device = "a block";
    label.trial = trial;
    label.study = {{"sha256", "x"}};
    return label;
}

}  // namespace

TEST_CASE("typed trial: what the experimenter types is analysed like what the program saw") {
    const TemporaryFolder folder;
    TypedAnswers answers;
    answers.nodules = {5, kMissed, 0};
    answers.false_marks = 2;
    answers.duration_s = 42.5;
    write_typed_trial(next_run(folder.path(), "07"), label_of_trial(1, "by hand"), false, 3, {"A", "B", "C"}, answers);
    TypedAnswers unnamed;
    unnamed.found = 1;
    unnamed.missed = 2;
    unnamed.duration_s = 20.0;
    write_typed_trial(next_run(folder.path(), "07"), label_of_trial(2, "another"), false, 3, {}, unnamed);
    write_typed_trial(next_run(folder.path(), "07"), label_of_trial(3, "another"), true, 3, {}, unnamed);

    const Observations seen = read_study(folder.path());
    REQUIRE(seen.notes.size() == 1);  // of a protocol that is not beside them
    CHECK(seen.notes[0].find("study.json and protocol.json are not there") != std::string::npos);
    CHECK(seen.practice_trials == 1);
    CHECK(finished_trials(folder.path(), "07") == std::set<int>{1, 2, 3});
    const Report report = make_report(seen, {});
    REQUIRE(report.conditions.size() == 2);
    const ConditionResult& by_hand = report.conditions[0];
    CHECK(by_hand.tp == 2);
    CHECK(by_hand.fn == 1);
    CHECK(by_hand.fp == 2);
    REQUIRE(by_hand.nodules.size() == 3);
    CHECK(by_hand.nodules[1].nodule == "B");
    CHECK(by_hand.nodules[1].se.x.k == 0);
    CHECK(by_hand.duration_s->median == 42.5);
    CHECK(report.conditions[1].tp == 1);
    CHECK(report.conditions[1].fn == 2);
    const std::string marks = read_text(folder / "sub-07/beh/sub-07_task-palpation_run-01_marks.tsv");
    CHECK(marks.find("42.5\t1\t1\tn/a\tn/a\t5\tA\tn/a\t1\n") != std::string::npos);
}

TEST_CASE("ratings: kept, read, a line that was cut off left out, summed up by condition") {
    const TemporaryFolder folder;
    std::vector<std::string> notes;
    CHECK(read_ratings(folder.path(), "01", notes).empty());
    add_ratings(folder.path(), "01", {{"n/a", "glasses", "yes\tno"}, {"pen", "effort", "3"}});
    const auto file = folder / "sub-01/beh/sub-01_task-ratings_beh.tsv";
    std::filesystem::resize_file(file, std::filesystem::file_size(file) - 3);  // "pen effort" without its value
    add_ratings(folder.path(), "01", {{"pen", "effort", "5"}, {"pen", "note", ""}});
    add_ratings(folder.path(), "02", {{"pen", "effort", "2"}, {"pen", "note", "n/a"}});
    const auto ratings = read_ratings(folder.path(), "01", notes);
    REQUIRE(ratings.size() == 3);
    CHECK(ratings[0].value == "yes no");
    CHECK(ratings[1].value == "5");
    CHECK(ratings[2].value == "n/a");
    REQUIRE(notes.size() == 1);
    CHECK(notes[0].find("line 3 is left out") != std::string::npos);

    TypedAnswers answers;
    answers.found = 1;
    answers.duration_s = 1.0;
    for (const char* code : {"01", "02"})
        write_typed_trial(next_run(folder.path(), code), label_of_trial(1, "pen"), false, 1, {}, answers);
    const Report report = make_report(read_study(folder.path()), {});
    REQUIRE(report.ratings.size() == 2);
    CHECK(report.ratings[0].value == "yes no");
    CHECK(report.ratings[1].item == "effort");
    CHECK(report.ratings[1].n == 2);
    CHECK(report.ratings[1].spread->median == 3.5);
    CHECK(report_json(report)["ratings"][1]["mean"] == 3.5);
    CHECK(report_markdown(report).find("| pen | effort | scale | 2 | 3.50 |") != std::string::npos);
}
