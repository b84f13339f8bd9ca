// A soft device beside the app on a real X server, with its simulated plant: a pen presses, the device renders the tissue,
// F12 stops it on whatever screen is open, and a study drives it. Run it under tests/platform/xorg/with-xorg.

#include <doctest/doctest.h>
#include <string>

#include "files/json.h"
#include "files/text.h"
#include "tests/e2e/run_app.h"
#include "tests/e2e/script.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

#ifdef __SANITIZE_ADDRESS__  // a step of the strip takes two periods of the loop there
constexpr const char* kFidelity = R"(, "fidelity": "linear")";
#else
constexpr const char* kFidelity = "";
#endif

// The strip renders 0.25 N/mm; the plant is its own model, in the program.
std::string soft_scene(const TemporaryFolder& folder, const std::string& plant = R"(, "plant": "exact")") {
    Json strip = read_json(PALPA_SOURCE_DIR "/assets/devices/strip.json");
    strip["mesh"]["box"]["elements"] = {50, 2, 2};  // half as many cells across, so that it opens soon
    write_text_atomically(folder / "small-strip.json", strip.dump());
    write_text_atomically(
        folder / "soft.json",
        R"({"name": "soft", "tissue": {"force_curve": {"stiffness_N_per_mm": 0.25, "greatest_depth_mm": 10}},
        "profile": "s-pen.json", "mapping": {"kind": "direct"},
        "tangible": {"device": "small-strip.json", "at_mm": "touch", "force_scale": 0.25)" +
            plant + kFidelity + "}}");
    return (folder / "soft.json").string();
}

std::string soft_study(const TemporaryFolder& folder) {
    soft_scene(folder);
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "soft", "modality": "tangible", "scene": "soft.json"}],
        "choice": {"reference_kPa": 10, "comparisons_kPa": [20], "repeats": 2}})");
    return "study run " + (folder / "p.json").string() + " --log " + (folder / "log").string() +
           " --participant 01 --json --screenshot " + (folder / "p.png").string();
}

}  // namespace

TEST_CASE("tangible: a pen's press on the plant is rendered, and the report says how well") {
    const TemporaryFolder folder;
    Script script(folder / "script.tsv");
    script.t_s = 15.0;  // the pretension is found first
    script.press(3.0);
    script.key(kG);  // the screen of the soft device
    script.out.close();
    const std::string arguments = soft_scene(folder) + " --quit-after-s 32 --log " + (folder / "log").string() +
                                  " --screenshot " + (folder / "p.png").string();
    REQUIRE(run_app(folder, arguments, [&] { CHECK(play_script(folder) == 0); }) == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["overflow"] == "");
    CHECK(result["problems"].empty());
    REQUIRE(result.contains("tangible"));
    const Json& soft = result["tangible"];
    MESSAGE("tangible ", soft.dump());
    CHECK(soft["ticks"].get<double>() > 100);
    CHECK(soft["faults"].empty());
    CHECK(std::filesystem::file_size(folder / "log/sub-01/beh/sub-01_task-palpation_run-01_tangible.tsv") > 1000);
}

TEST_CASE("stopped: F12 on another screen relaxes the soft device, and nothing moves until Release") {
    const TemporaryFolder folder;
    Script script(folder / "script.tsv");
    script.t_s = 2.0;
    script.key(kZ);  // another screen
    script.key(kF12);
    script.key(kEscape);  // back to the trial
    script.press(2.0);
    script.key(kG);
    script.out.close();
    const std::string arguments = soft_scene(folder) + " --quit-after-s 11 --screenshot " + (folder / "p.png").string();
    REQUIRE(run_app(folder, arguments, [&] { CHECK(play_script(folder) == 0); }) == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["overflow"] == "");
    REQUIRE(result.contains("tangible"));
    MESSAGE("tangible ", result["tangible"].dump());
    CHECK_FALSE(result["tangible"]["faults"].empty());
    CHECK(result["max_force_N"].get<double>() > 0.5);  // the pen pressed
}

TEST_CASE("driven: a study's surfaces are on the soft device, and the settings name it as simulated") {
    const TemporaryFolder folder;
    const std::string stem = (folder / "log/sub-01/beh/sub-01_task-interval_run-0").string();
    Script script(folder / "script.tsv");
    script.t_s = 1.0;
    script.key(kEnter);                  // begin
    script.wait(stem + "1_events.tsv");  // the device is at its pretension
    script.t_s += 0.5;
    script.key(kF);  // not yet: nothing was touched
    script.press(1.0);
    script.key(kF);  // the first surface
    script.wait(stem + "2_events.tsv");
    script.t_s += 0.5;
    script.press(1.0);
    script.key(kF);  // the second one
    script.wait(stem + "2_performance.json");
    script.t_s += 0.5;
    script.key(k1);  // was softer
    script.wait(stem + "3_events.tsv");
    script.t_s += 1.0;
    script.key(kF12);  // in the middle of the next pair
    script.out.close();
    REQUIRE(run_study_to("device", folder, soft_study(folder)) == 0);  // the step says that F12 stopped it
    const Json result = read_json(folder / "out.json");
    CHECK(result["overflow"] == "");
    CHECK(result["finished"] == 1);
    CHECK(read_json(folder / "log/sub-01/now.json")["step"] == "device");
    for (const char* run : {"1", "2"}) {
        const Json devices = read_json(stem + run + "_settings.json")["study"]["devices"];
        CAPTURE(devices.dump());
        REQUIRE_FALSE(devices.empty());
        for (const Json& device : devices) CHECK(device["simulated"] == true);
        CHECK(std::filesystem::file_size(stem + run + "_tangible.tsv") > 1000);
    }
    CHECK(read_text(stem + "3_events.tsv").find("device_gone") != std::string::npos);
}

TEST_CASE("ports: a trial whose soft device is not there does not begin, and its screen names what is missing") {
    const TemporaryFolder folder;
    const std::string study = soft_study(folder);
    soft_scene(folder, "");  // real ports
    Script script(folder / "script.tsv");
    script.t_s = 1.0;
    script.key(kEnter);
    script.t_s += 1.0;
    script.key(kEnter);  // Start is not offered
    script.out.close();
    REQUIRE(run_program(folder, study + " --quit-after-s 9", folder / "log/sub-01/now.json",
                        [&] { CHECK(play_script(folder) == 0); }) == 0);
    CHECK(read_json(folder / "out.json")["finished"] == 0);
    CHECK(read_json(folder / "log/sub-01/now.json")["step"] == "device");
}
