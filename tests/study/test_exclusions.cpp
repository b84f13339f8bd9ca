#include <doctest/doctest.h>

#include "files/text.h"
#include "study/exclusions.h"
#include "study/order_balance.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "study/typed_trial.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

// Two conditions by hand in a Latin square, so that every second person begins with the same one.
Protocol study_by_hand(const fs::path& log, const std::string& b = R"("modality": "hand", "nodules": ["A"])") {
    write_text_atomically(log.parent_path() / "p.json", R"({"name": "n", "version": "1", "seed": 3, "order": "latin",
        "conditions": [{"id": "a", "modality": "hand", "nodules": ["A"]}, {"id": "b", )" +
                                                            b + "}]}");
    const Protocol protocol = read_protocol(log.parent_path() / "p.json");
    open_study(log, protocol, {});
    return protocol;
}

// Somebody who finishes the first `trials` of the plan and finds all.
void take_part(const fs::path& log, const Protocol& protocol, const std::string& code, std::size_t trials) {
    const StudyProgress progress = progress_of(log, protocol, code);
    if (!progress.known) add_people(log, {Person{code, "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
    for (std::size_t i = 0; i < trials; ++i) {
        const PlannedTrial& trial = progress.plan.trials[i];
        TrialLabel label;
        label.condition = protocol.conditions[trial.condition].id;
        label.trial = trial.trial;
        label.study = {{"sha256", protocol.sha256}, {"participant_number", progress.plan.number}};
        TypedAnswers answers;
        answers.nodules = {5};
        answers.duration_s = 20.0 + 0.1 * std::stoi(code) + static_cast<double>(i);
        write_typed_trial(next_run(log, code), label, false, trial.seed, {"A"}, answers);
    }
}

}  // namespace

TEST_CASE("exclusions: a trial or a participant is left out and reported, and nothing is deleted") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = study_by_hand(log);
    for (const char* code : {"01", "02", "03"}) take_part(log, protocol, code, 2);
    CHECK(read_study(log).trials.size() == 6);
    write_text_atomically(log / "exclusions.tsv", "");  // of a disk that was full
    CHECK(contains(message_of([&] {
                       add_exclusion(log, {"01", 2,
                                           "m\xfc"
                                           "de"});
                   }),
                   "UTF-8"));
    add_exclusion(log, {"01", 2, "fire \"alarm\"\t"});
    add_exclusion(log, {"02", std::nullopt, "did not understand the task"});
    const Observations seen = read_study(log);
    CHECK(seen.trials.size() == 3);
    CHECK(seen.excluded_trials == 3);
    CHECK(seen.notes.empty());
    const Report report = make_report(seen, {});
    const Json json = report_json(report);
    CHECK(json["exclusions"][0]["reason"] == "fire 'alarm'");
    CHECK(json["exclusions"][1]["trial"].is_null());
    CHECK(json["plan"][0]["finished"] == 1);
    CHECK(json["plan"][1]["excluded"] == 1);
    CHECK(contains(report_markdown(report), "3 finished tests are left out by the experimenter's decision"));
    CHECK(contains(report_markdown(report), "| 02 | all | did not understand the task |"));
    CHECK(finished_trials(log, "02") == std::set<int>{1, 2});
    CHECK(report.excluded_people == 1);
    add_exclusion(log, {"01", 1, "fire again"});  // each of that person's tests by itself
    const Report fewer = make_report(read_study(log), {});
    CHECK(fewer.excluded_people == 2);
    CHECK(fewer.participants + fewer.excluded_people == 3);
}

TEST_CASE("displays: answers that were typed in are called so, whatever the scene of their condition") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = study_by_hand(log, R"("modality": "tangible", "scene": "s.json")");
    take_part(log, protocol, "01", 2);
    const Observations seen = read_study(log);
    REQUIRE(seen.displays.size() == 2);
    CHECK(seen.displays[1].condition == "b");
    CHECK(seen.displays[1].typed_in);
}

TEST_CASE("ratings: texts to choose from that look like numbers are counted, not averaged") {
    Observations seen;
    for (const char* value : {"1", "2", "2"}) {
        seen.answers.push_back({"a", "how many", value, -1, true});
        seen.answers.push_back({"a", "how hard", value, -1, false});
    }
    const Report report = make_report(seen, {});
    REQUIRE(report.ratings.size() == 3);
    CHECK(report.ratings[0].n == 1);
    CHECK(report.ratings[1].value == "2");
    CHECK_FALSE(report.ratings[1].spread);
    CHECK(report.ratings[2].spread->mean == close_to(5.0 / 3.0));
}

TEST_CASE(
    "exclusions: what cannot be is refused before anything is written, and in a table made by hand with its line") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = study_by_hand(log);
    take_part(log, protocol, "01", 1);
    const auto refused = [&](const Exclusion& one) { return message_of([&] { add_exclusion(log, one); }); };
    CHECK(contains(refused({"09", 1, "x"}), "--participant: found '09'"));
    CHECK(contains(refused({"01", 1, " "}), "--reason: found ''"));
    CHECK(contains(refused({"01", 2, "x"}), "--trial: found 2, expected a trial that 01 has finished"));
    CHECK(contains(refused({"01", 1, ""}), "--reason: found ''"));
    CHECK_FALSE(fs::exists(log / "exclusions.tsv"));
    CHECK(contains(message_of([&] { add_exclusion(folder.path(), {"01", 1, "x"}); }), "no study.json"));
    add_exclusion(log, {"01", 1, "x"});
    CHECK(contains(refused({"01", 1, "y"}), "found trial 1 of 01 already, because 'x'"));
    add_exclusion(log, {"01", std::nullopt, "z"});
    CHECK(contains(refused({"01", 1, "y"}), "found trial 1 of 01 already, because 'x'"));
    CHECK(contains(refused({"01", std::nullopt, "y"}), "found all trials of 01 already, because 'z'"));
    take_part(log, protocol, "02", 1);
    add_exclusion(log, {"02", std::nullopt, "z"});
    CHECK(contains(refused({"02", 1, "y"}), "found all trials of 02 already, because 'z'"));
    const auto said = [&](const std::string& rows) {
        write_text_atomically(log / "exclusions.tsv", rows);
        return message_of([&] { read_study(log); });
    };
    const std::string head = "participant\ttrial\treason\n";
    CHECK(said(head + "sub-01\t1\tx\n").empty());
    CHECK(contains(said(head + "01\t2\tx\n"),
                   "trial: found 2 of '01', expected a trial that this participant has finished"));
    CHECK(contains(said(head + "09\tall\tx\n"), "participant: found '09'"));
    CHECK(contains(said(head + "01\tone\tx\n"), "line 2, trial"));
    CHECK(contains(said(head + "01\t1\tn/a\n"), "line 2, reason: found 'n/a'"));
    CHECK(contains(said(head + "01\t1\tx\n01\t1\ty\n"), "line 3, trial: found '1', expected each trial"));
    CHECK(contains(said("participant\treason\n01\tx\n"), "expected the columns participant trial reason"));
}

TEST_CASE("replacements: who replaces a dropout gets that place in the plan, and nobody else's place changes") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = study_by_hand(log);
    take_part(log, protocol, "01", 2);
    take_part(log, protocol, "02", 1);  // leaves
    take_part(log, protocol, "03", 2);
    add_replacement(log, {"02", "21", "felt unwell"});
    CHECK(progress_of(log, protocol, "21").plan.number == 2);
    CHECK(progress_of(log, protocol, "04").plan.number == 4);
    // nobody has begun in that place yet, so that what is missing of it is still 02's
    CHECK(contains(report_markdown(make_report(read_study(log), {})),
                   "Of 6 planned tests 5 are finished and 1 is missing"));
    take_part(log, protocol, "21", 2);
    CHECK(progress_of(log, protocol, "04").plan.number == 4);  // 21 has a line, but no number of its own
    take_part(log, protocol, "04", 2);
    CHECK(progress_of(log, protocol, "03").plan.number == 3);
    const Observations seen = read_study(log);
    CHECK(seen.notes.empty());
    CHECK(seen.trials.size() == 8);
    CHECK(seen.excluded_trials == 1);
    const std::string report = report_markdown(make_report(seen, {}));
    CHECK(contains(report, "| 02 | all | dropped out, replaced by 21: felt unwell |"));
    CHECK(contains(report, "Of 8 planned tests 8 are finished and 0 are missing"));  // a place counts once
    for (const Progress& row : seen.progress) CHECK(row.replaced_by == (row.participant == "02" ? "21" : ""));
    // every condition stands at every position equally often among those who finished
    std::vector<PlannedParticipant> people;
    for (const char* code : {"01", "21", "03", "04"}) people.push_back(progress_of(log, protocol, code).plan);
    CHECK(imbalance_of(protocol, people)[0].position == 0);
    add_replacement(log, {"21", "22", "left too"});
    CHECK(progress_of(log, protocol, "22").plan.number == 2);
    const auto refused = [&](const Replacement& one) { return message_of([&] { add_replacement(log, one); }); };
    CHECK(contains(refused({"02", "30", "x"}), "somebody whose place is free: 21 has begun in it"));
    CHECK(contains(refused({"01", "22", "x"}), "--by: found '22'"));
    CHECK(contains(refused({"01", "03", "x"}), "--by: found '03', expected a code that is not yet in"));
    CHECK(contains(refused({"01", "3", "x"}), "--by: found '3', expected a code that differs from 03 in "));
    CHECK(contains(refused({"09", "30", "x"}), "--participant: found '09'"));
    CHECK(contains(refused({"01", "NA", "x"}), "--by: found 'NA'"));
}

TEST_CASE("replacements: who was to take a place and never came is replaced by another; who has begun keeps it") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = study_by_hand(log);
    take_part(log, protocol, "01", 2);
    take_part(log, protocol, "02", 1);  // leaves
    add_replacement(log, {"02", "21", "felt unwell"});
    add_replacement(log, {"02", "22", "21 did not come"});
    CHECK(replaced_by(log, "02") == "22");
    CHECK(read_replacements(log).size() == 1);
    CHECK(progress_of(log, protocol, "22").plan.number == 2);
    CHECK(progress_of(log, protocol, "21").plan.number == 3);  // 21 comes after all: the next free place
    take_part(log, protocol, "22", 2);
    const auto refused = [&](const Replacement& one) { return message_of([&] { add_replacement(log, one); }); };
    CHECK(contains(refused({"02", "23", "x"}), "22 has begun in it"));
    take_part(log, protocol, "21", 2);  // comes late
    CHECK(replaced_by(log, "02") == "22");
    CHECK(progress_of(log, protocol, "21").plan.number == 3);
    CHECK(progress_of(log, protocol, "22").plan.number == 2);
    const std::string report = report_markdown(make_report(read_study(log), {}));
    CHECK(contains(report, "Of 6 planned tests 6 are finished and 0 are missing"));
    append_synced(log / "replacements.tsv", "02\t23\tby hand\n");
    CHECK(contains(message_of([&] { read_replacements(log); }),
                   "line 5, participant: found '02', expected each participant "
                   "once: 22 has this place already"));
}

TEST_CASE("replacements: nobody who is simulated replaces another, since each has one place in the plan") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    study_by_hand(folder / "other");
    const Protocol protocol = read_protocol(folder / "p.json");
    open_study(log, protocol, {true, 1, "palpa"});
    add_people(log, {Person{"sim0001", "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
    CHECK(contains(message_of([&] {
                       add_replacement(log, {"sim0001", "sim0002", "left"});
                   }),
                   "--by: found 'sim0002', expected a code that does not begin with 'sim'"));
    CHECK_FALSE(fs::exists(log / "replacements.tsv"));
    add_replacement(log, {"sim0001", "x1", "left"});  // somebody who never comes
}

TEST_CASE("replacements: who takes a place but came with another order, as from a tablet, is named") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = study_by_hand(log);
    for (const char* code : {"01", "02", "03"}) take_part(log, protocol, code, 2);
    const auto noted = [&](const std::string& by) {
        write_text_atomically(log / "replacements.tsv", "participant\treplaced_by\treason\n01\t" + by + "\tleft\n");
        return read_study(log).notes;
    };
    REQUIRE(noted("02").size() == 1);
    CHECK(contains(noted("02").front(), "02 has not the group and order of 01, whose place this is (number 2"));
    CHECK(noted("03").empty());  // the same order again
}

TEST_CASE("replacements: a replaced participant with a trial that is left out counts as replaced") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = study_by_hand(log);
    take_part(log, protocol, "01", 2);
    take_part(log, protocol, "02", 1);
    add_exclusion(log, {"02", 1, "fire alarm"});
    add_replacement(log, {"02", "21", "left"});
    const Report report = make_report(read_study(log), {});
    CHECK(report.excluded_people == 0);
    CHECK(report.replaced_people == 1);
}

TEST_CASE("replacements: only a place that somebody was to take can be freed") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = study_by_hand(log);
    take_part(log, protocol, "01", 2);
    append_synced(log / "replacements.tsv", "participant\treplaced_by\treason\n01\tn/a\tby hand\n");
    CHECK(contains(message_of([&] { read_replacements(log); }), "line 2, replaced_by: found 'n/a', expected a code"));
}
