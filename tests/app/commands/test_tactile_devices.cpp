// palpa tactile pins, identify and characterise: the program against simulators that are programs of their own.

#include <cmath>
#include <doctest/doctest.h>

#include "devices/pins.h"
#include "files/json.h"
#include "tests/app/palpa_with.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/tactile/slab_phantom.h"

using namespace palpa;
using namespace palpa::test;

namespace {

const std::string kPinsFile = std::string(PALPA_SOURCE_DIR) + "/assets/devices/pins-6x6.json";

// A small slab, and a cache of its own.
struct SlabScene {
    TemporaryFolder folder;

    explicit SlabScene(const std::string& tactile = "{\"arm\": {}}") {
        files::write_text_atomically(folder / "slab.json", kSlabPhantom);
        files::write_text_atomically(
            folder / "s.json",
            R"({"name": "slab", "tissue": {"linear": {"phantom": "slab.json", "spacing_mm": 4}}, "tactile": )" +
                tactile + "}");
    }
    Called tactile(const std::string& arguments) const {
        return palpa_with("tactile " + arguments, "XDG_CACHE_HOME=" + folder.path().string());
    }
    std::string file(const std::string& name) const { return (folder / name).string(); }
};

}  // namespace

TEST_CASE("pins test: safe boards pass; boards without timeout or without CRC fail, each with its reason") {
    const Called safe = palpa_with("tactile pins test " + kPinsFile + " --simulate --json");
    REQUIRE(safe.status == 0);
    const files::Json json = files::parse_json(safe.out, "stdout");
    REQUIRE(json["boards"].size() == 2);
    for (const auto& board : json["boards"]) {
        CHECK(board["timeout"] == true);
        CHECK(board["crc"] == true);
        CHECK(board["errors"] == 0);
    }
    CHECK(json["boards"][1]["device"] == 13);
    const Called no_timeout = palpa_with("tactile pins test " + kPinsFile + " --simulate --timeout-ms 0 --json");
    CHECK(no_timeout.status == 1);
    CHECK(files::parse_json(no_timeout.out, "stdout")["boards"][0]["timeout"] == false);
    CHECK(contains(no_timeout.err, "NO TIMEOUT"));
    const Called no_crc = palpa_with("tactile pins test " + kPinsFile + " --simulate --no-crc");
    CHECK(no_crc.status == 1);
    CHECK(contains(no_crc.out, "NO CRC"));
}

TEST_CASE("pins test: a port that is not there is 1, wrong use and two pins on one channel are 2") {
    CHECK(palpa_with("tactile pins test " + kPinsFile).status == 1);
    const Called settings = palpa_with("tactile pins test " + kPinsFile + " --timeout-ms 0");
    CHECK(settings.status == 2);
    CHECK(contains(settings.err, "--simulate"));
    const SlabScene slab;
    std::string text = files::read_text(kPinsFile);
    text.replace(text.find("\"channel\": 1}"), 13, "\"channel\": 0}");
    files::write_text_whole(slab.folder / "twice.json", text);
    const Called twice = slab.tactile("pins test " + slab.file("twice.json") + " --simulate");
    CHECK(twice.status == 2);
    CHECK(contains(twice.err, "no other pin has"));
}

TEST_CASE("pins calibrate: simulated pins that differ from the device file are found") {
    const SlabScene slab;
    files::write_text_atomically(slab.file("new.json.heights.tsv"), "mine\n");
    const Called found =
        slab.tactile("pins calibrate " + kPinsFile + " --simulate --pulses 3 -o " + slab.file("new.json") + " --json");
    REQUIRE(found.status == 0);
    const files::Json json = files::parse_json(found.out, "stdout");
    CHECK(json["error_before_mm"].get<double>() > 0.05);
    CHECK(json["error_after_mm"].get<double>() < 0.02);
    const devices::PinDevice device = devices::read_pin_device(slab.folder / "new.json");
    CHECK(device.port == "/dev/ttyUSB0");
    CHECK(device.name == "6 x 6 pins (SIMULATED)");
    CHECK(device.pins[0].zero_us != 1300.0);
    CHECK(files::read_text(slab.file("new.json.heights.tsv")) == "mine\n");
    CHECK(slab.tactile("pins calibrate " + slab.file("new.json") + " --simulate -o " + slab.file("new.json")).status ==
          2);
}

TEST_CASE(
    "characterise: in virtual time, identified first, within the bounds; the same at every run; files and figure") {
    const SlabScene slab;
    const std::string command = "characterise " + slab.file("s.json") +
                                " --simulate --virtual-time --seed 3 --stiffness-N-per-mm 0.25,1 --json -o ";
    const Called first = slab.tactile(command + slab.file("a"));
    REQUIRE(first.status == 0);
    const files::Json json = files::parse_json(first.out, "stdout");
    CHECK(json["mean_error_percent"].get<double>() < 5.0);
    CHECK(json["worst_hysteresis_N"].get<double>() < 0.2);
    REQUIRE(json["runs"].size() == 2);
    CHECK(json["runs"][1]["asked_N_per_mm"] == 1.0);
    CHECK(json["runs"][1]["wanted_N_per_mm"].get<double>() == close_to(1.0).epsilon(0.02));
    CHECK(json["runs"][0]["link"]["round_trip_ms"]["p50"].is_null());
    CHECK(std::filesystem::exists(slab.folder / "a/stiffness-0.25-N-per-mm.tsv"));
    CHECK(std::filesystem::exists(slab.folder / "a/compensation.json"));
    if (has_gnuplot()) CHECK(std::filesystem::exists(slab.folder / "a/stiffness.png"));
    const Called again = slab.tactile(command + slab.file("b"));
    CHECK(again.out == first.out);
    const Called bare = slab.tactile(command + slab.file("c") + " --compensation off");
    CHECK(files::parse_json(bare.out, "stdout")["worst_hysteresis_N"].get<double>() > 1.0);
    const Called stored =
        slab.tactile(command + slab.file("d") + " --compensation " + slab.file("a/compensation.json"));
    const files::Json of_file = files::parse_json(stored.out, "stdout");
    // the file has the figures rounded, which moves the presses by some micrometres
    CHECK(of_file["mean_error_percent"].get<double>() ==
          close_to(json["mean_error_percent"].get<double>()).epsilon(0.05));
    const Called used = slab.tactile(command + slab.file("a"));  // tables are measurements
    CHECK(used.status == 2);
    CHECK(contains(used.err, "nothing is overwritten"));
}

TEST_CASE("characterise: over the link, one stiffness, in real time") {
    const SlabScene slab;
    const Called called =
        slab.tactile("characterise " + slab.file("s.json") +
                     " --simulate --seed 2 --stiffness-N-per-mm 0.5 --cycles 1 --compensation off --json");
    REQUIRE(called.status == 0);
    const files::Json json = files::parse_json(called.out, "stdout");
    CHECK(json["simulated"] == true);
    CHECK(json["runs"][0]["link"]["ticks"].get<int>() > 2000);
    CHECK(std::abs(json["runs"][0]["error_percent"].get<double>()) < 100.0);
}

TEST_CASE("characterise and identify: what cannot be is refused with 2") {
    const SlabScene slab;
    const auto refused = [&](const std::string& arguments, const std::string& why) {
        const Called called = slab.tactile(arguments);
        CAPTURE(arguments);
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err, why));
    };
    const std::string scene = "characterise " + slab.file("s.json");
    refused(scene, "--simulate");
    refused(scene + " --virtual-time", "--simulate");
    refused(scene + " --simulate --virtual-time --stiffness-N-per-mm 0", "0.01");
    refused("identify --simulate --virtual-time -o " + slab.file("none/c.json"), "none");
    const std::string arm = slab.file("my-arm.json");  // an input is never replaced
    std::filesystem::copy_file(PALPA_SOURCE_DIR "/assets/devices/arm.json", arm);
    refused("identify --device " + arm + " --simulate --virtual-time -o " + arm, "another file");
    const SlabScene high(R"({"arm": {"impedance": "high", "device": "arm.json"}})");
    refused("characterise " + high.file("s.json") + " --simulate --virtual-time", "low");
    refused(scene + " --simulate --virtual-time --depth-mm 9 --stiffness-N-per-mm 0.5,2",
            "found 2 at a depth of 9 mm, where the force limit of 15 N holds the force");
    refused(scene + " --simulate --virtual-time --stiffness-N-per-mm 0.5,0.5", "found 0.5 twice");
    files::write_text_atomically(slab.file("stiffness-0.5-N-per-mm.tsv"), "somebody's own\n");
    refused(scene + " --simulate --virtual-time --stiffness-N-per-mm 0.5 -o " + slab.folder.path().string(),
            "stiffness-0.5-N-per-mm.tsv");
    refused(scene + " --simulate --virtual-time --stiffness-N-per-mm 0.3 --force-limit-N 100 --depth-mm 40",
            "--depth-mm: found 40, expected at most");
}

TEST_CASE("characterise: the depth that a refusal names is taken, also where the tissue stiffens on the way") {
    const SlabScene slab;
    files::write_text_atomically(slab.file("curved.json"),
                                 R"({"name": "curved", "tactile": {"arm": {}}, "tissue": {"force_curve":
                                     {"stiffness_N_per_mm": 0.3, "growth_mm": 3, "greatest_depth_mm": 20}}})");
    const std::string characterise =
        "characterise " + slab.file("curved.json") + " --simulate --virtual-time --stiffness-N-per-mm 2 --depth-mm ";
    const Called refused = slab.tactile(characterise + "9");
    CHECK(refused.status == 2);
    const std::string before = "a --depth-mm of at most ";
    const std::size_t at = refused.err.find(before);
    REQUIRE(at != std::string::npos);
    const double deepest_mm = std::stod(refused.err.substr(at + before.size()));
    CAPTURE(deepest_mm);
    CHECK(deepest_mm > 1.0);
    CHECK(deepest_mm < 7.5);  // where a straight tissue of 2 N/mm would reach the 15 N
    CHECK(slab.tactile(characterise + std::to_string(deepest_mm)).status == 0);
    CHECK(slab.tactile(characterise + std::to_string(1.02 * deepest_mm)).status == 2);
}

TEST_CASE("identify: an arm that does not answer is named with its address") {
    const SlabScene slab;
    files::Json arm = files::read_json(PALPA_SOURCE_DIR "/assets/devices/arm.json");
    arm["host"] = arm["sensor"]["host"] = "127.0.0.1";
    arm["port"] = 1;
    files::write_text_atomically(slab.folder / "mute.json", files::json_text(arm));
    const Called called = slab.tactile("identify --device " + slab.file("mute.json") + " -o " + slab.file("c.json"));
    CHECK(called.status == 1);
    CHECK(contains(called.err, " at 127.0.0.1:1: nothing answers within 2 s"));
}

TEST_CASE("identify: finds an arm's parameters and writes them") {
    const SlabScene slab;
    const Called called =
        slab.tactile("identify --simulate --virtual-time --seed 0 -o " + slab.file("c.json") + " --json");
    REQUIRE(called.status == 0);
    const files::Json json = files::parse_json(called.out, "stdout");
    CHECK(json["coulomb_N"].get<double>() == close_to(2.0).epsilon(0.03));
    CHECK(json["weight_N"].get<double>() == close_to(0.8 * 9.80665).epsilon(0.01));
    CHECK(json["ripple"]["wavelength_mm"].get<double>() == close_to(12.0).epsilon(0.01));
    CHECK(files::read_json(slab.folder / "c.json")["kind"] == "compensation");
    CHECK(files::read_json(slab.folder / "c.json")["arm"] == "force arm (SIMULATED)");
}
