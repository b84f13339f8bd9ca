// What a study's folder must not hold: each fault is put into a folder that is right, and is refused or named.

#include <cstdio>
#include <doctest/doctest.h>
#include <filesystem>
#include <functional>

#include "files/text.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "study/stard.h"
#include "study/study_folder.h"
#include "study/trial_log.h"
#include "study/withdrawal.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

constexpr const char* kStem01 = "sub-01/beh/sub-01_task-palpation_run-01";

Protocol protocol_in(const fs::path& file, const std::string& rest) {
    write_text_atomically(file, R"({"name": "n", "version": "1", "seed": 5, "order": "fixed",
        "conditions": [{"id": "a", "modality": "shape-display", "scene": "s.json"},
                       {"id": "b", "modality": "shape-display", "scene": "s.json"}])" +
                                    rest + "}");
    return read_protocol(file);
}

// A trial as the program logs it: one nodule of two is found, and one mark is on none.
void write_trial(const fs::path& log, const std::string& code, const Protocol& protocol, const PlannedTrial& trial,
                 double duration_s, bool finished = true) {
    const RunFiles files = next_run(log, code);
    write_text_atomically(files.file("_settings.json"),
                          R"({"nodules": [{"id": "A", "diameter_mm": 10}, {"id": "B"}], "study": {"sha256": ")" +
                              protocol.sha256 + "\"}}");
    TrialLog out(files, {false, false});
    EventRow row;
    row.trial = trial.trial;
    row.trial_type = "start";
    row.block = trial.practice ? "practice" : "test";
    row.condition = protocol.conditions[trial.condition].id;
    row.seed = trial.seed;
    row.n_nodules = 2;
    out.write(row);
    row.trial_type = "mark";
    for (const double x_mm : {40.0, 80.0, 81.0}) {
        row.x_mm = row.y_mm = x_mm;
        out.write(row);
    }
    row.trial_type = "undo";
    row.x_mm = row.y_mm = EventRow::kMissing;
    out.write(row);
    MarkRow mark;
    mark.trial = trial.trial;
    mark.nodule = "A";
    mark.distance_mm = 2.0;
    mark.hit = 1;
    out.write(mark);
    mark.mark = 2;
    mark.distance_mm = 30.0;
    mark.hit = 0;
    out.write(mark);
    if (!finished) return;
    row.trial_type = "finish";
    row.onset_s = row.duration_s = duration_s;
    row.true_positives = row.false_negatives = row.false_positives = 1;
    out.write(row);
}

// Two people who have finished both trials.
Protocol find_study(const fs::path& log) {
    const Protocol protocol = protocol_in(log.parent_path() / "p.json", "");
    open_study(log, protocol, {});
    for (const int number : {1, 2}) {
        const std::string code = "0" + std::to_string(number);
        add_people(log, {Person{code, "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
        for (const PlannedTrial& trial : plan_participant(protocol, number).trials)
            write_trial(log, code, protocol, trial, 30.0 + number);
    }
    return protocol;
}

void write_choices(const fs::path& log, const std::string& code, const Protocol& protocol, int number) {
    ChoiceLog out(next_run(log, code, "softer"));
    for (const PlannedTrial& trial : plan_participant(protocol, number).trials) {
        ChoiceRow row;
        row.trial = trial.trial;
        row.condition = protocol.conditions[trial.condition].id;
        row.seed = trial.seed;
        row.reference_kPa = protocol.choice.reference_kPa;
        row.comparison_kPa = protocol.choice.comparisons_kPa[static_cast<std::size_t>(trial.comparison)];
        row.first = trial.reference_first ? "reference" : "comparison";
        row.correct = trial.trial % 3 != 0 ? 1 : 0;
        const bool reference = (row.correct == 1) == (row.reference_kPa < row.comparison_kPa);
        row.answer = reference ? "reference" : "comparison";
        out.write(row);
    }
}

Protocol choice_study(const fs::path& log) {
    const Protocol protocol =
        protocol_in(log.parent_path() / "p.json", R"(, "choice": {"reference_kPa": 2, "comparisons_kPa": [1, 3, 4]})");
    open_study(log, protocol, {});
    for (const int number : {1, 2}) {
        const std::string code = "0" + std::to_string(number);
        add_people(log, {Person{code, "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
        write_choices(log, code, protocol, number);
    }
    return protocol;
}

// Replaces the first `from` in a file, after the first `after`.
void forge(const fs::path& file, const std::string& from, const std::string& to, const std::string& after = "") {
    std::string text = read_text(file);
    const auto at = text.find(from, text.find(after));
    REQUIRE(at != std::string::npos);
    write_text_atomically(file, text.replace(at, from.size(), to));
}

// Replaces a field of the last row of a table.
void forge_last(const fs::path& file, const std::string& column, const std::string& value) {
    const std::string text = read_text(file);
    const auto names = fields_of(std::string_view(text).substr(0, text.find('\n')), '\t');
    const auto last = text.rfind('\n', text.size() - 2) + 1;
    const auto fields = fields_of(std::string_view(text).substr(last, text.size() - 1 - last), '\t');
    std::string row;
    for (std::size_t i = 0; i < fields.size(); ++i)
        row += (i > 0 ? "\t" : "") + (names[i] == column ? value : std::string(fields[i]));
    write_text_atomically(file, text.substr(0, last) + row + "\n");
}

void repeat_last_row(const fs::path& file) {
    const std::string text = read_text(file);
    write_text_atomically(file, text + text.substr(text.rfind('\n', text.size() - 2) + 1));
}

// What is said about a folder of finds with this fault: the refusal, or all notes of the report.
std::string said_of(Protocol (*study)(const fs::path&), const std::function<void(const fs::path&)>& spoil) {
    const TemporaryFolder folder;
    study(folder / "log");
    CHECK(read_study(folder / "log").notes.empty());
    spoil(folder / "log");
    std::string said;
    const std::string refusal = message_of([&] {
        for (const std::string& note : read_study(folder / "log").notes) said += note + "\n";
    });
    return refusal.empty() ? said : "refused: " + refusal;
}

#define REFUSED(study, words, ...)                                                          \
    do {                                                                                    \
        const std::string said = said_of(study, [&](const fs::path& log) { __VA_ARGS__; }); \
        CAPTURE(said);                                                                      \
        CHECK(said.rfind("refused: ", 0) == 0);                                             \
        CHECK(contains(said, words));                                                       \
    } while (false)
#define NAMED(study, words, ...)                                                            \
    do {                                                                                    \
        const std::string said = said_of(study, [&](const fs::path& log) { __VA_ARGS__; }); \
        CAPTURE(said);                                                                      \
        CHECK(contains(said, words));                                                       \
    } while (false)

}  // namespace

TEST_CASE("read logs: a copied folder of a participant is no person") {
    REFUSED(find_study, "a file that is no log of this participant",
            fs::copy(log / "sub-01", log / "sub-03", fs::copy_options::recursive));
    REFUSED(find_study, "participants.tsv", {
        fs::create_directories(log / "sub-03/beh");
        for (const auto& entry : fs::directory_iterator(log / "sub-01/beh")) {
            std::string name = entry.path().filename().string();
            fs::copy(entry.path(), log / "sub-03/beh" / name.replace(0, 6, "sub-03"));
        }
    });
    NAMED(find_study, "same bytes", {
        fs::create_directories(log / "sub-03/beh");
        for (const auto& entry : fs::directory_iterator(log / "sub-01/beh")) {
            std::string name = entry.path().filename().string();
            fs::copy(entry.path(), log / "sub-03/beh" / name.replace(0, 6, "sub-03"));
        }
        add_people(log, {Person{"03", "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
    });
}

TEST_CASE(
    "read logs: stray files and folders named sub-... are refused, other strays in a participant's folder named") {
    REFUSED(find_study, "sub-notes.txt", write_text_atomically(log / "sub-notes.txt", "x"));
    REFUSED(find_study, "sub-01 (copy)", fs::create_directories(log / "sub-01 (copy)"));
    REFUSED(find_study, "sub-NA", fs::create_directories(log / "sub-NA"));
    REFUSED(find_study, "run-01_events (1).tsv",
            fs::copy(log / (std::string(kStem01) + "_events.tsv"), log / (std::string(kStem01) + "_events (1).tsv")));
    NAMED(find_study, "notes.txt", write_text_atomically(log / "sub-01/beh/notes.txt", "x"));
}

TEST_CASE("read logs: a run or a choice that is there twice is refused") {
    REFUSED(choice_study, "finished a second time",
            repeat_last_row(log / "sub-01/beh/sub-01_task-softer_run-01_events.tsv"));
    REFUSED(choice_study, "finished a second time",
            fs::copy(log / "sub-01/beh/sub-01_task-softer_run-01_events.tsv",
                     log / "sub-01/beh/sub-01_task-softer_run-02_events.tsv"));
    REFUSED(find_study, "finished a second time",
            for (const char* suffix
                 : {"_events.tsv", "_marks.tsv", "_settings.json"})
                fs::copy(log / (std::string(kStem01) + suffix),
                         log / (std::string("sub-01/beh/sub-01_task-palpation_run-07") + suffix)));
    REFUSED(find_study, "second row finish", repeat_last_row(log / (std::string(kStem01) + "_events.tsv")));
}

TEST_CASE("read logs: answers and false marks that the log itself contradicts are refused") {
    const std::string softer = "sub-01/beh/sub-01_task-softer_run-01_events.tsv";
    REFUSED(choice_study, "correct", forge_last(log / softer, "correct", "1"));
    REFUSED(choice_study, "answer", forge_last(log / softer, "answer", "both"));
    REFUSED(choice_study, "comparison_kPa", forge_last(log / softer, "comparison_kPa", "3.5"));
    REFUSED(choice_study, "reference_on: found 'a', expected n/a as in the protocol",
            forge_last(log / softer, "reference_on", "a"));
    REFUSED(choice_study, "reference_kPa", forge_last(log / softer, "reference_kPa", "2.5"));
    const std::string events = std::string(kStem01) + "_events.tsv", marks = std::string(kStem01) + "_marks.tsv";
    REFUSED(find_study, "fp", forge_last(log / events, "fp", "50"));
    REFUSED(find_study, "fp", forge_last(log / events, "fp", "0"));
    REFUSED(find_study, "fp", forge_last(log / events, "fp", "-2"));
    REFUSED(find_study, "2 marks", forge_last(log / marks, "hit", "0"); repeat_last_row(log / marks);
            forge_last(log / events, "fp", "2"));
}

TEST_CASE("read logs: conditions and blocks that the protocol does not know are refused") {
    const std::string events = std::string(kStem01) + "_events.tsv";
    REFUSED(find_study, "found 'c'", forge_last(log / events, "condition", "c");
            forge(log / events, "\ta\t", "\tc\t", "start"); forge(log / events, "\ta\t", "\tc\t");
            forge(log / events, "\ta\t", "\tc\t"); forge(log / events, "\ta\t", "\tc\t");
            forge(log / events, "\ta\t", "\tc\t"));
    REFUSED(find_study, "block: found 'warmup'", forge_last(log / events, "block", "warmup"));
    REFUSED(choice_study, "found 'c'",
            forge_last(log / "sub-01/beh/sub-01_task-softer_run-01_events.tsv", "condition", "c"));
    REFUSED(choice_study, "block: found 'n/a'",
            forge_last(log / "sub-01/beh/sub-01_task-softer_run-01_events.tsv", "block", "n/a"));
    REFUSED(choice_study, "trial: found 99",
            forge_last(log / "sub-01/beh/sub-01_task-softer_run-01_events.tsv", "trial", "99"));
    NAMED(find_study, "the plan", {
        for (const char* run : {"01", "02"}) {
            const fs::path file = log / ("sub-01/beh/sub-01_task-palpation_run-" + std::string(run) + "_events.tsv");
            const bool first = std::string(run) == "01";
            for (int row = 0; row < 6; ++row)
                forge(file, first ? "\ta\t" : "\tb\t", first ? "\tx\t" : "\ty\t", "onset");
            for (int row = 0; row < 6; ++row)
                forge(file, first ? "\tx\t" : "\ty\t", first ? "\tb\t" : "\ta\t", "onset");
        }
    });
}

TEST_CASE("read logs: a trial that was finished without a touch is named") {
    const TemporaryFolder folder;
    const fs::path log = folder / "log";
    const Protocol protocol = protocol_in(folder / "p.json", "");
    open_study(log, protocol, {});
    add_people(log, {Person{"01", "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
    for (const PlannedTrial& trial : plan_participant(protocol, 1).trials) {
        const RunFiles files = next_run(log, "01");
        write_text_atomically(files.file("_settings.json"),
                              R"({"nodules": [{"id": "A"}], "study": {"sha256": ")" + protocol.sha256 + "\"}}");
        TrialLog out(files, {false, false});
        EventRow row;
        row.trial = trial.trial;
        row.trial_type = "start";
        row.block = "test";
        row.condition = protocol.conditions[trial.condition].id;
        row.seed = trial.seed;
        row.n_nodules = 1;
        out.write(row);
        row.trial_type = "finish";
        row.onset_s = row.duration_s = 20.0;
        row.true_positives = row.false_positives = 0.0;
        row.false_negatives = 1.0;
        row.path_mm = row.mean_force_N = 0.0;
        row.max_force_N = trial.trial == 1 ? 0.0 : 0.7;
        out.write(row);
    }
    const std::vector<std::string> notes = read_study(log).notes;
    REQUIRE(notes.size() == 1);
    CHECK(contains(notes.front(), "run-01_events.tsv: was finished without a touch; its nodules count as missed"));
}

TEST_CASE("read logs: another protocol's trials are refused, also without study.json, and those of no protocol") {
    const std::string settings = std::string(kStem01) + "_settings.json";
    REFUSED(find_study, "two versions of a protocol", fs::remove(log / "study.json");
            forge(log / settings, R"("sha256": ")", R"("sha256": "0)"));
    REFUSED(find_study, "study", forge(log / settings, R"("study")", R"("other")"));
    REFUSED(find_study, "protocol.json", forge(log / "protocol.json", "fixed", "latin"));
    NAMED(find_study, "protocol.json", fs::remove(log / "protocol.json"));
}

TEST_CASE("read logs: a participant's line that cannot be read is named") {
    REFUSED(find_study, "line 3 is left out: it was cut off after", {
        const std::string people = read_text(log / "participants.tsv");
        write_text_atomically(log / "participants.tsv", people.substr(0, people.size() - 1));
    });
    REFUSED(find_study, "line 2 is left out: '\"sub-01\"", forge(log / "participants.tsv", "sub-01", "\"sub-01\""));
}

TEST_CASE("read logs: a missing study.json is named") {
    NAMED(find_study, "study.json: is not there", fs::remove(log / "study.json"));
    NAMED(choice_study, "study.json: is not there", fs::remove(log / "study.json"));
}

TEST_CASE("read logs: answers and trials that belong to somebody else are named by their seeds") {
    NAMED(choice_study, "sub-01: trial 12 has the seed 12 in the log",
          forge_last(log / "sub-01/beh/sub-01_task-softer_run-01_events.tsv", "seed", "12"));
    NAMED(find_study, "sub-01: trial 1 has the seed 12 in the log",
          forge_last(log / (std::string(kStem01) + "_events.tsv"), "seed", "12"));
}

TEST_CASE("read logs: nodules that a trial's condition does not have are named, names that are none refused") {
    const std::string settings = std::string(kStem01) + "_settings.json";
    NAMED(find_study, "the nodules are A, C, but A, B in",
          { forge(log / "sub-02/beh/sub-02_task-palpation_run-01_settings.json", R"("id": "B")", R"("id": "C")"); });
    REFUSED(find_study, "found 'NA', expected a name", forge(log / settings, R"("id": "B")", R"("id": "NA")"));
    REFUSED(find_study, "found 'A' a second time", forge(log / settings, R"("id": "B")", R"("id": "A")"));
}

TEST_CASE("read logs: logs of a protocol whose files are both gone are told") {
    NAMED(find_study, "study.json and protocol.json are not there", fs::remove(log / "study.json");
          fs::remove(log / "protocol.json"));
}

TEST_CASE("read logs: a group that is not the plan's is refused, where there is one group, too") {
    REFUSED(find_study, "participants.tsv: sub-01, group: found 'II', expected 'all'",
            forge(log / "participants.tsv", "\tall\n", "\tII\n"));
    const auto two_groups = [](const fs::path& log) {
        const Protocol protocol = protocol_in(log.parent_path() / "p.json", R"(, "groups": [
            {"id": "I", "conditions": ["a", "b"]}, {"id": "II", "conditions": ["b", "a"]}])");
        open_study(log, protocol, {});
        for (const int number : {1, 2}) {
            const std::string code = "0" + std::to_string(number);
            add_people(log, {Person{code, "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", number == 1 ? "I" : "II"}});
            for (const PlannedTrial& trial : plan_participant(protocol, number).trials)
                write_trial(log, code, protocol, trial, 30.0 + number);
        }
        return protocol;
    };
    for (const char* group : {"II", "III", "n/a"}) {
        CAPTURE(group);
        REFUSED(two_groups, "participants.tsv: sub-01, group: found",
                forge(log / "participants.tsv", "\tI\n", "\t" + std::string(group) + "\n"));
    }
}

TEST_CASE("read logs: tests of a participant who withdrew the data are told apart from excluded ones") {
    const TemporaryFolder folder;
    const Protocol protocol = find_study(folder / "log");
    withdraw(folder / "log", "01", Withdrawal::takes_data);
    const Report report = make_report(read_study(folder / "log"), {});
    CHECK(report.excluded_trials == 2);
    CHECK(report.withdrawn_trials == 2);
    const std::string text = report_markdown(report);
    CHECK(contains(text, "2 finished tests are left out because their participants withdrew the data"));
    CHECK_FALSE(contains(text, "by the experimenter's decision"));
    CHECK(contains(text, "1 more participant has logs, but no test in the tables"));
    const std::string others = std::to_string(report.participants), all = std::to_string(report.participants + 1);
    const std::string form = stard_checklist(report, &protocol);
    CHECK(contains(form, all + " took part, " + others + " are analysed (1 withdrew their data, 0 left out"));
    CHECK(contains(form, "and 2 left out (2 of them withdrawn)"));
}

TEST_CASE("read logs: the report counts finished tests of all tasks") {
    const TemporaryFolder folder;
    choice_study(folder / "log");
    const Report report = make_report(read_study(folder / "log"), {});
    CHECK(report.forced_choices == 24);
    CHECK(contains(report_markdown(report), "2 participants, 24 finished tests, 0 practice trials"));
}

TEST_CASE("read logs: a replaced participant is not counted among those whose tests are in the tables") {
    const TemporaryFolder folder;
    find_study(folder / "log");
    add_replacement(folder / "log", {"01", "03", "felt unwell"});
    const Report report = make_report(read_study(folder / "log"), {});
    CHECK(report.participants == 1);
    const std::string text = report_markdown(report);
    CHECK(contains(text, "1 participant, 2 finished tests"));
    CHECK(contains(text, "1 more participant has logs, but no test in the tables"));
}

TEST_CASE("read logs: who left at the page of consent has no planned tests") {
    const TemporaryFolder folder;
    find_study(folder / "log");
    const auto planned = [&] {
        int sum = 0;
        for (const Progress& row : read_study(folder / "log").progress) sum += row.planned;
        return sum;
    };
    CHECK(planned() == 4);
    fs::create_directories(folder / "log/sub-03");
    write_text_atomically(folder / "log/sub-03/now.json", "{}");  // this person answered no question
    CHECK(planned() == 4);
    add_people(folder / "log", {Person{"03", "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
    CHECK(planned() == 6);
}
