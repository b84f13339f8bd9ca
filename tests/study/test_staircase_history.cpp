#include <algorithm>
#include <doctest/doctest.h>

#include "files/text.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "study/sample_log.h"
#include "study/study_folder.h"
#include "study/trial_log.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

Protocol threshold_protocol(const TemporaryFolder& folder) {
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "a", "modality": "hand"}, {"id": "b", "modality": "hand"}], "practice": {"trials": 1},
        "staircase": {"method": "weighted-up-down", "reference_kPa": 10, "comparisons_kPa": [11, 12, 13, 14], "trials": 12}})");
    return read_protocol(folder / "p.json");
}

// Answers the trials that are left until `until`: right where the comparison is 13 kPa or more.
void answer(const Protocol& protocol, const std::filesystem::path& log, int until) {
    const StudyProgress progress = progress_of(log, protocol, "01");
    ChoiceLog choices(next_run(log, "01", "softer"));
    for (const PlannedTrial& trial : progress.plan.trials) {
        if (progress.finished.count(trial.trial) > 0 || trial.trial > until) continue;
        int level = trial.comparison;
        if (level < 0)
            level = next_level(protocol.staircase, staircase_answers(log, protocol, "01", trial.condition),
                               trial.reference_first);
        ChoiceRow row;
        row.block = trial.practice ? "practice" : "test";
        row.trial = trial.trial;
        row.condition = protocol.conditions[trial.condition].id;
        row.reference_kPa = 10.0;
        row.comparison_kPa = protocol.staircase.comparisons_kPa[static_cast<std::size_t>(level)];
        row.first = trial.reference_first ? "reference" : "comparison";
        const bool right = row.comparison_kPa >= 13.0;
        row.answer = right ? "reference" : "comparison";
        row.correct = right ? 1 : 0;
        REQUIRE(choices.write(row));
    }
}

}  // namespace

TEST_CASE("staircase history: a study that is interrupted goes on with the same levels") {
    const TemporaryFolder folder;
    const Protocol protocol = threshold_protocol(folder);
    for (const char* name : {"one", "two"}) {
        open_study(folder / name, protocol, {false, 0, "p"});
        Person person;
        person.code = "01";
        add_people(folder / name, {person});
    }
    answer(protocol, folder / "one", 1000);
    for (const int until : {1, 5, 9, 20, 1000}) answer(protocol, folder / "two", until);
    for (const std::size_t condition : {std::size_t{0}, std::size_t{1}}) {
        const auto whole = staircase_answers(folder / "one", protocol, "01", condition);
        const auto parts = staircase_answers(folder / "two", protocol, "01", condition);
        REQUIRE(whole.size() == 12);  // practice does not count
        REQUIRE(parts.size() == 12);
        CHECK(whole[0].level == 3);
        CHECK(whole[1].level == 2);  // 14 was felt,
        CHECK(whole[2].level == 1);  // 13 too,
        CHECK(whole[3].level == 3);  // 12 not
        for (std::size_t i = 0; i < 12; ++i) {
            CHECK(whole[i].level == parts[i].level);
            CHECK(whole[i].reference_first == parts[i].reference_first);
        }
    }
}

TEST_CASE("staircase history: the report tells each staircase, and tests no share of right answers") {
    const TemporaryFolder folder;
    const Protocol protocol = threshold_protocol(folder);
    open_study(folder / "log", protocol, {false, 0, "p"});
    Person person;
    person.code = "01";
    add_people(folder / "log", {person});
    answer(protocol, folder / "log", 1000);
    const Report report = make_report(read_study(folder / "log"), {});
    CHECK(report.choices.empty());
    REQUIRE(report.staircases.size() == 2);
    CHECK(report.staircases[1].condition == "b");
    CHECK(report.staircases[1].estimate.trials == 12);
    const Json json = report_json(report);
    CHECK(json["staircases"][0]["method"] == "weighted-up-down");
    CHECK(json["staircases"][0]["target"] == 0.75);
    CHECK(json["staircases"][0]["threshold_percent"].get<double>() > 15.0);
    CHECK(json["staircases"][0]["threshold_percent"].get<double>() < 40.0);
    CHECK(contains(report_markdown(report), "| a | 01 | weighted-up-down | 12 |"));
}

TEST_CASE("staircase history: a level that the protocol does not have is named") {
    const TemporaryFolder folder;
    const Protocol protocol = threshold_protocol(folder);
    open_study(folder / "log", protocol, {false, 0, "p"});
    ChoiceLog choices(next_run(folder / "log", "01", "softer"));
    ChoiceRow row;
    row.condition = "a";
    row.reference_kPa = 10.0;
    row.comparison_kPa = 11.5;
    REQUIRE(choices.write(row));
    const std::string message = message_of([&] { staircase_answers(folder / "log", protocol, "01", 0); });
    CHECK(contains(message, "comparison_kPa"));
    CHECK(contains(message, "one of staircase.comparisons_kPa"));
}

TEST_CASE("staircase history: the analysis holds staircases against the plan, and leaves out who is excluded") {
    const TemporaryFolder folder;
    const Protocol protocol = threshold_protocol(folder);
    const std::filesystem::path log = folder / "log";
    open_study(log, protocol, {false, 0, "p"});
    Person person;
    person.code = "01";
    add_people(log, {person});
    answer(protocol, log, 1000);
    const Observations seen = read_study(log);
    CHECK(seen.choices.empty());       // the method sets the share of right answers,
    CHECK(seen.stiffer.size() == 24);  // but psychometric functions take them
    REQUIRE(seen.progress.size() == 2);
    CHECK(seen.progress[0].planned == 12);
    CHECK(seen.progress[0].finished == 12);
    REQUIRE(seen.staircases.size() == 2);
    CHECK(seen.staircases[0].estimate.trials == 12);

    write_text_atomically(log / "exclusions.tsv", "participant\ttrial\treason\n01\t3\tnoise\n");
    const Observations fewer = read_study(log);
    CHECK(fewer.staircases[0].estimate.trials == 11);
    CHECK(fewer.stiffer.size() == 23);

    write_text_atomically(log / "exclusions.tsv", "participant\ttrial\treason\n01\tall\tleft\n");
    CHECK(read_study(log).staircases.empty());
}

TEST_CASE("staircase history: answers at a level that the staircase did not ask for are named") {
    const TemporaryFolder folder;
    const Protocol protocol = threshold_protocol(folder);
    const std::filesystem::path log = folder / "log";
    open_study(log, protocol, {false, 0, "p"});
    Person person;
    person.code = "01";
    add_people(log, {person});
    answer(protocol, log, 1000);
    CHECK_FALSE(contains(report_json(make_report(read_study(log), {})).dump(), "do not ask for"));

    const std::filesystem::path file = events_files(log / "sub-01").front();
    std::string text = read_text(file);
    const std::size_t last = text.rfind("\t12\t");  // 12 kPa, in one of the last tests of condition b
    REQUIRE(last != std::string::npos);
    text.replace(last, 4, "\t11\t");
    write_text_atomically(file, text);
    const Observations seen = read_study(log);
    const auto tells = [](const std::string& note) {
        return contains(note, "of 12 answers of the staircase under 'b'") && contains(note, "do not ask for");
    };
    CHECK(std::count_if(seen.notes.begin(), seen.notes.end(), tells) == 1);
}
