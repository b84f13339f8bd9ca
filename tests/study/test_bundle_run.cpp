#include <doctest/doctest.h>

#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"
#include "study/bundle.h"
#include "study/bundle_run.h"
#include "study/ratings.h"
#include "study/study_folder.h"
#include "study/trial_log.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("bundle of a run: all its files with their hashes, and nothing else") {
    const TemporaryFolder folder;
    const RunFiles run = next_run(folder.path(), "07");
    { TrialLog log(run); }
    write_text_whole(run.file("_settings.json"), "{\"name\": \"gr\u00fcn\t\"}\n");
    write_text_whole(run.folder / (run.stem + "1_events.tsv"), "of run 011\n");
    write_text_whole(run.folder / "note.txt", "of somebody else\n");
    const Json json = Json::parse(bundle_text(run));
    CHECK(json["palpa_bundle"] == 1);
    REQUIRE(json["files"].size() == 5);  // events, marks, what explains them, settings
    for (const Json& file : json["files"]) {
        const std::string name = file["name"];
        CAPTURE(name);
        CHECK(file["text"] == read_text(folder.path() / name));
        CHECK(file["sha256"] == sha256_hex(file["text"].get<std::string>()));
    }
    CHECK(json["files"][0]["name"] == "sub-07/beh/sub-07_task-palpation_run-01_events.json");
    CHECK(read_bundle(bundle_text(run), "x.json").files.size() == 5);  // what the desk makes of it
}

TEST_CASE("bundle of a run: a first run may be asked for, and none is overwritten") {
    const TemporaryFolder folder;
    CHECK(next_run(folder.path(), "07", "palpation", 12).stem == "sub-07_task-palpation_run-12");
    const RunFiles run = next_run(folder.path(), "07", "palpation", 12);
    { TrialLog log(run); }
    CHECK(next_run(folder.path(), "07", "palpation", 12).stem == "sub-07_task-palpation_run-13");
}

TEST_CASE("bundle of a study's run: what the study is, this participant, the answers so far; nobody else") {
    const TemporaryFolder folder;
    const auto log = folder / "log";
    write_text_atomically(
        folder / "p.json",
        R"({"name": "n", "version": "1", "seed": 1, "order": "fixed", "conditions": [{"id": "hand", "modality": "hand"}]})");
    open_study(log, read_protocol(folder / "p.json"), {false, 0, "test"});
    add_people(log, {{"1", "20"}, {"07", "30"}, {"071", "40"}});
    add_ratings(log, "07", {{"hand", "effort", "3"}});
    add_ratings(log, "1", {{"hand", "effort", "5"}});
    const RunFiles run = next_run(log, "07");
    { TrialLog events(run, {true, false}); }
    CHECK(study_of(run) == log);
    CHECK(code_of(run) == "07");
    const Bundle bundle = read_bundle(bundle_text(run), "x.json");
    std::string names;
    for (const BundleFile& file : bundle.files) names += file.name + " ";
    CHECK(names ==
          "sub-07/beh/sub-07_task-palpation_run-01_events.tsv sub-07/beh/sub-07_task-palpation_run-01_marks.tsv "
          "study.json "
          "protocol.json participants.tsv sub-07/beh/sub-07_task-ratings_beh.tsv ");
    std::vector<std::string> notes;
    const auto people = people_in(bundle.files[4].text, "p", notes);
    REQUIRE(people.size() == 1);
    CHECK(people[0].code == "07");
    CHECK(people[0].age == "30");
    CHECK(bundle.files[5].text == "condition\titem\tvalue\nhand\teffort\t3\n");
    CHECK(read_bundle(bundle_of_answers(log, "07"), "x.json").files.size() == 4);
    const RunFiles alone = next_run(folder / "single", "07");
    CHECK(study_of(alone) == "");
}
