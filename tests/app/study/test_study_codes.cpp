// The codes of a study's participants, without a screen.

#include <doctest/doctest.h>
#include <set>

#include "app/study/study_run.h"
#include "files/text.h"
#include "study/read_logs.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::app;
using namespace palpa::test;

TEST_CASE("study run: people at two screens stand in the groups of their own trials, whoever is quicker") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    const Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/paper.json");
    StudyRun here = open_study_run(protocol, log, "");
    StudyRun there = open_study_run(protocol, log, "");
    enter_code("01", here);
    enter_code("02", there);
    REQUIRE(at<step::Questions>(here));
    submit_answers({}, there);
    submit_answers({}, here);
    std::vector<std::string> notes;
    const std::vector<Person> people = read_people(log, notes);
    REQUIRE(people.size() == 2);
    for (const StudyRun* run : {&there, &here}) {
        const Person& person = people[static_cast<std::size_t>(run->progress.plan.number) - 1];
        CHECK(person.code == run->code);
        CHECK(person.group == protocol.groups[run->progress.plan.group].id);
    }
}

TEST_CASE("study run: a code is at one screen at a time, until that screen is closed or takes somebody else") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    const Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/paper.json");
    StudyRun here = open_study_run(protocol, log, "");
    {
        StudyRun there = open_study_run(protocol, log, "01");
        CHECK(free_code(here) == "02");  // who answers the questions there is nobody else here
        enter_code("01", here);
        REQUIRE(at<step::Code>(here));
        CHECK(here.note == "01 is in use at another screen; close the study there, or enter another code.");
        submit_answers({}, there);
        enter_code("01", here);
        CHECK(at<step::Code>(here));
        CHECK(contains(message_of([&] { open_study_run(protocol, log, "01"); }),
                       "--participant: found '01', who is at another screen now"));
        same_person(false, there);
        enter_code("01", here);
        CHECK(at<step::Again>(here));
        same_person(false, here);
        enter_code("01", there);
    }
    enter_code("01", here);
    CHECK(at<step::Again>(here));
}

TEST_CASE("study run: a protocol without questions takes a code") {
    const TemporaryFolder folder;
    StudyRun run = open_study_run(read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json"), folder / "log", "");
    enter_code("P7", run);
    CHECK(at<step::Instructions>(run));
    CHECK(contains(read_text(folder / "log/participants.tsv"), "\nsub-P7\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\t"));
}

TEST_CASE("study run: the code that is offered follows the highest number") {
    const TemporaryFolder folder;
    const Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json");
    StudyRun run = open_study_run(protocol, folder / "log", "");
    enter_code("07", run);
    CHECK(free_code(run) == "08");
    CHECK(free_code(open_study_run(protocol, folder / "log", "1234567890")) == "08");  // a number that nobody counts
}

TEST_CASE("study run: the field has the letters again after a code that is not taken") {
    const TemporaryFolder folder;
    StudyRun run = open_study_run(read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json"), folder / "log", "");
    CHECK(std::get<step::Code>(run.step).refused == 0);
    enter_code("P 7", run);
    CHECK(std::get<step::Code>(run.step).refused == 1);
}

TEST_CASE("study run: a code that tables would take for a missing value is refused for that reason") {
    const TemporaryFolder folder;
    const Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json");
    StudyRun run = open_study_run(protocol, folder / "log", "");
    enter_code("NA", run);
    CHECK(contains(run.note, "missing value"));
    enter_code("all", run);
    CHECK(run.note == "Tables take this code for a row of sums. Enter another one.");
    CHECK(contains(message_of([&] { open_study_run(protocol, folder / "log", "all"); }), "a row of sums"));
    CHECK(contains(message_of([&] { open_study_run(protocol, folder / "log", "NA"); }), "missing value"));
}

TEST_CASE("study run: the choices of the next person go to files of their own") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    StudyRun run = open_study_run(read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json"), log, "");
    for (const char* code : {"01", "02"}) {
        enter_code(code, run);
        begin_step(run);
        interval_presented(run);
        interval_presented(run);
        REQUIRE(at<step::Question>(run));
        choose_softer(true, 1.0, run);
        same_person(false, run);
    }
    CHECK(finished_trials(log, "01") == std::set<int>{1});
    CHECK(finished_trials(log, "02") == std::set<int>{1});
}

TEST_CASE("study run: a code that differs from a participant's by capitals or zeros alone begins nobody new") {
    const TemporaryFolder folder;
    const Protocol protocol = read_protocol(PALPA_SOURCE_DIR "/assets/protocols/softer.json");
    StudyRun run = open_study_run(protocol, folder / "log", "");
    enter_code("P07", run);
    same_person(false, run);
    for (const char* code : {"p07", "P7", "p007"}) {
        CAPTURE(code);
        enter_code(code, run);
        CHECK(at<step::Code>(run));
        CHECK(run.note == "P07 is in this study. Enter that code, or one that differs by more than capitals or zeros.");
        CHECK_FALSE(std::filesystem::exists(folder / "log" / (std::string("sub-") + code)));
        CHECK(contains(message_of([&] { open_study_run(protocol, folder / "log", code); }),
                       "which differs from a participant's code by capitals or zeros only"));
    }
    enter_code("P07", run);
    CHECK(at<step::Again>(run));
    for (const char* code : {"P70", "P0", "P077", "Q7"}) {
        CAPTURE(code);
        same_person(false, run);
        enter_code(code, run);
        CHECK(at<step::Instructions>(run));
    }
}
