// palpa tactile run: the program against simulators that are programs of their own.

#include <algorithm>
#include <chrono>
#include <cmath>
#include <csignal>
#include <doctest/doctest.h>
#include <thread>
#include <vector>

#include "devices/simulators/process.h"
#include "files/json.h"
#include "files/table.h"
#include "tests/app/palpa_with.h"
#include "tests/assets.h"
#include "tests/error_message.h"
#include "tests/tactile/slab_phantom.h"

using namespace palpa;
using namespace palpa::test;
using devices::simulators::SimulatorProcess;

namespace {

// A small slab with an arm and pins, a press, and a cache of its own.
struct SlabFolder {
    TemporaryFolder folder;

    explicit SlabFolder(const std::string& tactile = kArmAndPins, const std::string& tissue = "") {
        files::write_text_atomically(folder / "slab.json", kSlabPhantom);
        const std::string block = R"({"linear": {"phantom": "slab.json", "spacing_mm": 2}})";
        files::write_text_atomically(
            folder / "s.json",
            R"({"name": "slab", "tissue": )" + (tissue.empty() ? block : tissue) + R"(, "tactile": )" + tactile + "}");
        write_press("p.tsv", 10e-3);
    }
    // Raised cosines of a second, so deep.
    void write_press(const std::string& name, double depth_m, int seconds = 2) const {
        std::string text = "t_s\tx_mm\ty_mm\tdepth_mm\n";
        for (int k = 0; k <= 100 * seconds; ++k) {
            const double t_s = 0.01 * k;
            text += files::number_text(t_s) + "\t20\t20\t" +
                    files::number_text(1e3 * depth_m * (0.5 - 0.5 * std::cos(6.283185307179586 * t_s))) + "\n";
        }
        files::write_text_atomically(folder / name, text);
    }
    std::string path(const std::string& name) const { return (folder / name).string(); }
    std::string command(const std::string& more) const {
        return "tactile run " + path("s.json") + " --replay " + path("p.tsv") + " " + more;
    }
    Called run(const std::string& more) const { return palpa_with(command(more), "XDG_CACHE_HOME=" + path("cache")); }
};

files::Json result_of(const Called& called) {
    CAPTURE(called.err);
    REQUIRE(called.status == 0);
    return files::parse_json(called.out, "standard output");
}

// Refused with status 2 and this reason.
void check_refused(const std::string& tactile, const std::string& reason, const std::string& tissue = "") {
    const Called called = SlabFolder(tactile, tissue).run("--virtual-time");
    CAPTURE(called.err);
    CHECK(called.status == 2);
    CHECK(contains(called.err, reason));
}

}  // namespace

TEST_CASE("tactile run: a press beside the tissue is warned of") {
    const SlabFolder slab(R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json"}, "leads": "arm"})");
    files::write_text_atomically(slab.path("p.tsv"), "t_s\tx_mm\ty_mm\tdepth_mm\n0\t20\t20\t0\n0.1\t500\t20\t0\n");
    const Called called = slab.run("--virtual-time");
    CAPTURE(called.err);
    CHECK(called.status == 0);
    CHECK(contains(called.err, "p.tsv: 1 of 2 rows are beside the tissue (x "));
}

TEST_CASE("tactile run: a press in virtual time that a signal stops is written as far as it went, and says so") {
    const SlabFolder slab;
    files::write_text_atomically(slab.path("p.tsv"), "t_s\tx_mm\ty_mm\tdepth_mm\n0\t20\t20\t0\n9999\t20\t20\t3\n");
    const std::string log = slab.path("log");
    const Called called =
        shell(stopped_once(log + "/steps.tsv", "XDG_CACHE_HOME=" + slab.path("cache") + " " PALPA_PROGRAM " " +
                                                   slab.command("--virtual-time --log " + log)));
    CAPTURE(called.err);
    CHECK(called.status == 0);
    CHECK(contains(called.err, "stopped by a signal before the press was over"));
    const files::Json kept = files::read_json(log + "/performance.json");
    CHECK(contains(kept["warnings"].dump(), "stopped by a signal"));
    const std::string steps = files::read_text(log + "/steps.tsv");
    CHECK(std::count(steps.begin(), steps.end(), '\n') == 1 + kept["steps"].get<std::ptrdiff_t>());
}

TEST_CASE("tactile run: the shipped scene and press: the force holds at its limit, and lead halves the mismatch") {
    const TemporaryFolder folder;
    double rms_mm[2] = {0.0, 0.0};
    for (const char* schedule : {"free", "lead"}) {
        const files::Json json = result_of(palpa_with("tactile run " + (kAssets / "scenes/tactile.json").string() +
                                                          " --replay " + (kAssets / "traces/press.tsv").string() +
                                                          " --virtual-time --headless --json --schedule " + schedule,
                                                      "XDG_CACHE_HOME=" + folder.path().string()));
        CHECK(json["max_force_N"].get<double>() <= 2.5);
        CHECK(json["held_steps"].get<int>() > 0);
        CHECK(json["faults"].empty());
        CHECK(json["fidelity"] == "table");
        CHECK(json["pairing"] ==
              "low-impedance arm: depth in, force out; shape display (high impedance): stress in, shape out");
        rms_mm[std::string(schedule) == "lead" ? 1 : 0] = json["mismatch_mm"]["rms"].get<double>();
    }
    CAPTURE(rms_mm[0]);
    CAPTURE(rms_mm[1]);
    CHECK(rms_mm[1] <= 0.5 * rms_mm[0]);
}

TEST_CASE("tactile run: the note on the pins' stroke is of the schedule that is asked for") {
    const TemporaryFolder folder;
    const auto notes = [&](const std::string& schedule) {
        const files::Json json = result_of(palpa_with("tactile run " + (kAssets / "scenes/tactile.json").string() +
                                                          " --replay " + (kAssets / "traces/press.tsv").string() +
                                                          " --virtual-time --json --schedule " + schedule,
                                                      "XDG_CACHE_HOME=" + folder.path().string()));
        return json["notes"].dump();
    };
    CHECK(contains(notes("lead"), "the pins' stroke is used up at "));
    CHECK_FALSE(contains(notes("locked"), "stroke"));
}

TEST_CASE("tactile run: live with simulators it writes the bytes of virtual time, where the touch leads") {
    const SlabFolder slab;
    const files::Json live = result_of(slab.run("--simulate --json --log " + slab.path("live")));
    const files::Json virtual_time = result_of(slab.run("--virtual-time --json --log " + slab.path("virtual")));
    for (const char* file : {"steps.tsv", "pins.tsv"}) {
        CAPTURE(file);
        CHECK(files::read_text(slab.folder / "live" / file) == files::read_text(slab.folder / "virtual" / file));
    }
    for (const char* key : {"steps", "held_steps", "max_force_N", "clipped_share", "linear_range"}) {
        CAPTURE(key);
        CHECK(live[key] == virtual_time[key]);
    }
    CHECK(live["held_steps"].get<int>() > 0);
    CHECK(live["max_force_N"].get<double>() <= 2.5);
    CHECK(live["faults"].empty());
    CHECK(live["reached_by"] == "simulator");
    CHECK(live["link"]["round_trip_ms"]["p50"].get<double>() > 0.0);
    for (const files::Json& device : live["devices"]) CHECK(device["simulated"] == true);
    // nothing is overwritten
    const Called again = slab.run("--virtual-time --log " + slab.path("live"));
    CHECK(again.status == 2);
    CHECK(contains(again.err, "steps.tsv: found something of that name"));
}

TEST_CASE("tactile run: where the arm leads, its recorded rows give the same log again") {
    const SlabFolder slab(R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json"}, "leads": "arm"})");
    const files::Json live = result_of(slab.run("--simulate --json --log " + slab.path("live")));
    CHECK(live["max_depth_mm"].get<double>() > 1.0);
    const Called again = palpa_with("tactile run " + slab.path("s.json") + " --replay " +
                                        slab.path("live/press.tactile.tsv") + " --json --log " + slab.path("again"),
                                    "XDG_CACHE_HOME=" + slab.path("cache"));
    CHECK(result_of(again)["steps"] == live["steps"]);
    for (const char* file : {"steps.tsv", "pins.tsv"}) {
        CAPTURE(file);
        CHECK(files::read_text(slab.folder / "live" / file) == files::read_text(slab.folder / "again" / file));
    }
}

TEST_CASE("tactile run: a replay takes the schedule of its run, or warns of another") {
    const SlabFolder slab(R"({"arm": {"device": "arm.json"}, "display": {"device": "pins-6x6.json"}, "leads": "arm"})");
    REQUIRE(slab.run("--virtual-time --schedule free --log " + slab.path("run")).status == 0);
    const auto replay = [&](const std::string& more) {
        return palpa_with(
            "tactile run " + slab.path("s.json") + " --replay " + slab.path("run/press.tactile.tsv") + more,
            "XDG_CACHE_HOME=" + slab.path("cache"));
    };
    const Called same = replay(" --json --log " + slab.path("same"));
    CHECK(result_of(same)["schedule"] == "free");
    CHECK(files::read_text(slab.folder / "run/pins.tsv") == files::read_text(slab.folder / "same/pins.tsv"));
    CHECK_FALSE(contains(same.err, "--schedule"));
    CHECK(result_of(same)["seed"].is_null());  // no simulator takes part
    CHECK(contains(replay(" --virtual-time").err, "--virtual-time: found beside recorded rows"));
    const Called seeded = replay(" --seed 3");
    CHECK(seeded.status == 2);
    CHECK(contains(seeded.err, "--seed: found without simulators"));
    const Called other = replay(" --schedule lead --log " + slab.path("other"));
    CHECK(other.status == 0);
    CHECK(contains(other.err, "the run had --schedule free; the pins are told other heights"));
    CHECK(files::read_text(slab.folder / "run/pins.tsv") != files::read_text(slab.folder / "other/pins.tsv"));
}

TEST_CASE("tactile run: every pairing that cannot show the tissue is refused with its reason") {
    check_refused(R"({"finger": {"contact": "rigid"}, "display": {}})", "the shape would be the finger's own");
    check_refused(R"({"display": {"kind": "pressure"}})", "the pressure would be the finger's own");
    check_refused(R"({"arm": {"impedance": "high"}, "display": {}})",
                  "expected a device with a force sensor between the arm and the display");
    check_refused(R"({"display": {}, "leads": "arm"})", "found no arm to lead");
    check_refused("{}", "found neither an arm nor a display");
    check_refused(R"({"finger": {"contact": "pad"}, "display": {"kind": "pressure", "device": "pins-6x6.json"}})",
                  "pressures are drawn and logged only");
    check_refused(kArmAndPins, "maps and parts know no surface", R"({"map": "silicone.map"})");
    check_refused(R"({"arm": {"impedance": "high", "device": "arm.json"}})",
                  "tactile.arm.impedance: found high, expected that of the device");
}

TEST_CASE("tactile run: a high-impedance arm without a force sensor is refused") {
    const SlabFolder slab(R"({"arm": {"impedance": "high", "device": "own-arm.json"}})");
    files::Json arm = files::read_json(kAssets / "devices" / "arm.json");
    arm["impedance"] = "high";
    files::write_text_atomically(slab.folder / "own-arm.json", files::json_text(arm));
    CHECK(slab.run("--virtual-time").status == 0);
    arm.erase("sensor");
    files::write_text_atomically(slab.folder / "own-arm.json", files::json_text(arm));
    const Called called = slab.run("--virtual-time");
    CHECK(called.status == 2);
    CHECK(contains(called.err, "found a high-impedance arm without a force sensor"));
}

TEST_CASE("tactile run: PRESS with time going back, without a press, and scenes without the key") {
    const SlabFolder slab;
    files::write_text_atomically(slab.folder / "p.tsv",
                                 "t_s\tx_mm\ty_mm\tdepth_mm\n0\t20\t20\t0\n0.02\t20\t20\t1\n0.01\t20\t20\t2\n");
    const Called back = slab.run("--virtual-time");
    CHECK(back.status == 2);
    CHECK(contains(back.err, "p.tsv: line 4, t_s: found '0.01'"));
    const Called none = palpa_with("tactile run " + slab.path("s.json"));
    CHECK(none.status == 2);
    CHECK(contains(none.err, "found no --replay PRESS.tsv"));
    const Called without = palpa_with("tactile run " + (kAssets / "scenes/linear.json").string() + " --replay " +
                                      (kAssets / "traces/press.tsv").string() + " --virtual-time");
    CHECK(without.status == 2);
    CHECK(contains(without.err, "tactile: found no such key"));
}

TEST_CASE("tactile run: a device that is not there is named") {
    const SlabFolder slab(R"({"display": {"device": "pins-6x6.json"}})");
    const Called called = slab.run("--pins-port " + slab.path("no-such-port"));
    CHECK(called.status == 1);
    CHECK(contains(called.err, "no-such-port"));
}

TEST_CASE("tactile run: link silent for a moment: the fault is counted, and the run goes on to its end") {
    const SlabFolder slab(R"({"arm": {"device": "arm.json"}})");
    files::Json device = files::read_json(kAssets / "devices" / "arm.json");
    device.erase("sensor");
    files::write_text_atomically(slab.folder / "arm.json", files::json_text(device));
    slab.run("--virtual-time");  // computes the slab, which the cache keeps
    const SimulatorProcess arm(PALPA_ARM_SIMULATOR, {"--silent-from-s", "1.5", "--silent-s", "0.4"});
    const files::Json json = result_of(slab.run("--arm-port 127.0.0.1:" + arm.port() + " --json"));
    CHECK(json["steps"] == 2001);
    REQUIRE(json["faults"].size() == 1);
    CHECK(json["faults"][0]["fault"] == "nothing comes from a device");
    CHECK(json["devices"][0]["simulated"] == false);  // nobody told the program that it is one
}

TEST_CASE("tactile run: SIGKILL: the simulators survive, and the pins rest by the boards' own timeout") {
    const SlabFolder slab(R"({"display": {"device": "pins-6x6.json"}})");
    slab.write_press("p.tsv", 2e-3, 20);
    slab.run("--virtual-time");  // computes the slab, which the cache keeps
    SimulatorProcess pins(PALPA_MAESTRO_SIMULATOR,
                          {(kAssets / "devices/pins-6x6.json").string(), "--heights", slab.path("heights.tsv")});
    const Called killed = shell("XDG_CACHE_HOME=" + slab.path("cache") + " timeout -s KILL 5 " PALPA_PROGRAM " " +
                                slab.command("--pins-port " + pins.port()));
    CHECK(killed.status != 0);
    std::this_thread::sleep_for(std::chrono::milliseconds(1000));  // timeout 0.1 s, and the way home
    CHECK(::kill(pins.pid(), 0) == 0);
    pins.end();
    files::Table heights = files::read_tsv(slab.folder / "heights.tsv");
    double highest_mm = 0.0, last_mm = -1.0;
    while (heights.next()) {
        last_mm = heights.finite_number(1);
        highest_mm = std::max(highest_mm, last_mm);
    }
    CHECK(highest_mm > 0.5);          // they were driven
    CHECK(std::abs(last_mm) < 0.01);  // at home
}
