#include "study/bundle_run.h"

#include <doctest/doctest.h>

#include "files/json.h"
#include "files/sha256.h"
#include "files/text.h"
#include "study/bundle.h"
#include "study/trial_log.h"
#include "tests/temporary_folder.h"

using namespace palpa;
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
