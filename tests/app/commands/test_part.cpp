// `palpa part` as a person calls it.

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <string>

#include "files/json.h"
#include "files/text.h"
#include "tests/app/palpa_with.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

const std::string kParts = PALPA_SOURCE_DIR "/assets/parts/";

// The displacement that a method gives for one of the beams, mm.
double displacement_mm(const Json& json, const char* method) {
    return json["methods"][method]["displacement_mm"].get<double>();
}

}  // namespace

TEST_CASE(
    "part stiffness: the five beams have the displacements of the closed forms and of the same element elsewhere") {
    struct Beam {
        const char* name;
        double euler_mm, timoshenko_mm, voxels_mm;
    };
    for (const Beam& beam :
         {Beam{"homogeneous", 0.481928, 0.485629, 0.4816322}, Beam{"alternating-hshsh", 1.016289, 1.025201, 1.0044452},
          Beam{"alternating-shshs", 1.465639, 1.477156, 1.4321732}, Beam{"sandwich-hsh", 0.495868, 0.506614, 0.5028904},
          Beam{"sandwich-shs", 1.791045, 1.799366, 1.7670337}}) {
        CAPTURE(beam.name);
        const Called called =
            palpa_with("part evaluate " + kParts + "beams/" + beam.name + ".json --tolerance 1e-8 --json");
        REQUIRE_MESSAGE(called.status == 0, called.err);
        const Json json = parse_json(called.out, "stdout");
        CHECK(displacement_mm(json, "euler-bernoulli") == close_to(beam.euler_mm).epsilon(2e-6));
        CHECK(displacement_mm(json, "timoshenko") == close_to(beam.timoshenko_mm).epsilon(2e-6));
        CHECK(displacement_mm(json, "voxels") == close_to(beam.voxels_mm).epsilon(1e-6));
        CHECK(json["methods"]["voxels"]["converged"] == true);
        CHECK(json["methods"]["timoshenko"]["applies"] == true);
        CHECK(json["methods"]["timoshenko"]["error_against"] == "voxels");
    }
}

TEST_CASE("part info: a table for people, and every key in JSON") {
    const std::string file = kParts + "toothbrush-a.json";
    const Called table = palpa_with("part info " + file);
    CHECK_MESSAGE(table.status == 0, table.err);
    for (const char* word : {"Toothbrush a", "voxels of 0.1 mm", "mm3", "of soft"})
        CHECK(test::contains(table.out, word));
    const Json json = parse_json(palpa_with("part info " + file + " --json").out, "stdout");
    for (const char* key : {"voxels", "runs", "memory_bytes", "plain_bytes", "volume_mm3", "mass_g", "centroid_mm",
                            "voxels_of_material", "runs_sha256"}) {
        CAPTURE(key);
        CHECK(json.contains(key));
    }
    CHECK(json["plain_bytes"] == 1900 * 140 * 120);
    CHECK(20 * json["memory_bytes"].get<double>() < json["plain_bytes"].get<double>());
}

TEST_CASE(
    "part button: the truss snaps at the closed form's force, a bare cover not at all, a button goes on and off") {
    const auto button = [](const std::string& name) {
        const Called called = palpa_with("part button " + kParts + name + ".json --json");
        REQUIRE_MESSAGE(called.status == 0, called.err);
        return parse_json(called.out, "stdout");
    };
    const Json truss = button("truss");
    CHECK(std::abs(truss["peak_N"].get<double>() / 0.114218831724 - 1.0) < 1e-10);
    CHECK(std::abs(truss["peak_mm"].get<double>() / 0.8739718643 - 1.0) < 1e-9);
    const Json bare = button("bare-cover");
    CHECK(bare["peak_N"].is_null());
    CHECK(bare["snaps"] == false);
    const Json latch = button("button");
    for (const char* key : {"peak_N", "peak_mm", "trough_N", "snap_ratio", "on_mm", "off_mm", "loss_J"}) {
        CAPTURE(key);
        CHECK(latch[key].get<double>() > 0.0);
    }
    CHECK(latch["off_mm"] < latch["on_mm"]);
    CHECK(latch["curve"]["press_N"].size() == latch["curve"]["travel_mm"].size());
    CHECK(palpa_with("part button " + kParts + "beams/homogeneous.json").status == 2);
}

TEST_CASE("part evaluate: every method has every key, null where it has no such figure") {
    const Json json = parse_json(
        palpa_with("part evaluate " + kParts + "beams/homogeneous.json --tolerance 1e-8 --json").out, "stdout");
    CHECK(json["methods"].size() == 5);
    for (const auto& method : json["methods"].items()) {
        CAPTURE(method.key());
        for (const char* key :
             {"displacement_mm", "stiffness_N_per_m", "applies", "why_not", "error_percent", "error_against", "cells",
              "iterations", "energy_error_percent", "converged", "time_s", "memory_MB"})
            CHECK(method.value().contains(key));
    }
    CHECK(json["methods"]["paper"]["applies"] == false);
    CHECK(json["methods"]["paper"]["why_not"].is_string());
    CHECK(json["methods"]["euler-bernoulli"]["why_not"].is_null());
    CHECK(json["methods"]["paper"]["stiffness_N_per_m"].get<double>() == close_to(13833.33).epsilon(1e-5));
}

TEST_CASE("part scenes: three presses of a button switch it on three times, and two replays log the same") {
    const std::string run = std::string("run ") + PALPA_SOURCE_DIR + "/assets/scenes/button.json --replay " +
                            PALPA_SOURCE_DIR + "/assets/traces/three-presses.tsv --headless --json";
    const TemporaryFolder folder;
    std::string logs[2];
    for (int i = 0; i < 2; ++i) {
        const std::filesystem::path log = folder / std::to_string(i);
        const Called called = palpa_with(run + " --log " + log.string());
        REQUIRE_MESSAGE(called.status == 0, called.err);
        const Json json = parse_json(called.out, "stdout");
        CHECK(json["switch_events"] == 3);
        CHECK(json["max_depth_mm"].get<double>() > 1.0);
        const std::filesystem::path beh = log / "sub-01" / "beh";
        logs[i] = read_text(beh / "sub-01_task-palpation_run-01_samples.tsv");
        const std::string events = read_text(beh / "sub-01_task-palpation_run-01_events.tsv");
        std::size_t switched = 0;
        for (std::size_t at = events.find("switch_on"); at != std::string::npos; at = events.find("switch_on", at + 1))
            ++switched;
        CHECK(switched == 3);
    }
    CHECK(logs[0] == logs[1]);
    CHECK(logs[0].size() > 1000);
}

TEST_CASE("part: wrong usage and wrong parts end with status 2 and a message") {
    const std::string beam = kParts + "beams/homogeneous.json";
    for (const std::string& arguments :
         {std::string("part info nowhere.json"), "part stiffness " + beam + " --load head",
          "part stiffness " + beam + " --method magic", "part stiffness " + beam + " --cell-mm 1.3",
          "part stiffness " + beam + " --tolerance 0", std::string("part")}) {
        CAPTURE(arguments);
        const Called called = palpa_with(arguments);
        CHECK(called.status == 2);
        CHECK_FALSE(called.err.empty());
    }
    CHECK(test::contains(palpa_with("part stiffness " + beam + " --load head").err, "one of tip"));
    CHECK(test::contains(palpa_with("part stiffness " + beam).out, "euler-bernoulli"));
    for (const char* unused : {"--cell-mm 2.5", "--tolerance 1e-9"}) {
        const std::string beams = " --method timoshenko " + std::string(unused);
        for (const std::string& command :
             {"part stiffness " + beam + beams, "part compare " + beam + " " + beam + beams}) {
            CAPTURE(command);
            CHECK(palpa_with(command).status == 2);
            CHECK(test::contains(palpa_with(command).err, "found no --method voxels"));
        }
    }
    const TemporaryFolder folder;
    const std::string part = (folder / "a.svg").string();  // an input is never replaced
    std::filesystem::copy_file(beam, part);
    const Called compared = palpa_with("part compare " + part + " " + beam + " -o " + part);
    CHECK(compared.status == 2);
    CHECK(test::contains(compared.err, "found the input"));
}
