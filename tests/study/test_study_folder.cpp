#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>

#include "files/text.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "study/study_folder.h"
#include "study/trial_log.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

Protocol protocol_of(const TemporaryFolder& folder, const std::string& version = "1") {
    write_text_atomically(folder / "p.json",
                          R"({"name": "n", "version": ")" + version + R"(", "seed": 1, "order": "fixed",
        "instructions": "Find them.", "time_limit_s": 60, "practice": {"trials": 1},
        "conditions": [{"id": "a", "modality": "pen", "scene": "s.json", "instructions": "Press."},
                       {"id": "b", "modality": "pen", "scene": "s.json"}]})");
    return read_protocol(folder / "p.json");
}

// A trial as the app logs it; found: how many of two nodules.
std::string write_run(const fs::path& directory, const std::string& code, int trial, const std::string& condition,
                      int found, bool finished, const std::string& sha256,
                      const std::string& began_utc = "2026-11-21T10:00:00Z") {
    const RunFiles files = next_run(directory, code);
    write_text_atomically(files.file("_settings.json"),
                          R"({"nodules": [{"id": "A"}, {"id": "B"}], "study": {"sha256": ")" + sha256 + "\"}}");
    TrialLog log(files, {false, false});
    EventRow row;
    row.trial = trial;
    row.trial_type = "start";
    row.condition = condition;
    row.block = "test";
    row.n_nodules = 2;
    log.write(row);
    for (int i = 0; i < found; ++i) {
        row.trial_type = "mark";
        row.onset_s = 10.0;
        row.x_mm = row.y_mm = 20.0 * i;
        log.write(row);
        MarkRow mark;
        mark.nodule = i == 0 ? "A" : "B";
        mark.hit = 1;
        log.write(mark);
    }
    if (finished) {
        row.trial_type = "finish";
        row.onset_s = row.duration_s = 40.0 + 0.01 * std::stoi(code.substr(1));  // no two people are alike
        row.x_mm = row.y_mm = EventRow::kMissing;
        row.true_positives = found;
        row.false_negatives = 2 - found;
        row.false_positives = 0;
        row.path_mm = 900.0;
        row.mean_force_N = 2.0;
        row.max_force_N = 3.0;
        log.write(row);
        write_text_atomically(files.file("_performance.json"), R"({"began_utc": ")" + began_utc + "\"}");
    }
    return files.file("_events.tsv").string();
}

void enter(const fs::path& directory, const std::vector<std::string>& codes) {
    for (const std::string& code : codes)
        add_people(directory, {Person{code, "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
}

void append(const fs::path& file, const std::string& text) { write_text_atomically(file, read_text(file) + text); }

}  // namespace

TEST_CASE("study folder: made once, gone on with, refused to another version or kind") {
    const TemporaryFolder folder;
    const Protocol protocol = protocol_of(folder);
    open_study(folder / "log", protocol, {false, 0, "palpa"});
    CHECK(read_text(folder / "log/protocol.json") == protocol.text);
    CHECK(fs::exists(folder / "log/task-palpation_events.json"));
    open_study(folder / "log", protocol, {false, 0, "palpa"});
    const Protocol changed = protocol_of(folder, "2");
    const std::string message = message_of([&] { open_study(folder / "log", changed, {false, 0, "palpa"}); });
    CHECK(contains(message, "study.json: sha256: found 'n' version '1'"));
    CHECK(contains(message, "expected 'n' version '2'"));
    CHECK(contains(message_of([&] {
                       open_study(folder / "log", protocol, {true, 3, "palpa"});
                   }),
                   "found people, expected simulated participants of seed 3"));
    open_study(folder / "simulated", protocol, {true, 3, "palpa", 60.0});
    CHECK(contains(message_of([&] {
                       open_study(folder / "simulated", protocol, {true, 3, "palpa", 2000.0});
                   }),
                   "simulation_rate_Hz: found 60, expected 2000"));
    fs::create_directories(folder / "other/sub-01");
    CHECK(
        contains(message_of([&] { open_study(folder / "other", protocol, {}); }), "logs (sub-...) but no study.json"));
}

TEST_CASE("study folder: a study that was begun with other orders of trials is not gone on with") {
    const TemporaryFolder folder;
    const Protocol protocol = protocol_of(folder);
    open_study(folder / "log", protocol, {false, 0, "palpa 0.5"});
    std::string text = read_text(folder / "log/study.json");
    const auto key = text.find(",\n  \"orders_version\"");
    REQUIRE(key != std::string::npos);
    text.erase(key, text.find('\n', key + 2) - key);
    write_text_atomically(folder / "log/study.json", text);
    CHECK(read_identity(folder / "log")->orders_version == 1);  // it can be analysed
    const std::string message = message_of([&] { open_study(folder / "log", protocol, {false, 0, "palpa 0.6"}); });
    CHECK(contains(message, "study.json: orders_version: found 1, expected 2"));
    CHECK(contains(message, "'palpa 0.5'"));
}

TEST_CASE("study folder: people are added once; a code that stands twice is named; a line cut off is noted, not lost") {
    const TemporaryFolder folder;
    Person first{"01", "31", "F"};
    Person second{"02"};
    add_people(folder.path(), {first, second});
    add_people(folder.path(), {second});
    std::vector<std::string> notes;
    REQUIRE(read_people(folder.path(), notes).size() == 2);
    CHECK(read_people(folder.path(), notes)[0].age == "31");
    append(folder / "participants.tsv", "sub-03\t4");
    CHECK(read_people(folder.path(), notes).size() == 2);
    REQUIRE(notes.size() == 1);
    CHECK(contains(notes[0], "participants.tsv: line 4 is left out: it was cut off after 8 bytes"));
    add_people(folder.path(), {Person{"04"}});
    notes.clear();
    CHECK(read_people(folder.path(), notes).size() == 3);
    CHECK(contains(notes[0], "line 4 is left out"));
    append(folder / "participants.tsv", "sub-01\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\n");
    CHECK(contains(message_of([&] { read_people(folder.path(), notes); }),
                   "line 6, participant_id: found 'sub-01', expected it once: line 2 has the same code"));
}

TEST_CASE("study folder: it goes on at the first trial that is not finished") {
    const TemporaryFolder folder;
    const PlannedParticipant plan = plan_participant(protocol_of(folder), 1);
    REQUIRE(plan.trials.size() == 4);
    CHECK(next_trial(plan, {})->trial == 1);
    write_run(folder.path(), "01", 1, "a", 1, true, "x");
    write_run(folder.path(), "01", 2, "a", 1, false, "x");
    CHECK(finished_trials(folder.path(), "01") == std::set<int>{1});
    CHECK(next_trial(plan, finished_trials(folder.path(), "01"))->trial == 2);
    CHECK_FALSE(next_trial(plan, {1, 2, 3, 4}));
}

TEST_CASE("study folder: a code keeps its place, a new one gets the next") {
    const TemporaryFolder folder;
    const Protocol protocol = protocol_of(folder);
    add_people(folder.path(), {Person{"x7"}, Person{"b2"}});
    const StudyProgress second = progress_of(folder.path(), protocol, "b2");
    CHECK(second.known);
    CHECK(second.plan.number == 2);
    CHECK(second.next->trial == 1);
    const StudyProgress fresh = progress_of(folder.path(), protocol, "new");
    CHECK_FALSE(fresh.known);
    CHECK(fresh.plan.number == 3);
    for (int trial = 1; trial <= 4; ++trial) write_run(folder.path(), "x7", trial, "a", 1, true, "x");
    CHECK_FALSE(progress_of(folder.path(), protocol, "x7").next);
}

TEST_CASE("study folder: instructions hold the study's, the condition's, practice and the limit") {
    const TemporaryFolder folder;
    const Protocol protocol = protocol_of(folder);
    const PlannedParticipant plan = plan_participant(protocol, 1);
    const std::string practice = instructions_for(protocol, plan.trials[0]);
    CHECK(contains(practice, "Find them."));
    CHECK(contains(practice, "Press."));
    CHECK(contains(practice, "This is practice"));
    CHECK(contains(instructions_for(protocol, plan.trials[1]), "You have 60 seconds."));
}

TEST_CASE("read logs: nodules, pairs, times; interrupted trials and cut lines are noted") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = protocol_of(folder);
    open_study(log, protocol, {});
    enter(log, {"01", "02", "03"});
    for (const char* code : {"01", "02", "03"}) {
        write_run(log, code, 2, "a", 1, true, protocol.sha256);
        write_run(log, code, 4, "b", 2, true, protocol.sha256);
    }
    const std::string cut = write_run(log, "03", 4, "b", 0, false, protocol.sha256);
    append(cut, "12.5\tn/a\tma");
    const Observations seen = read_study(log);
    CHECK(seen.participants.size() == 3);
    CHECK(seen.interrupted_trials == 1);
    REQUIRE(seen.notes.size() == 1);
    CHECK(contains(seen.notes[0], "run-03_events.tsv: line 3 is left out: it was cut off after 11 bytes"));
    const Report report = make_report(seen, {});
    CHECK(report.conditions[0].tp == 3);
    CHECK(report.conditions[0].fn == 3);
    REQUIRE(report.pairs.size() == 1);
    CHECK(report.pairs[0].paired->n() == 6);
    CHECK(report.pairs[0].paired->only_b == 3);
    CHECK(report.conditions[1].path_m->median == close_to(0.9));
    CHECK(report.trials == 6);
}

TEST_CASE(
    "read logs: two versions in one folder, disagreeing files and double trials are refused, a clock set back is "
    "noted") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = protocol_of(folder);
    open_study(log, protocol, {});
    CHECK(contains(message_of([&] { read_study(log); }), "found no trial"));
    enter(log, {"01", "02"});
    write_run(log, "01", 2, "a", 1, true, protocol.sha256, "2026-11-21T10:00:00Z");
    write_run(log, "01", 4, "b", 1, true, protocol.sha256, "2026-11-21T09:00:00Z");
    const Observations seen = read_study(log);
    REQUIRE(seen.notes.size() == 1);
    CHECK(contains(seen.notes[0], "the clock was set back"));
    {
        const TemporaryFolder other;
        fs::copy(log, other / "log", fs::copy_options::recursive);
        const std::string events = write_run(other / "log", "01", 2, "a", 1, true, protocol.sha256);
        CHECK(contains(message_of([&] { read_study(other / "log"); }), "found 2 finished a second time"));
    }
    {
        const TemporaryFolder other;
        fs::copy(log, other / "log", fs::copy_options::recursive);
        fs::remove(other / "log/sub-01/beh/sub-01_task-palpation_run-01_marks.tsv");
        CHECK(contains(message_of([&] { read_study(other / "log"); }), "expected 0 of 2 as the marks"));
    }
    write_run(log, "02", 2, "a", 1, true, std::string(64, '0'));
    CHECK(contains(message_of([&] { read_study(log); }), "two versions of a protocol in one folder"));
}

TEST_CASE("read logs: settings that are JSON but not a log's are refused by their key") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = protocol_of(folder);
    open_study(log, protocol, {});
    enter(log, {"01"});
    write_run(log, "01", 2, "a", 1, true, protocol.sha256);
    const fs::path settings = log / "sub-01/beh/sub-01_task-palpation_run-01_settings.json";
    for (const auto& [text, said] :
         {std::pair{"[]", "found an array of 0, expected an object"},
          std::pair{R"({"study": 3})", "study: found 3, expected an object"},
          std::pair{R"({"study": {"sha256": 3}})", "study.sha256: found 3, expected a text"},
          std::pair{R"({"study": {"simulated": "no"}})", "study.simulated: found 'no', expected true or false"},
          std::pair{R"({"nodules": {"A": 1}})", "nodules: found an object, expected an array of objects"},
          std::pair{R"({"nodules": ["A"]})", "nodules[0]: found 'A', expected an object"},
          std::pair{R"({"nodules": [{}]})", "nodules[0].id: found nothing, expected a text"}}) {
        write_text_atomically(settings, text);
        CHECK(contains(message_of([&] { read_study(log); }), said));
    }
}

TEST_CASE("read logs: a count or an amount that cannot be is refused with its line, before statistics meet it") {
    const auto refused = [](const std::string& column, const std::string& value) {
        const TemporaryFolder folder;
        const std::string events = write_run(folder.path(), "01", 1, "a", 1, true, "x");
        const std::string text = read_text(events);
        const auto names = fields_of(std::string_view(text).substr(0, text.find('\n')), '\t');
        const auto at = static_cast<std::size_t>(std::find(names.begin(), names.end(), column) - names.begin());
        const auto last = text.rfind('\n', text.size() - 2) + 1;
        std::string row;
        const auto fields = fields_of(std::string_view(text).substr(last, text.size() - 1 - last), '\t');
        for (std::size_t i = 0; i < fields.size(); ++i)
            row += (i > 0 ? "\t" : "") + (i == at ? value : std::string(fields[i]));
        write_text_atomically(events, text.substr(0, last) + row + "\n");
        const std::string message = message_of([&] { read_study(folder.path()); });
        CAPTURE(message);
        CHECK(contains(message, "run-01_events.tsv: line 4, " + column + ": found '" + value + "', expected "));
    };
    for (const char* column : {"tp", "fp", "fn", "n_nodules"}) {
        for (const char* value : {"-3", "1.5", "nan", "n/a", "1e9", "1e300", "x"}) refused(column, value);
    }
    refused("n_nodules", "3");  // one found and one missed
    for (const char* value : {"0", "-1", "1e9", "n/a"}) refused("trial", value);
    for (const char* column : {"duration", "path_mm", "mean_force_N", "max_force_N"}) {
        for (const char* value : {"-5", "inf"}) refused(column, value);
    }
}

TEST_CASE("read logs: a time that goes back within a trial is noted with its line") {
    const TemporaryFolder folder;
    const std::string events = write_run(folder.path(), "01", 1, "a", 1, true, "x");
    std::string text = read_text(events);
    const auto first = text.find("\n0\t");
    text.replace(first, 3, "\n50\t");
    write_text_atomically(events, text);
    std::vector<std::string> notes;
    CHECK(read_run(events, notes).finished);
    REQUIRE(notes.size() == 1);
    CHECK(contains(notes[0], "line 3: found the time 10 s after 50 s: the clock went back"));
}

TEST_CASE("choice log: every answer is on the disk, read back and told from finished trials") {
    const TemporaryFolder folder;
    {
        ChoiceLog log(next_run(folder.path(), "01", "softer"));
        ChoiceRow row;
        row.condition = "with";
        row.reference_kPa = 1.75;
        row.comparison_kPa = 2.25;
        row.correct = 1;
        REQUIRE(log.write(row));
        row.trial = 2;
        row.answer = "comparison";
        row.correct = 0;
        REQUIRE(log.write(row));
        CHECK(finished_trials(folder.path(), "01") == std::set<int>{1, 2});
    }
    const Observations seen = read_study(folder.path());
    REQUIRE(seen.choices.size() == 2);
    CHECK(seen.comparisons == std::vector<std::string>{"2.25 kPa"});
}

TEST_CASE("read logs: practice and interrupted trials alone make a report that says so") {
    const TemporaryFolder folder;
    const std::string events = write_run(folder.path(), "01", 1, "a", 1, true, "x");
    std::string text = read_text(events);
    for (auto at = text.find("\ttest\t"); at != std::string::npos; at = text.find("\ttest\t"))
        text.replace(at, 6, "\tpractice\t");
    write_text_atomically(events, text);
    const Observations seen = read_study(folder.path());
    CHECK(seen.practice_trials == 1);
    CHECK(contains(report_markdown(make_report(seen, {})),
                   "0 participants, 0 finished tests, 1 practice trial (not in the tables), 0 interrupted trials"));
}
