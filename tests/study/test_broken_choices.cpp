#include <doctest/doctest.h>

#include "files/text.h"
#include "study/broken_choices.h"
#include "study/read_logs.h"
#include "study/report.h"
#include "study/run_log.h"
#include "study/study_folder.h"
#include "study/trial_log.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

// One surface, as the program logs it. A person who is killed in its middle leaves no row finish.
void feel(const fs::path& log, int trial, int interval, bool finished, const std::string& condition = "a") {
    const RunFiles files = next_run(log, "01", "interval");
    write_text_atomically(files.file("_settings.json"), R"({"study": {"interval": )" + std::to_string(interval) + "}}");
    TrialLog out(files, {false, false});
    EventRow row;
    row.trial = trial;
    row.trial_type = "start";
    row.block = "test";
    row.condition = condition;
    out.write(row);
    if (!finished) return;
    row.trial_type = "finish";
    row.onset_s = row.duration_s = 5.0;
    row.true_positives = row.false_negatives = row.false_positives = 0.0;
    out.write(row);
}

std::size_t broken(const fs::path& log, const std::set<int>& answered) {
    std::vector<std::string> notes;
    const auto all = broken_choices(log / "sub-01", answered, notes);
    CHECK(notes.empty());
    return all.size();
}

// The reference stays under "b", so that half of the runs are of "b" while all choices are of "a".
Protocol choice_protocol(const fs::path& file) {
    write_text_atomically(file, R"({"name": "n", "version": "1", "seed": 5, "order": "fixed",
        "choice": {"reference_kPa": 2, "comparisons_kPa": [1, 3], "reference_on": "b"},
        "conditions": [{"id": "a", "modality": "pen", "scene": "s.json"},
                       {"id": "b", "modality": "pen", "scene": "s.json"}]})");
    return read_protocol(file);
}

}  // namespace

TEST_CASE("broken choices: a pair that was felt and answered is none") {
    const TemporaryFolder folder;
    feel(folder.path(), 1, 1, true);
    feel(folder.path(), 1, 2, true);
    CHECK(broken(folder.path(), {1}) == 0);
    CHECK(broken(folder.path(), {}) == 1);  // killed while the question was on the screen
}

TEST_CASE("broken choices: a kill in an interval, between the intervals and before the answer") {
    const TemporaryFolder folder;
    feel(folder.path(), 3, 1, false);  // killed in the first
    feel(folder.path(), 3, 1, true);   // and between both
    feel(folder.path(), 3, 1, true);
    feel(folder.path(), 3, 2, true);  // and before the answer
    feel(folder.path(), 3, 1, true);
    feel(folder.path(), 3, 2, false);  // and in the second
    feel(folder.path(), 3, 1, true);
    feel(folder.path(), 3, 2, true);
    CHECK(broken(folder.path(), {3}) == 4);
    CHECK(broken(folder.path(), {}) == 5);
}

TEST_CASE("broken choices: a device that goes in the second interval interrupts once, and the interval comes again") {
    const TemporaryFolder folder;
    feel(folder.path(), 2, 1, true);
    feel(folder.path(), 2, 2, false);
    feel(folder.path(), 2, 2, true);
    CHECK(broken(folder.path(), {2}) == 1);
}

TEST_CASE("broken choices: a run that was killed before its first row, and damaged settings") {
    const TemporaryFolder folder;
    write_text_atomically(next_run(folder.path(), "01", "interval").file("_events.tsv"), "");
    feel(folder.path(), 1, 1, true);
    feel(folder.path(), 1, 2, true);
    const auto files = interval_files(folder / "sub-01");
    REQUIRE(files.size() == 3);
    write_text_atomically(fs::path(files[2]).replace_filename("sub-01_task-interval_run-03_settings.json"), "{");
    std::vector<std::string> notes;
    CHECK(broken_choices(folder / "sub-01", {1}, notes).size() == 1);
    REQUIRE(notes.size() == 1);  // the empty file is no line that was cut off
    CHECK(contains(notes[0], "of a surface of a forced choice"));
}

TEST_CASE("broken choices: the report and the plan count a kill in an interval as an interrupted trial") {
    const TemporaryFolder folder;
    const Protocol protocol = choice_protocol(folder / "p.json");
    open_study(folder / "log", protocol, {});
    add_people(folder / "log", {Person{"01", "n/a", "n/a", "n/a", "n/a", "n/a", "n/a", "all"}});
    const auto plan = plan_participant(protocol, 1);
    int trial = 1;
    while (plan.trials[static_cast<std::size_t>(trial) - 1].condition != 0) ++trial;
    feel(folder / "log", trial, 1, false, "b");
    const Observations seen = read_study(folder / "log");
    CHECK(seen.notes.empty());
    CHECK(seen.interrupted_trials == 1);
    for (const Progress& row : seen.progress) CHECK(row.interrupted == (row.condition == "a" ? 1 : 0));
    CHECK(contains(report_markdown(make_report(seen, {})), "1 interrupted trial"));
    feel(folder / "log", 77, 1, false, "a");
    CHECK(contains(message_of([&] { read_study(folder / "log"); }), "trial: found 77"));
}
