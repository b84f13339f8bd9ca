// palpa study as a person calls it.

#include <cmath>
#include <cstdlib>
#include <doctest/doctest.h>
#include <filesystem>
#include <sys/wait.h>

#include "files/folder_lock.h"
#include "files/json.h"
#include "files/text.h"
#include "tests/app/commands/study_command.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

}  // namespace

TEST_CASE("command study: help exists for every command") {
    for (const char* command : {"", "analyse", "exclude", "import", "levels", "observers", "order", "power",
                                "preregister", "replace", "run", "simulate", "watch"}) {
        CAPTURE(command);
        const Called help = study(std::string(command) + " --help");
        CHECK(help.status == 0);
        CHECK(help.out.size() > 100);
    }
}

TEST_CASE("command study watch: who is where, what to present, the marks and the last sample of the trial that runs") {
    const TemporaryFolder folder;
    const auto text = [&](const std::string& name, const std::string& content) {
        std::filesystem::create_directories((folder / name).parent_path());
        write_text_atomically(folder / name, content);
    };
    text(
        "study.json",
        R"({"protocol": "n", "version": "1", "sha256": "x", "simulated": false, "simulation_seed": 0, "program": "p"})");
    text("participants.tsv",
         "participant_id\tage\tsex\thandedness\tvision\tpalpation_experience\tvr_experience\tgroup\n"
         "sub-07\tn/a\tn/a\tn/a\tn/a\tn/a\tn/a\tall\n");
    text(
        "sub-07/now.json",
        R"({"participant": "07", "step": "trial", "finished": 0, "of": 4, "trial": 1, "condition": "pen", "practice": false})");
    const std::string stem = "sub-07/beh/sub-07_task-palpation_run-01_";
    text(stem + "events.tsv",
         "onset\ttrial_type\tblock\ttrial\tcondition\n0\tstart\ttest\t1\tpen\n2\tmark\ttest\t1\tpen\n"
         "3\tmark\ttest\t1\tpen\n4\tundo\ttest\t1\tpen\n5\tma");  // the last line is being written
    text(stem + "samples.tsv", "t_host_s\ttool\tforce_N\n1\tpen\t0.5\n1.1\tpen\t0.75\n1.2\tp");
    text(
        "sub-09/now.json",
        R"({"participant": "09", "step": "trial", "finished": 0, "of": 4, "trial": 1, "condition": "pen", "practice": false})");
    text("sub-09/beh/sub-09_task-palpation_run-01_events.tsv",
         "onset\ttrial_type\tblock\ttrial\tcondition\n0\tstart\ttest\t1\tpen\n");
    const std::filesystem::path samples = "sub-09/beh/sub-09_task-palpation_run-01_samples.tsv";
    const std::string header = "t_host_s\ttool\tx_mm\ty_mm\tpressure\tforce_N\tdepth_mm\n";
    const std::string asked = "3\tmouse\tn/a\tn/a\tn/a\tn/a\tn/a\n";  // a resize, a mark
    text(samples.string(), header + asked);
    const Called untouched = study("watch " + folder.path().string() + " --participant 09");
    CHECK(contains(untouched.out, "0 marks, the tissue was not touched in the last seconds\n"));
    text(samples.string(), header + "1\tpen\t30.000012345\t40\t0.5\t2\t3\n" + asked + asked);
    const Called touched = study("watch " + folder.path().string() + " --participant 09");
    CHECK(contains(touched.out, "pen at (30, 40) mm, pressure 0.5, 2 N, 3 mm deep\n"));
    for (const auto& [now, said] :
         {std::pair{R"({"step": 3, "finished": 0, "of": 4})", "sub-09/now.json: step: found 3, expected a text"},
          std::pair{R"({"step": "trial", "finished": -1, "of": 4})", "sub-09/now.json: finished: found -1"},
          std::pair{R"({"step": "present", "finished": 0, "of": 4, "present_kPa": []})",
                    "sub-09/now.json: present_kPa"}}) {
        text("sub-09/now.json", now);
        const Called others = study("watch " + folder.path().string());  // goes on showing them
        CHECK(others.status == 0);
        CHECK(contains(others.out, said));
        CHECK(contains(others.out, "07 "));
    }
    text("sub-09/now.json", R"({"step": "trial", "finished": 0, "of": 4, "trial": 1, "condition": "pen"})");
    const Called no_practice = study("watch " + folder.path().string());
    CHECK(no_practice.status == 0);
    CHECK(contains(no_practice.out, "0 of 4  trial, trial 1, pen\n"));
    std::filesystem::remove_all(folder / "sub-09");
    text("sub-08/now.json",
         R"({"participant": "08", "step": "present", "finished": 3, "of": 4, "trial": 4, "condition": "by hand",
                                "practice": false, "present_kPa": [1.75, 2], "interval": 1})");
    const Called called = study("watch " + folder.path().string() + " --json");
    REQUIRE(called.status == 0);
    const Json people = parse_json(called.out, "stdout")["people"];
    REQUIRE(people.size() == 2);
    CHECK(people[0]["events"]["marks"] == 1);
    CHECK(people[0]["sample"]["force_N"] == "0.75");
    CHECK(people[1]["now"]["present_kPa"][1] == 2);
    const Called words = study("watch " + folder.path().string() + " --participant 08");
    CHECK(contains(words.out, "first 1.75 kPa, second 2 kPa; now interval 1"));
    // a surface of a forced choice has a run of its own; the trial before it is over
    text("sub-08/beh/sub-08_task-palpation_run-01_events.tsv",
         "onset\ttrial_type\tblock\ttrial\tcondition\n0\tstart\ttest\t3\tc\n1\tmark\ttest\t3\tc\n"
         "2\tmark\ttest\t3\tc\n");
    text("sub-08/beh/sub-08_task-interval_run-01_events.tsv",
         "onset\ttrial_type\tblock\ttrial\tcondition\n0\tstart\ttest\t4\tc\n");
    text("sub-08/beh/sub-08_task-interval_run-01_samples.tsv", header + "1\tpen\t30\t40\t0.5\t2\t3\n");
    text("sub-08/now.json", R"({"participant": "08", "step": "trial", "finished": 3, "of": 4, "trial": 4,
                               "condition": "c", "practice": false, "present_kPa": [1.75, 2], "interval": 1})");
    const Called felt = study("watch " + folder.path().string() + " --participant 08");
    CAPTURE(felt.out);
    CAPTURE(felt.err);
    CHECK(contains(felt.out, "0 marks"));
    CHECK(contains(felt.out, "pen at (30, 40) mm"));
    CHECK_FALSE(contains(words.out, "07"));
    CHECK_FALSE(contains(words.out, "withdrew"));
    CHECK(study("withdraw " + folder.path().string() + " --participant 07 --data leave-out").status == 0);
    const Called withdrawn = study("watch " + folder.path().string() + " --participant 07");
    CHECK(contains(withdrawn.out, "0 of 4  trial, trial 1, pen, withdrew, data left out\n"));
    refused("watch " + folder.path().string() + " --participant 09", "--participant: found '09'");
    refused("watch " + (folder / "sub-07").string(), "no study.json");
}

TEST_CASE(
    "command study watch: a step in which the program was closed is not said to go on, and marks are none at least") {
    const TemporaryFolder folder;
    const auto text = [&](const std::string& name, const std::string& content) {
        std::filesystem::create_directories((folder / name).parent_path());
        write_text_atomically(folder / name, content);
    };
    text(
        "study.json",
        R"({"protocol": "n", "version": "1", "sha256": "x", "simulated": false, "simulation_seed": 0, "program": "p"})");
    const auto now = [&](const std::string& locked) {
        text("sub-07/now.json", R"({"participant": "07", "step": "trial", "finished": 0, "of": 4, "trial": 1,
                                    "condition": "pen", "practice": false)" +
                                    locked + "}");
    };
    text("sub-07/beh/sub-07_task-palpation_run-01_events.tsv",
         "onset\ttrial_type\tblock\ttrial\tcondition\n0\tstart\ttest\t1\tpen\n1\tundo\ttest\t1\tpen\n"
         "2\tundo\ttest\t1\tpen\n3\tmark\ttest\t1\tpen\n4\tundo\ttest\t1\tpen\n");
    const std::string closed = "! nobody is at this step now: the study was closed, or went on with somebody else\n";
    const auto look = [&] { return study("watch " + folder.path().string()).out; };
    now("");  // written by a program that knew no locks
    CHECK_FALSE(contains(look(), closed));
    CHECK(contains(look(), " 0 marks"));
    now(R"(, "locked": true)");
    {
        const FolderLock runs(folder / "sub-07");
        CHECK_FALSE(contains(look(), closed));
    }
    CHECK(contains(look(), closed));
    CHECK(parse_json(study("watch --json " + folder.path().string()).out, "stdout")["people"][0]["running"] == false);
}

TEST_CASE("command study: a shipped protocol is found by its name") {
    const Called named = study("order effects --participants 2");
    CHECK(named.status == 0);
    CHECK(named.out == study("order " PALPA_SOURCE_DIR "/assets/protocols/effects.json --participants 2").out);
    refused("order effect --participants 2", "effect: ");
}

TEST_CASE("command study order: who gets what, with seeds and balance") {
    const std::string protocol = PALPA_SOURCE_DIR "/assets/protocols/";
    const Called called = study("order " + protocol + "paper.json --participants 40 --json");
    REQUIRE(called.status == 0);
    const Json json = parse_json(called.out, "stdout");
    REQUIRE(json["participants"].size() == 40);
    CHECK(json["seed"] == 2014);
    CHECK(json["sha256"].get<std::string>().size() == 64);
    CHECK(json["participants"][0]["group"] == "I");
    CHECK(json["participants"][0]["trials"].size() == 4);
    CHECK(json["participants"][1]["trials"].size() == 6);
    CHECK(json["participants"][1]["trials"][0]["block"] == "practice");
    CHECK(json["imbalance"].size() == 2);
    CHECK(study("order " + protocol + "paper.json --participants 40 --json").out == called.out);
    const Called people = study("order " + protocol + "effects.json --participants 7");
    CHECK(contains(people.out, "a multiple of 6 people would balance the positions"));
    CHECK(contains(people.out, "-- break --"));
    CHECK(contains(study("order " + protocol + "softer.json --participants 1").out, "kPa, reference first"));
}

TEST_CASE("command study: a protocol that names a missing scene, map or profile is refused with its condition") {
    const TemporaryFolder folder;
    const auto with_scene = [&](const std::string& scene, const std::string& more = "") {
        write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
            "conditions": [{"id": "pen", "modality": "pen", "scene": ")" +
                                                     scene + "\"" + more + "}]}");
        return "order " + (folder / "p.json").string() + " --participants 1";
    };
    write_text_atomically(folder / "s.json", R"({"name": "s", "tissue": {"map": "none.map"}})");
    refused(with_scene("none.json"), "p.json: conditions[0] 'pen': ");
    refused(with_scene("none.json"), "none.json: cannot be read");
    refused(with_scene("s.json"), "none.map");
    refused(with_scene("default.json", R"(, "profile": "none.json")"), "profiles/none.json: cannot be read");
    refused("order " + (folder / "q.json").string() + " --participants 1", "q.json: cannot be read");
    refused("order " PALPA_SOURCE_DIR "/assets/protocols/paper.json --participants 0", "--participants");
}

TEST_CASE(
    "command study simulate: simulated people find more with the laws than without, and their logs say what they are") {
    const TemporaryFolder folder;
    const std::string effects = PALPA_SOURCE_DIR "/assets/protocols/effects.json";
    const std::string log = (folder / "log").string();
    const std::string call = "simulate " + effects + " --participants 24 --seed 1 -o " + log;
    refused(call + " --practice", "--practice: found");
    const Called called = study(call + " --json");
    REQUIRE(called.status == 0);
    const Json done = parse_json(called.out, "stdout");
    CHECK(done["trials"] == 72);
    CHECK(done["samples"].get<int>() > 72 * 3500);
    const std::string stem = log + "/sub-sim0001/beh/sub-sim0001_task-palpation_run-01";
    CHECK(read_json(stem + "_settings.json")["study"]["simulated"] == true);
    CHECK(read_json(stem + "_settings.json")["study"]["map_sha256"]["normal_N.npy"].get<std::string>().size() == 64);
    CHECK(read_json(log + "/study.json")["simulated"] == true);
    CHECK(contains(read_text(stem + "_samples.tsv"), "\tpen\tmove\t"));
    CHECK(contains(read_text(log + "/.bidsignore"), "study.json"));

    const Called again = study(call + " --json");
    CHECK(parse_json(again.out, "stdout")["trials"] == 0);
    CHECK(parse_json(again.out, "stdout")["already_there"] == 72);

    const Called analysed = study("analyse " + log + " --json");
    REQUIRE(analysed.status == 0);
    const Json report = parse_json(analysed.out, "stdout");
    CHECK(report["simulated"] == true);
    CHECK(report["trials"] == 72);
    int against_off = 0;
    for (const Json& pair : report["pairs"]) {
        if (pair["b"] != "off" && pair["a"] != "off") continue;
        CHECK(pair["higher"] != "off");
        CHECK(pair["replication"]["significant"] == true);
        CHECK(pair["p_holm"].get<double>() < 0.05);
        CHECK(pair["p_permutation"].get<double>() < 0.05);
        CHECK(pair["ignores_clustering"]["n"] == 72);
        CHECK(pair["participants_in_both"] == 24);
        ++against_off;
    }
    CHECK(against_off == 2);
    const Json& ratio = report["conditions"]["display ratio"];
    CHECK(ratio["ppv"].get<double>() > 0.8);
    CHECK(ratio["nodules"]["A"]["se"].get<double>() > ratio["nodules"]["C"]["se"].get<double>());
    CHECK(ratio["time_s"]["n"] == 24);
    CHECK(ratio["path_mm"]["mean"].get<double>() > 1000.0);
    CHECK(ratio["mean_force_N"]["mean"].get<double>() > 1.0);

    // --samples none leaves out samples and changes nothing else; so does the number of jobs
    const std::string lean = (folder / "lean").string();
    REQUIRE(study("simulate " + effects + " --participants 24 --seed 1 --samples none -j 1 -o " + lean).status == 0);
    CHECK_FALSE(std::filesystem::exists(lean + "/sub-sim0001/beh/sub-sim0001_task-palpation_run-01_samples.tsv"));
    CHECK(parse_json(study("analyse " + lean + " --json").out, "stdout")["conditions"] == report["conditions"]);

    refused("simulate " + effects + " --participants 24 --seed 2 -o " + log,
            "seed 1, expected simulated participants of seed 2");
    refused("simulate " PALPA_SOURCE_DIR "/assets/protocols/paper.json --participants 2 --seed 1 -o " + log,
            "two versions of a protocol");
    refused("analyse " + folder.path().string(), "found no trial");
}

TEST_CASE("command study simulate: two at once do not share a folder") {
    const TemporaryFolder folder;
    const std::string call =
        "simulate " PALPA_SOURCE_DIR "/assets/protocols/softer.json --participants 1 -o " + folder.path().string();
    {
        const FolderLock other(folder.path(), "");
        refused(call, "found another palpa that writes into this folder, expected a folder of its own for each");
    }
    CHECK(study(call).status == 0);
}

TEST_CASE("command study simulate: the paper's protocol leaves hands out; forced choices are logged and analysed") {
    const TemporaryFolder folder;
    const std::string protocols = PALPA_SOURCE_DIR "/assets/protocols/";
    const Called paper =
        study("simulate " + protocols + "paper.json --participants 4 -o " + (folder / "p").string() + " --json");
    REQUIRE(paper.status == 0);
    CHECK(parse_json(paper.out, "stdout")["trials"] == 6);
    CHECK(parse_json(paper.out, "stdout")["left_out"] == 4);
    const Json report = parse_json(study("analyse " + (folder / "p").string() + " --json").out, "stdout");
    CHECK(report["conditions"].size() == 3);
    CHECK(report["conditions"].contains("Bare finger"));

    REQUIRE(study("simulate " + protocols + "softer.json --participants 6 -o " + (folder / "c").string()).status == 0);
    const Json choices = parse_json(study("analyse " + (folder / "c").string() + " --json").out, "stdout");
    CHECK(choices["choices"].size() == 12);
    CHECK(choices["choices"][0]["n"] == 240);
    CHECK(choices["choices"][0]["t_over_participants"]["df"] == 5.0);
    const Json again = parse_json(
        study("simulate " + protocols + "softer.json --participants 6 -o " + (folder / "c").string() + " --json").out,
        "stdout");
    CHECK(again["trials"] == 0);
    CHECK(again["already_there"] == 480);
}

TEST_CASE(
    "command study simulate: who feels arm and pins tells by the pins what is stiffer; the reference stays on them") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "slab.json", R"({"size_mm": [40, 40, 20], "nodules": [],
        "tissue": {"young_Pa": 17500, "poisson": 0.45}, "indenter": {"shape": "sphere", "radius_mm": 8, "contact": "rolling"},
        "depths_mm": [1], "grid": {"origin_mm": [0, 0], "spacing_mm": [1, 1], "count": [2, 2]}})");
    const auto scene = [&](const char* name, const char* schedule) {
        write_text_atomically(
            folder / name,
            std::string(R"({"name": "slab", "tissue": {"linear": {"phantom": "slab.json", "spacing_mm": 4}},
            "tactile": {"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json", "schedule": ")") +
                schedule + R"("}, "leads": "arm"}})");
    };
    scene("pins-scene.json", "lead");
    scene("arm-scene.json", "locked");
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 3, "order": "fixed",
        "conditions": [{"id": "pins", "modality": "shape-display", "scene": "pins-scene.json"},
                       {"id": "arm", "modality": "shape-display", "scene": "arm-scene.json"}],
        "choice": {"reference_kPa": 17.5, "comparisons_kPa": [9, 12.5, 15, 20, 25, 34], "repeats": 6, "reference_on": "pins"}})");
    const std::string log = (folder / "log").string();
    REQUIRE(study("simulate " + (folder / "p.json").string() + " --participants 6 --seed 2 -o " + log).status == 0);
    const std::string rows = read_text(log + "/sub-sim0001/beh/sub-sim0001_task-softer_run-01_events.tsv");
    CHECK(contains(rows, "reference_on"));
    CHECK(contains(rows, "\tpins\t"));
    const Json report = parse_json(study("analyse " + log + " --json").out, "stdout");
    const auto all_of = [&](const char* condition) {
        for (const Json& curve : report["psychometric"]) {
            if (curve["condition"] == condition && curve["participant"].is_null()) return curve;
        }
        return Json();
    };
    const Json pins = all_of("pins"), arm = all_of("arm");
    CHECK(pins["axis"] == "comparison/reference");
    REQUIRE(pins["jnd_percent"].is_number());
    CHECK(pins["jnd_percent"].get<double>() < 60.0);
    CHECK(pins["jnd_percent_ci"][1].is_number());
    CHECK(std::abs(pins["pse"].get<double>()) < 0.15);  // pins against pins
    const bool flat = arm["sd"].is_null();
    CHECK((flat || arm["sd"].get<double>() > 1.5 * pins["sd"].get<double>()));
}

TEST_CASE("command study: staircases are ordered, simulated, gone on with and analysed; who withdraws is left out") {
    const TemporaryFolder folder;
    const std::string protocol = PALPA_SOURCE_DIR "/assets/protocols/threshold.json ";
    const Json order = parse_json(study("order " + protocol + "--participants 4 --json").out, "stdout");
    CHECK(order["trial_order"] == "interleaved");
    CHECK(parse_json(study("order " PALPA_SOURCE_DIR "/assets/protocols/softer.json --participants 1 --json").out,
                     "stdout")["trial_order"] == "interleaved");
    CHECK(order["imbalance"][0]["carry_over"].get<int>() <= 4);
    CHECK(order["participants"][0]["trials"].size() == 84);
    CHECK(order["participants"][0]["trials"][0]["comparison_kPa"] == 10.0);  // practice
    CHECK(order["participants"][0]["trials"][4]["comparison_kPa"].is_null());
    CHECK(contains(study("order " + protocol + "--participants 1").out, "level by the answers, reference"));

    const std::string log = (folder / "log").string();
    REQUIRE(study("simulate " + protocol + "--participants 3 -o " + log).status == 0);
    const Json report = parse_json(study("analyse " + log + " --json").out, "stdout");
    REQUIRE(report["staircases"].size() == 6);
    for (const Json& one : report["staircases"]) {
        CHECK(one["method"] == "quest-plus");
        CHECK(one["trials"] == 40);
        CHECK(one["threshold_percent"].is_null());
        // simulated eyes have sd 0.28 of ln, a JND of 21 %
        CHECK(one["jnd_percent"].get<double>() > 8.0);
        CHECK(one["jnd_percent"].get<double>() < 50.0);
    }
    CHECK_FALSE(report.contains("choices"));

    refused("withdraw " + log + " --participant 9 --data keep", "--participant: found '9', expected a code that is in");
    refused("withdraw " + folder.path().string() + " --participant 9 --data keep", "found no study.json");
    refused("withdraw " + log + " --participant sim0002 --data burn", "--data");
    // somebody who stopped at the first questions
    std::filesystem::create_directories(std::filesystem::path(log) / "sub-10");
    CHECK(study("withdraw " + log + " --participant 10 --data leave-out").status == 0);
    CHECK(study("withdraw " + log + " --participant sim0002 --data leave-out").status == 0);
    refused("withdraw " + log + " --participant sim0002 --data keep", "who has withdrawn the data");
    const Json left = parse_json(study("analyse " + log + " --json").out, "stdout");
    CHECK(left["staircases"].size() == 4);
    CHECK(left["participants"] == 2);
    CHECK(contains(left["notes"].dump(), "sub-sim0002: withdrew from the study; the data are left out"));
}

TEST_CASE("command study: finding, choices and a staircase, interleaved in one session, are analysed side by side") {
    const TemporaryFolder folder;
    const std::string scene = PALPA_SOURCE_DIR "/assets/scenes/default.json";
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 8, "order": "latin",
        "trial_order": "interleaved", "practice": {"trials": 1}, "repeats": 4, "conditions": [
            {"id": "find", "modality": "pen", "task": "find", "scene": ")" +
                                                 scene +
                                                 R"("},
            {"id": "pairs", "modality": "pen", "task": "choice", "scene": ")" +
                                                 scene +
                                                 R"("},
            {"id": "steps", "modality": "pen", "task": "staircase", "scene": ")" +
                                                 scene +
                                                 R"("}],
        "choice": {"reference_kPa": 20, "comparisons_kPa": [14, 28], "repeats": 3},
        "staircase": {"method": "weighted-up-down", "reference_kPa": 20, "comparisons_kPa": [22, 25, 28, 32], "trials": 6}})");
    const std::string protocol = (folder / "p.json").string(), log = (folder / "log").string();
    REQUIRE(study("simulate " + protocol + " --participants 4 -o " + log).status == 0);
    const Json report = parse_json(study("analyse " + log + " --json").out, "stdout");
    CHECK(report["participants"] == 4);
    CHECK(report["trials"] == 16);
    REQUIRE(report["plan"].size() == 12);
    for (const Json& one : report["plan"]) {
        CHECK(one["planned"] == (one["condition"] == "find" ? 4 : 6));
        CHECK(one["finished"] == one["planned"]);
    }
    REQUIRE(report["choices"].size() >= 1);
    for (const Json& one : report["choices"]) CHECK(one["condition"] == "pairs");
    CHECK(report["staircases"].size() == 4);
    CHECK_FALSE(contains(report["notes"].dump(), "in the plan"));
    CHECK_FALSE(contains(report["notes"].dump(), "staircase"));

    // Logs of a version with other orders are counted, not compared trial by trial.
    Json identity = read_json(folder / "log/study.json");
    identity["orders_version"] = 1;
    write_text_atomically(folder / "log/study.json", json_text(identity));
    const Json older = parse_json(study("analyse " + log + " --json").out, "stdout");
    CHECK(older["plan"] == report["plan"]);
    CHECK(contains(older["notes"].dump(), "began with another version's orders"));
}

TEST_CASE("command study simulate: a disk that is full or cannot be written stops the study with a message") {
    const TemporaryFolder folder;
    {
        // no file may grow beyond 64 KB, as on a disk that is nearly full: samples do not fit, so no trial is finished
        const TemporaryFolder said;
        const std::string log = (folder / "log").string();
        const std::string command = "trap '' XFSZ; ulimit -f 128; timeout 60 " PALPA_PROGRAM
                                    " study simulate " PALPA_SOURCE_DIR
                                    "/assets/protocols/effects.json --participants 3 -j 1 -o " +
                                    log + " 2>" + (said / "err").string();
        const int status = std::system(command.c_str());
        CHECK(WEXITSTATUS(status) == 1);
        CHECK(contains(read_text(said / "err"),
                       "could not be written to its end (is the disk full?); the study has stopped"));
        const std::string events = read_text(log + "/sub-sim0001/beh/sub-sim0001_task-palpation_run-01_events.tsv");
        CHECK_FALSE(contains(events, "finish"));
        CHECK_FALSE(std::filesystem::exists(log + "/sub-sim0001/beh/sub-sim0001_task-palpation_run-02_events.tsv"));
        // with room again it goes on
        const Called again =
            study("simulate " PALPA_SOURCE_DIR "/assets/protocols/effects.json --participants 3 --json -o " + log);
        CHECK(parse_json(again.out, "stdout")["trials"] == 9);
        CHECK(parse_json(study("analyse " + log + " --json").out, "stdout")["interrupted_trials"] == 1);
    }
    write_text_atomically(folder / "file", "x");
    const std::string effects = PALPA_SOURCE_DIR "/assets/protocols/effects.json";
    const Called called = study("simulate " + effects + " --participants 1 -o " + (folder / "file").string());
    CHECK(called.status == 2);
    CHECK(contains(called.err, "expected a folder"));
}

TEST_CASE("command study: one program at a time writes into a whole folder; single runs stay out of it") {
    const TemporaryFolder folder;
    const std::string log = (folder / "log").string();
    const std::string softer = PALPA_SOURCE_DIR "/assets/protocols/softer.json";
    const std::string simulate = "simulate " + softer + " --participants 1 -o " + log;
    REQUIRE(study(simulate).status == 0);
    {
        const FolderLock lock(log);
        refused(simulate, "found another palpa that writes into this folder");
        // which several screens may do at once: it says only that real people never join simulated ones
        const Called run = study("run " + softer + " --log " + log);
        CHECK(run.status == 2);
        CHECK_FALSE(contains(run.err, "another palpa"));
        refused("exclude " + log + " --participant sim0001 --reason x",
                "found another palpa that writes into this folder");
        CHECK(study("analyse " + log + " --json").status == 0);  // which only reads
        CHECK(study("watch " + log + " --once").status == 0);
    }
    {
        const FolderLock screen(log + "/sub-sim0001");
        CHECK(study("exclude " + log + " --participant sim0001 --reason x").status == 0);
    }
    CHECK(study(simulate).status == 0);
    const Called run = shell("timeout 60 " PALPA_PROGRAM " run --headless --replay " PALPA_SOURCE_DIR
                             "/assets/traces/raster.tsv --log " +
                             log);
    CHECK(run.status == 2);
    CHECK(contains(run.err, "found the folder of a study (study.json)"));
    const Called serve = shell("timeout 60 " PALPA_PROGRAM " serve --port 0 --collect " + log);
    CHECK(serve.status == 2);
    CHECK(contains(serve.err, "found the folder of a study (study.json), expected a folder of its own"));
}

TEST_CASE("command study exclude, replace: decisions are written, reported and refused where they cannot be") {
    const TemporaryFolder folder;
    const std::string log = (folder / "log").string();
    REQUIRE(
        study("simulate " PALPA_SOURCE_DIR "/assets/protocols/effects.json --participants 3 --samples none -o " + log)
            .status == 0);
    CHECK(study("exclude " + log + " --participant sub-sim0001 --trial 2 --reason 'fire alarm'").status == 0);
    CHECK(study("replace " + log + " --participant sim0002 --by sub-x1 --reason 'left'").status == 0);
    refused("exclude " + log + " --participant sim0001 --trial 2 --reason again", "already, because 'fire alarm'");
    refused("exclude " + log + " --participant sim0009 --reason x", "--participant: found 'sim0009'");
    refused("replace " + log + " --participant sim0001 --by sim0003 --reason x", "--by: found 'sim0003'");
    refused("exclude " + folder.path().string() + " --participant sim0001 --reason x", "no study.json");
    refused("exclude " + (folder / "none").string() + " --participant sim0001 --reason x", "found no folder");
    const Called analysed = study("analyse " + log + " --json -o " + (folder / "report").string());
    REQUIRE(analysed.status == 0);
    const Json json = parse_json(analysed.out, "stdout");
    CHECK(json["trials"] == 5);
    CHECK(json["excluded_trials"] == 4);
    CHECK(json["plan"].size() == 9);
    CHECK(json["exclusions"][0]["reason"] == "fire alarm");
    CHECK(json["replacements"][0]["replaced_by"] == "x1");
    CHECK(contains(read_text(folder / "report/plan_participants.tsv"), "sim0001\tall\t"));
    CHECK(contains(read_text(folder / "report/exclusions.tsv"), "sim0002\tall\tdropped out, replaced by x1: left"));
    // into the study's own folder the report's table of exclusions would replace the experimenter's
    const std::string decided = read_text(folder / "log/exclusions.tsv");
    for (const std::string& into : {log, log + "/.", log + "/sub-sim0001", log + "/sub-sim0001/beh"})
        refused("analyse " + log + " -o " + into, "a folder of logs");
    CHECK(read_text(folder / "log/exclusions.tsv") == decided);
    CHECK(study("analyse " + log + " -o " + log + "/report").status == 0);
    refused("exclude " + log + " --participant sim0001 --trial 1 --reason ' '", "why, in words");
}

TEST_CASE("command study: a map whose nodules have names that tables cannot hold is refused before anybody begins") {
    const TemporaryFolder folder;
    fs::copy(PALPA_SOURCE_DIR "/assets/maps/silicone.map", folder / "s.map", fs::copy_options::recursive);
    write_text_atomically(folder / "s.json",
                          R"({"name": "s", "tissue": {"map": "s.map"}, "profile": "s-pen.json",
                              "mapping": {"kind": "direct", "tissue_mm": [120, 120]}})");
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "time_limit_s": 1, "conditions": [{"id": "pen", "modality": "pen", "scene": "s.json"}]})");
    const std::string map = read_text(folder / "s.map/map.json");
    for (const char* name : {R"(NA)", R"(a\tb)", R"(B)"}) {
        CAPTURE(name);
        std::string other = map;
        write_text_atomically(folder / "s.map/map.json",
                              other.replace(other.find(R"("A")"), 3, "\"" + std::string(name) + "\""));
        refused("simulate " + (folder / "p.json").string() + " --participants 1 -o " + (folder / "log").string(),
                name == std::string("B") ? "map.json: nodules[1].id: found 'B' twice" : "s.json: nodules: found '");
        CHECK_FALSE(fs::exists(folder / "log/study.json"));
    }
}

TEST_CASE("command study: a map whose nodules the logs could not tell apart is refused before anything is recorded") {
    const TemporaryFolder folder;
    const auto map = folder / "m.map";
    std::filesystem::copy(PALPA_SOURCE_DIR "/assets/maps/silicone.map", map);
    write_text_atomically(folder / "s.json", R"({"name": "s", "tissue": {"map": "m.map"}})");
    write_text_atomically(folder / "p.json", R"({"name": "p", "version": "1", "seed": 1, "order": "williams",
        "conditions": [{"id": "a", "modality": "pen", "scene": "s.json"}], "time_limit_s": 60})");
    const Json whole = parse_json(read_text(map / "map.json"), "map.json");
    const std::string simulate = "simulate " + (folder / "p.json").string() + " --participants 1 --samples none -o " +
                                 (folder / "logs").string();
    for (const std::string id : {"A\tB", "\"A\"", "n/a", "", "B"}) {
        Json json = whole;
        json["nodules"][0]["id"] = id;
        write_text_atomically(map / "map.json", json_text(json));
        refused(simulate, id == "B" ? "nodules[1].id: found 'B' twice" : "nodules: found '");
        CHECK_FALSE(std::filesystem::exists(folder / "logs"));
    }
    write_text_atomically(map / "map.json", json_text(whole));
    CHECK(study(simulate).status == 0);
}

TEST_CASE("command study run: a text that the screens cannot show is refused before anything is recorded") {
    const TemporaryFolder folder;
    const auto run = [&](const std::string& consent) {
        write_text_atomically(folder / "p.json",
                              R"({"name": "n", "version": "1", "seed": 1, "order": "fixed", "consent": ")" + consent +
                                  R"(", "conditions": [{"id": "hand", "modality": "hand"}]})");
        return "run " + (folder / "p.json").string() + " --log " + (folder / "log").string() + " --quit-after-s 0.1";
    };
    refused(run("Do you agree? \u60a8\u540c\u610f\u5417"), "p.json: consent: found '\u60a8', expected");
    refused(run("Do you agree? \u0645\u0648\u0627\u0641\u0642"), "found '\u0645'");
    CHECK_FALSE(std::filesystem::exists(folder / "log"));
}
