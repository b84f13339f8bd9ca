// palpa study analyse, power, levels and preregister as a person calls them.

#include <doctest/doctest.h>
#include <filesystem>

#include "files/json.h"
#include "files/text.h"
#include "tests/app/commands/study_command.h"
#include "tests/close_to.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

namespace fs = std::filesystem;

}  // namespace

TEST_CASE("command study analyse: counts become tables, JSON and figures") {
    const TemporaryFolder folder;
    const Called called = study("analyse " + kCounts + " --json -o " + (folder / "report").string());
    CHECK(called.status == 0);
    const Json json = parse_json(called.out, "stdout");
    CHECK(json["conditions"]["S-pen"]["se"].get<double>() == close_to(55.0 / 60.0));
    CHECK(json == read_json(folder / "report/report.json"));
    for (const char* name : {"sensitivity.tsv", "nodules.tsv", "ppv.tsv", "pairs.tsv", "ppv_pairs.tsv", "report.md",
                             "figures.gp", "sensitivity.json", "pairs.json", "stard.md"}) {
        CAPTURE(name);
        CHECK(std::filesystem::exists(folder / (std::string("report/") + name)));
    }
    if (!has_gnuplot()) {
        MESSAGE("not checked: gnuplot is not installed");
        CHECK(contains(called.err, "gnuplot cannot be started"));
        return;
    }
    CHECK(called.err.empty());
    for (const char* name : {"sensitivity", "nodules", "ppv"}) {
        CAPTURE(name);
        CHECK(read_text(folder / (std::string("report/") + name + ".png")).substr(1, 3) == "PNG");
        CHECK(read_text(folder / (std::string("report/") + name + ".pdf")).substr(0, 4) == "%PDF");
        CHECK(contains(read_text(folder / (std::string("report/") + name + ".svg")), "Touchpad"));
    }
}

TEST_CASE("command study analyse and power: a file of one's own is not replaced, an earlier report is") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "report.md", "mine\n");
    write_text_atomically(folder / "power.md", "mine\n");
    const std::string to_folder = " -o " + folder.path().string();
    const Called report = study("analyse " + kCounts + to_folder);
    CHECK(report.status == 2);
    CHECK(contains(report.err, "report.md: found a file that is no earlier result"));
    const Called power =
        study("power " PALPA_SOURCE_DIR "/assets/protocols/softer.json --participants 2 --runs 2" + to_folder);
    CHECK(power.status == 2);
    CHECK(contains(power.err, "power.md: found a file that is no earlier result"));
    CHECK(read_text(folder / "report.md") == "mine\n");
    CHECK(read_text(folder / "power.md") == "mine\n");
    CHECK_FALSE(fs::exists(folder / "report.json"));
    fs::remove(folder / "report.md");
    for (int i = 0; i < 2; ++i) CHECK(study("analyse " + kCounts + to_folder).status == 0);
}

TEST_CASE("command study analyse: figures name conditions and nodules as the tables do, whatever stands in the names") {
    if (!has_gnuplot()) return;
    const TemporaryFolder folder;
    std::string rows = "condition\ttp\tfn\tfp\tnodule\n";
    for (const std::string condition : {"it's 10% gel", "a_b", "{q} \\n^2"})
        rows += condition + "\t5\t5\t1\tA\n" + condition + "\t2\t8\t0\tA'\n";
    write_text_atomically(folder / "odd.tsv", rows);
    const Called called = study("analyse " + (folder / "odd.tsv").string() + " -o " + (folder / "report").string());
    CAPTURE(called.err);
    CHECK(called.status == 0);
    for (const char* name : {"nodules.svg", "sensitivity.svg", "ppv.svg"}) {
        const std::string figure = read_text(folder / "report" / name);
        CAPTURE(name);
        CHECK(contains(figure, "10% gel"));
        CHECK(contains(figure, ">a_b<"));
        CHECK(contains(figure, "{q} \\n^2"));
    }
    CHECK(contains(read_text(folder / "report/figures.gp"), "nodule_of[6] = [1, 2, 1, 2, 1, 2]"));
}

TEST_CASE("command study analyse: a table of rated marks gives figures of merit, the mixed model and its data") {
    const TemporaryFolder folder;
    std::string rows = "condition\tparticipant\tcase\tkind\tlesion\trating\n";
    for (int condition = 0; condition < 2; ++condition) {
        for (int person = 0; person < 4; ++person) {
            const std::string who = std::string(condition == 0 ? "a" : "b") + "\tp" + std::to_string(person) + "\t";
            for (int k = 0; k < 4; ++k) {
                const bool found = (person + 2 * k + condition) % 3 != 0;
                rows += who + "with" + std::to_string(k) + "\tlesion\tL\t" +
                        (found ? std::to_string(2 + k % 3) : "n/a") + "\n";
                const bool false_mark = (person + k + condition) % 4 == 0;
                rows += who + "none" + std::to_string(k) + (false_mark ? "\tnl\tn/a\t3\n" : "\tcase\tn/a\tn/a\n");
            }
        }
    }
    write_text_atomically(folder / "marks.tsv", rows);
    const std::string marks = "analyse " + (folder / "marks.tsv").string();
    const Called called = study(marks + " --rating-scale 1 5 --json -o " + (folder / "report").string());
    CAPTURE(called.err);
    REQUIRE(called.status == 0);
    const Json json = parse_json(called.out, "stdout");
    CHECK(json["free_response"]["figures"].size() == 8);
    CHECK(json["free_response"]["tests"].size() == 4);
    CHECK(json["free_response"]["tests"][0]["status"] == "computed");
    CHECK(json["mixed_logistic"]["nodules"] == 4);
    for (const char* name : {"free_response.tsv", "free_response_tests.tsv", "froc.tsv", "froc.gp", "nodules_long.tsv",
                             "nodules_long.json"}) {
        CAPTURE(name);
        CHECK(fs::exists(folder / (std::string("report/") + name)));
    }
    CHECK(fs::exists(folder / "report/mixed_model.R") == (json["mixed_logistic"]["status"] == "computed"));
    CHECK(contains(read_text(folder / "report/report.md"), "0.5 is not chance"));
    // everybody met four nodules, each of them once
    const std::string figures = read_text(folder / "report/figures.gp");
    CHECK(contains(figures, "sensitivity_wilson = \", which ignore clustering\""));
    CHECK(contains(figures, "nodules_wilson = \" over participants\""));
    refused(marks + " --rating-scale 1 2", "a rating from 1 to 2, the scale");
    refused(marks + " --rating-scale 5 1", "the lowest rating, then the highest");
    refused("analyse " PALPA_SOURCE_DIR "/assets/counts/paper.tsv --rating-scale 1 5", "which holds no ratings");
    refused("analyse " PALPA_SOURCE_DIR "/assets/counts/paper.tsv --greatest-lapse 0.1", "no psychometric functions");
    refused("observers --experiments 2 --pse-spread 0.5", "--people");
}

TEST_CASE("command study analyse: confidence outside 1 to 5 in the marks of a log is refused with file and line") {
    const TemporaryFolder folder;
    const std::string log = (folder / "log").string();
    REQUIRE(
        study("simulate " PALPA_SOURCE_DIR "/assets/protocols/effects.json --participants 4 --samples none -o " + log)
            .status == 0);
    std::string edited;
    for (const auto& entry : fs::recursive_directory_iterator(log)) {
        if (!entry.path().string().ends_with("_marks.tsv")) continue;
        std::string text = read_text(entry.path());
        const std::size_t row = text.find('\n') + 1;
        if (row >= text.size()) continue;
        std::size_t begin = row;  // of the sixth column, confidence
        for (int column = 0; column < 5; ++column) begin = text.find('\t', begin) + 1;
        text.replace(begin, text.find('\t', begin) - begin, "7");
        write_text_atomically(entry.path(), text);
        edited = entry.path().filename().string();
        break;
    }
    REQUIRE_FALSE(edited.empty());
    refused("analyse " + log, edited + ": line 2, confidence: found '7', expected");
}

TEST_CASE("command study analyse: bad input ends with status 2 and says what was expected") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "c.tsv", "condition\ttp\tfn\tfp\tn\npen\t61\t0\t0\t60\n");
    refused("analyse " + (folder / "none.tsv").string(),
            "none.tsv: found nothing, expected a folder of logs or a table");
    refused("analyse " + (folder / "c.tsv").string(), "c.tsv: line 2, tp: found '61', expected at most n = 60");
    refused("analyse " + kCounts + " -o " + (folder / "c.tsv").string(), "c.tsv: found no folder");
    refused("analyse " + kCounts + " --level 2", "--level");
}

TEST_CASE(
    "command study power: a table with Monte Carlo errors, parts by the scheduler's variables, and one that merges") {
    const TemporaryFolder folder;
    const std::string effects = PALPA_SOURCE_DIR "/assets/protocols/effects.json";
    const std::string call = "power " + effects + " --participants 3,2 --runs 2 --resamples 100 ";
    const Called alone = study(call + "--json");
    CAPTURE(alone.err);
    REQUIRE(alone.status == 0);
    const Json json = parse_json(alone.out, "stdout");
    CHECK(json["simulated"] == true);
    CHECK(json["reference"] == "display ratio");
    CHECK(json["participants"] == Json({2, 3}));
    CHECK(json["results"][0].contains("type_I_error"));
    bool primary = false;
    for (const Json& one : json["results"]) {
        if (one["method"] != "primary" || one["effect"] != 1.0) continue;
        primary = true;
        CHECK(one["power"]["studies"] == 2);
        CHECK(one["power"]["monte_carlo_ci"].size() == 2);
        CHECK(one["true_value"].is_number());
    }
    CHECK(primary);
    const std::string output = "-o " + (folder / "power").string();
    for (const char* task : {"4", "5"}) {
        const std::string slurm =
            "SLURM_ARRAY_TASK_MIN=4 SLURM_ARRAY_TASK_COUNT=2 SLURM_ARRAY_TASK_ID=" + std::string(task) + " ";
        const Called part = shell(slurm + "timeout 120 " PALPA_PROGRAM " study " + call + output);
        CHECK(part.status == 0);
        CHECK(contains(part.out, "1 studies now"));
    }
    const Called merged = study(call + output + " --merge --json");
    CHECK(merged.status == 0);
    CHECK(parse_json(merged.out, "stdout")["results"] == json["results"]);
    CHECK(contains(read_text(folder / "power/power.md"), "(SIMULATED)"));
    CHECK(read_json(folder / "power/power.json").contains("rejected_se"));
    refused(call + "--reference nobody", "--reference: found 'nobody', expected the id of a condition");
    refused(call + "--merge", "--output: found nothing");
    refused(call + "--part 3/2 " + output, "i/n with 1 <= i <= n");
    refused(call + "--seed 5 " + output, "two power runs never share a folder");
    refused("power " PALPA_SOURCE_DIR "/assets/protocols/threshold.json --participants 3", "found a staircase");
}

TEST_CASE("command study preregister: a sheet with the hashes, and what is not stated on standard error") {
    const TemporaryFolder folder;
    const std::string effects = PALPA_SOURCE_DIR "/assets/protocols/effects.json";
    const Called called = study("preregister " + effects + " --participants 3");
    CHECK(called.status == 0);
    CHECK(contains(called.out, "scene_sha256 "));
    CHECK(contains(called.out, "map_sha256 "));
    CHECK(contains(called.out, "\n| 3 | all |"));
    CHECK(contains(called.err, "not stated: analysis.stopping_rule"));
    CHECK(study("preregister " + effects + " -o " + (folder / "sheet.md").string()).status == 0);
    CHECK(contains(read_text(folder / "sheet.md"), "# Preregistration"));
    refused("preregister " + effects + " -o " + folder.path().string(), "found a folder");
    fs::copy(PALPA_SOURCE_DIR "/assets", folder / "assets", fs::copy_options::recursive);
    const fs::path scene = folder / "assets/scenes/delay.json", protocol = folder / "assets/protocols/effects.json";
    std::string text = read_text(protocol);
    const std::string named = "\"scene\": \"delay.json\"";
    REQUIRE(contains(text, named));
    write_text_atomically(protocol,
                          text.replace(text.find(named), named.size(), "\"scene\": \"../scenes/delay.json\""));
    refused("preregister " + protocol.string() + " -o " + scene.string(), "found the input");
}

TEST_CASE("command study levels: a table of rejections and coverage, theirs labelled") {
    const TemporaryFolder folder;
    const std::string file = (folder / "levels.md").string();
    const Called called = study("levels --people 10 --repeats 2 --slope-sd 1 --studies 10 --resamples 100 -o " + file);
    REQUIRE(called.status == 0);
    CHECK(contains(called.out, "| people, repeats, slope SD | 10, 2, 1 |"));
    CHECK(contains(called.out, "| the paper's interval (replication) |"));
    CHECK(read_text(file) == called.out);
    refused("levels --people 1", "--people");
}

TEST_CASE("command study power: a number that is asked for twice would be counted twice, and is refused") {
    const std::string power = "power " PALPA_SOURCE_DIR "/assets/protocols/effects.json --runs 2 ";
    refused(power + "--participants 8,6,8", "--participants: found 8 twice");
    refused(power + "--participants 8 --effect 0,1,0.0", "--effect: found 0 twice");
    refused(power + "--participants 8 --noise 1,1", "--noise: found 1 twice");
}

TEST_CASE("command study analyse: nothing of an earlier report is left in its folder, and nothing else goes") {
    const TemporaryFolder folder;
    const std::string report = (folder / "report").string();
    write_text_atomically(folder / "choices", "condition\tcorrect\tn\tparticipant\npen\t3\t4\tp\npen\t2\t4\tq\n");
    write_text_atomically(folder / "finds", "condition\ttp\tfn\tfp\npen\t3\t1\t0\n");
    REQUIRE(study("analyse " + (folder / "choices").string() + " -o " + report).status == 0);
    CHECK(fs::exists(folder / "report/choices.tsv"));
    write_text_atomically(folder / "report/thesis.tsv", "mine");
    REQUIRE(study("analyse " + (folder / "finds").string() + " -o " + report).status == 0);
    CHECK_FALSE(fs::exists(folder / "report/choices.tsv"));
    CHECK(fs::exists(folder / "report/sensitivity.tsv"));
    CHECK(fs::exists(folder / "report/thesis.tsv"));
}

TEST_CASE("command study analyse: a folder that cannot be made is named with the reason") {
    const Called called = study("analyse " + kCounts + " -o /proc/no/report");
    CHECK(called.status == 1);
    CHECK(contains(called.err, "/proc/no/report: cannot be made: "));
}
