// Arm and pins beside the app on a real X server, with their simulators: a pen presses, the devices follow, F12 stops them
// on whatever screen is open, and they stay stopped. Run it under tests/platform/xorg/with-xorg.

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

// The slab's compliance is computed before, so that the window is there soon.
std::string prepared_scene(const TemporaryFolder& folder) {
    const std::string scene = PALPA_SOURCE_DIR "/assets/scenes/tactile.json";
    REQUIRE(shell("HOME=" + folder.path().string() + " timeout 100 " PALPA_PROGRAM " explain " + scene +
                  " >/dev/null") == 0);
    return scene;
}

}  // namespace

TEST_CASE("tactile: a pen's press moves arm and pins, and the report says how well they followed") {
    const TemporaryFolder folder;
    Script script(folder / "script.tsv");
    script.t_s = 3.0;  // the boards are proved first
    script.press(3.0);
    script.key(kT);
    script.out.close();
    const std::string scene = prepared_scene(folder);
    const std::string arguments = scene + " --simulate --quit-after-s 12 --log " + (folder / "log").string() +
                                  " --screenshot " + (folder / "p.png").string();
    REQUIRE(run_app(folder, arguments, [&] { CHECK(play_script(folder) == 0); }) == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["overflow"] == "");
    CHECK(result["problems"].empty());
    REQUIRE(result.contains("tactile"));
    const Json& tactile = result["tactile"];
    MESSAGE("tactile ", tactile.dump(), ", samples ", result["samples"].dump(), ", frames ", result["frames"].dump(),
            ", start ", result["start_to_first_frame_s"].dump());
    CHECK(tactile["steps"].get<double>() > 3000);
    CHECK(tactile["max_force_N"].get<double>() > 0.3);
    CHECK(tactile["max_force_N"].get<double>() <= 2.5);
    // a busy machine may hold the loop up for a moment, which the guard then bridges
    for (const Json& fault : tactile["faults"]) CHECK(fault["fault"] == "nothing comes from the loop");
    CHECK(tactile["relaxed_steps"].get<double>() < 0.05 * tactile["steps"].get<double>());
    CHECK(std::filesystem::file_size(folder / "log/sub-01/beh/sub-01_task-palpation_run-01_tactile.tsv") > 10000);
}

TEST_CASE("stopped: F12 on another screen stops arm and pins, and nothing moves until Release") {
    const TemporaryFolder folder;
    Script script(folder / "script.tsv");
    script.t_s = 8.0;  // on a busy machine the first frame comes late, and would take all these keys at once
    script.key(kZ);    // another screen
    script.key(kF12);
    script.key(kZ);
    script.key(kEscape);  // back to the trial
    script.press(2.0);
    script.out.close();
    const std::string scene = prepared_scene(folder);
    const std::string arguments = scene + " --simulate --quit-after-s 16 --screenshot " + (folder / "p.png").string();
    REQUIRE(run_app(folder, arguments, [&] { CHECK(play_script(folder) == 0); }) == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["overflow"] == "");
    REQUIRE(result.contains("tactile"));
    MESSAGE("tactile ", result["tactile"].dump());
    CHECK(result["tactile"]["max_force_N"].get<double>() < 0.01);
    CHECK_FALSE(result["tactile"]["faults"].empty());
    CHECK(result["max_force_N"].get<double>() > 0.5);  // the pen pressed
}

namespace {

std::string pins_study(const TemporaryFolder& folder) {
    write_text_atomically(folder / "p.json", R"({"name": "n", "version": "1", "seed": 1, "order": "fixed",
        "conditions": [{"id": "pins", "modality": "shape-display", "scene": "tactile-pins.json"}],
        "choice": {"reference_kPa": 17.5, "comparisons_kPa": [35], "repeats": 2}})");
    return "study run " + (folder / "p.json").string() + " --log " + (folder / "log").string() +
           " --participant 01 --json --screenshot " + (folder / "p.png").string();
}

}  // namespace

TEST_CASE("ports: a trial whose devices' ports are not there does not begin, and its screen names them") {
    const TemporaryFolder folder;
    prepared_scene(folder);
    Script script(folder / "script.tsv");
    script.t_s = 1.0;
    script.key(kEnter);
    script.t_s += 1.0;
    script.key(kEnter);  // Start is not offered
    script.out.close();
    REQUIRE(run_program(folder, pins_study(folder) + " --quit-after-s 9", folder / "log/sub-01/now.json",
                        [&] { CHECK(play_script(folder) == 0); }) == 0);
    CHECK(read_json(folder / "out.json")["overflow"] == "");
    CHECK(read_json(folder / "out.json")["finished"] == 0);
    CHECK(read_json(folder / "log/sub-01/now.json")["step"] == "device");
    CHECK_FALSE(std::filesystem::exists(folder / "log/sub-01/beh/sub-01_task-interval_run-01_settings.json"));
}

TEST_CASE("early: F12 while the devices get ready, and the trial begins anew with rows and events of one number") {
    const TemporaryFolder folder;
    prepared_scene(folder);
    const std::string stem = (folder / "log/sub-01/beh/sub-01_task-interval_run-0").string();
    Script script(folder / "script.tsv");
    script.t_s = 1.0;
    script.key(kEnter);  // begin
    script.t_s += 0.1;
    script.key(kF12);
    script.wait(stem + "1_tactile.tsv");  // by then the devices are there, which nobody wants any more
    script.t_s += 0.5;
    script.key(kEnter);  // Start
    script.wait(stem + "2_events.tsv");
    script.t_s += 1.0;
    script.key(kF12);
    script.out.close();
    REQUIRE(run_study_to("device", folder, pins_study(folder) + " --simulate") == 0);
    CHECK(std::filesystem::file_size(stem + "2_tactile.tsv") > 1000);
    CHECK(read_text(stem + "2_events.tsv").find("device_gone") != std::string::npos);
}

TEST_CASE("driven: a study's surfaces are on arm and pins, and the settings name each device, real or simulated") {
    const TemporaryFolder folder;
    prepared_scene(folder);
    const std::string stem = (folder / "log/sub-01/beh/sub-01_task-interval_run-0").string();
    Script script(folder / "script.tsv");
    script.t_s = 1.0;
    script.key(kEnter);                  // begin
    script.wait(stem + "1_events.tsv");  // the devices are open
    script.t_s += 1.0;
    script.key(kF);  // the first surface
    script.wait(stem + "2_events.tsv");
    script.t_s += 1.0;
    script.key(kF);  // the second one
    script.wait(stem + "2_performance.json");
    script.t_s += 0.5;
    script.key(k1);  // was softer
    script.wait(stem + "3_events.tsv");
    script.t_s += 1.0;
    script.key(kF12);  // in the middle of the next pair
    script.out.close();
    REQUIRE(run_study_to("device", folder, pins_study(folder) + " --simulate") == 0);  // the step says that F12 stopped
    const Json result = read_json(folder / "out.json");
    CHECK(result["overflow"] == "");
    CHECK(result["finished"] == 1);
    CHECK(read_json(folder / "log/sub-01/now.json")["step"] == "device");
    for (const char* run : {"1", "2"}) {
        const Json devices = read_json(stem + run + "_settings.json")["study"]["devices"];
        CAPTURE(devices.dump());
        REQUIRE(devices.size() == 3);
        for (const Json& device : devices) CHECK(device["simulated"] == true);
        CHECK(devices[0]["role"] == "arm");
        CHECK(devices[2]["role"] == "pins");
        CHECK(std::filesystem::file_size(stem + run + "_tactile.tsv") > 1000);
    }
    CHECK(read_text(stem + "3_events.tsv").find("device_gone") != std::string::npos);
    CHECK(shell("timeout 60 " PALPA_PROGRAM " study analyse " + (folder / "log").string() + " --json >/dev/null") == 0);
}
