// The program as a person calls it: exit status, messages, JSON.

#include <cstdio>
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

const std::string kAssets = PALPA_SOURCE_DIR "/assets/";
const std::string kTrace = kAssets + "traces/raster.tsv";

}  // namespace

TEST_CASE("command line: help and version exist for every command") {
    for (const char* command : {"",
                                "run",
                                "explain",
                                "devices",
                                "maps",
                                "maps info",
                                "maps sample",
                                "maps import",
                                "maps generate",
                                "part",
                                "part info",
                                "part evaluate",
                                "part button",
                                "part edit",
                                "part compare",
                                "part export",
                                "bench trace",
                                "bench pens",
                                "bench speed",
                                "bench accuracy",
                                "calibrate",
                                "calibrate record",
                                "calibrate fit",
                                "calibrate check",
                                "calibrate compare",
                                "bench accuracy mechanics"}) {
        CAPTURE(command);
        const Called help = palpa_with(std::string(command) + " --help");
        CHECK(help.status == 0);
        CHECK(help.out.size() > 100);
        CHECK(contains(help.out, (std::string("Usage: palpa") + (*command != 0 ? " " : "") + command).c_str()));
    }
    CHECK(contains(palpa_with("--version").out, "palpa 0."));
}

TEST_CASE("command line: a command that is mistyped is named, with those that are there") {
    const Called top = palpa_with("tangibel info strip");
    CHECK(top.status == 2);
    CHECK(contains(top.err, "palpa: found 'tangibel', expected a scene, a map or a command: run, explain, "));
    CHECK(contains(palpa_with("fem-solve x").err, "palpa: found 'fem-solve', expected a scene"));
    CHECK(contains(palpa_with("part.info x").err, "palpa: found 'part.info', expected a scene"));
    const Called below = palpa_with("maps inof x.map");
    CHECK(below.status == 2);
    CHECK(contains(below.err, "palpa: maps: found 'inof', expected info, "));
}

TEST_CASE("command line: headless replay reports its keys as one JSON object") {
    const Called run = palpa_with("run --replay " + kTrace + " --headless --json");
    CHECK(run.status == 0);
    CHECK(run.err.empty());
    const Json json = parse_json(run.out, "stdout");
    for (const char* key : {"samples", "frames", "steps", "dropped_steps", "skipped_stations", "skipped_slides",
                            "latency_ms", "max_force_N", "max_depth_mm", "max_lag_mm", "stages"}) {
        CHECK(json.contains(key));
    }
    CHECK(json["latency_ms"].contains("p99"));
    for (const char* key : {"name", "fidelity", "calls", "median_us"}) CHECK(json["stages"][0].contains(key));
    CHECK(json["dropped_steps"] == 0);
    CHECK(palpa_with(kAssets + "scenes/delay.json --replay " + kTrace + " --headless").status ==
          0);  // `run` may be left out
}

TEST_CASE("command line: a log is written in the BIDS layout and repeats byte for byte") {
    const TemporaryFolder folder;
    const std::string call = "run --replay " + kTrace + " --headless --log ";
    CHECK(palpa_with(call + (folder / "a").string()).status == 0);
    CHECK(palpa_with(call + (folder / "b").string()).status == 0);
    const std::string stem = "/sub-01/beh/sub-01_task-palpation_run-01";
    for (const char* suffix : {"_samples.tsv", "_samples.json", "_events.tsv", "_events.json", "_marks.tsv",
                               "_marks.json", "_settings.json"}) {
        CHECK(read_text(folder / ("a" + stem + suffix)) == read_text(folder / ("b" + stem + suffix)));
    }
    CHECK(std::filesystem::exists(folder / ("a" + stem + "_performance.json")));
    CHECK(palpa_with(call + (folder / "a").string()).status == 0);
    CHECK(std::filesystem::exists(folder / "a/sub-01/beh/sub-01_task-palpation_run-02_samples.tsv"));
}

TEST_CASE("command line: devices without a display says so") {
    const Called devices = palpa_with("devices --json", "env -u DISPLAY -u WAYLAND_DISPLAY");
    CHECK(devices.status == 1);
    CHECK(devices.out.empty());
    CHECK(contains(devices.err, "no display: DISPLAY is not set"));
}

TEST_CASE("command line: a picture of the greatest lag needs no display") {
    const TemporaryFolder folder;
    const Called run = palpa_with("run --replay " + kTrace + " --headless --screenshot " + (folder / "p.png").string(),
                                  "env -u DISPLAY -u WAYLAND_DISPLAY");
    CHECK_MESSAGE(run.status == 0, run.err);
    const std::string png = read_text(folder / "p.png");
    CHECK(png.substr(1, 3) == "PNG");
    CHECK(png.size() > 20000);  // not blank
}

TEST_CASE("command line: explain names every stage with its error and cost, measured if asked") {
    const Called plain = palpa_with("explain");
    CHECK(plain.status == 0);
    for (const char* word :
         {"calibration", "depth", "display_ratio", "surface", "error:", "not measured", "simulated, not recorded"}) {
        CHECK(contains(plain.out, word));
    }
    const Json json = parse_json(palpa_with("explain " + kAssets + "scenes/off.json --measure --json").out, "stdout");
    CHECK(json["stages"].size() == 4);
    CHECK(json["stages"][0]["calls"].get<int>() > 1000);
    CHECK(json["stages"][0]["p99_us"].get<double>() >= json["stages"][0]["median_us"].get<double>());
}

TEST_CASE("command line: maps info, sample, generate and import") {
    const TemporaryFolder folder;
    const std::string map = kAssets + "maps/silicone.map";
    const Json info = parse_json(palpa_with("maps info " + map + " --json").out, "stdout");
    CHECK(info["shape"] == Json({6, 59, 159}));
    CHECK(info["missing"] == 0);
    CHECK(info["force_range_N"][1].get<double>() > 3.0);
    CHECK(info["source"]["kind"] == "simulated");
    const Json at =
        parse_json(palpa_with("maps sample " + map + " --x-mm 60 --y-mm 60 --depth-mm 7 --json").out, "stdout");
    CHECK(at["force_N"].get<double>() == close_to(2.98).epsilon(0.01));
    for (const char* along : {"resists_x_N", "resists_y_N"}) CHECK(at[along].get<double>() >= 0.0);
    const std::string force = number_text(at["force_N"].get<double>());
    const Json back = parse_json(
        palpa_with("maps sample " + map + " --x-mm 60 --y-mm 60 --force-N " + force + " --json").out, "stdout");
    CHECK(back["depth_mm"].get<double>() == close_to(7.0).epsilon(1e-9));
    CHECK(palpa_with("maps generate --method analytic " + kAssets + "phantoms/silicone.json -o " +
                     (folder / "s.map").string())
              .status == 0);
    CHECK(palpa_with("run " + (folder / "s.map").string() + " --replay " + kTrace + " --headless").status == 0);

    const std::string recording = PALPA_RECORDINGS "/probing/probingRAL2018B_T2.csv";
    if (!std::filesystem::exists(recording)) {
        MESSAGE("not checked: the recording is not beside the checkout: ", recording);
        return;
    }
    const Called import = palpa_with("maps import " + recording + " -o " + (folder / "x.map").string());
    CHECK(import.status == 0);
    CHECK(contains(import.out, "62 x 39 cells of 1.58 x 1.58 mm"));
    CHECK(palpa_with("bench trace " + (folder / "x.map").string() + " --seconds 30 --force-N 1 -o " +
                     (folder / "t.tsv").string())
              .status == 0);
    const Called run = palpa_with("run " + (folder / "x.map").string() + " --replay " + (folder / "t.tsv").string() +
                                  " --headless --json");
    CHECK(run.status == 0);
    CHECK(parse_json(run.out, "stdout")["max_lag_mm"].get<double>() > 0.3);
}

TEST_CASE("command line: wrong usage and bad input end with status 2 and say what was expected") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "bad.json", "{\"name\": 3}");
    write_text_atomically(folder / "bad.tsv", "t_host_s\tx\n0\t1\n");
    write_text_atomically(folder / "comma.csv", "point,ref_x_mm,ref_y_mm,depth_cmd_mm,depth_mm,fn_N\n1,2,3,4,5,6,7\n");
    const auto refused = [&](const std::string& arguments, const char* word) {
        const Called called = palpa_with(arguments);
        CAPTURE(arguments);
        CAPTURE(called.err);
        CHECK(called.status == 2);
        CHECK(contains(called.err + called.out, word));
    };
    refused("run --headless", "--replay TRACE.tsv");
    for (const char* both : {"--guided --test", "--guided delay", "--guided --screen maps"})
        refused(std::string("run ") + both, "found with --guided");
    for (const char* ignored : {"--guided", "--screen maps", "--simulate", "--quit-after-s 3", "--record t.tsv"})
        refused("run --headless --replay " + kTrace + " " + ignored, "found with --headless, expected a window");
    for (const char* ignored : {"--width-px 300", "--height-px 300", "--left-handed"})
        refused("run --headless --replay " + kTrace + " " + ignored, "expected a --screenshot");
    refused("run --headless --replay " + kTrace + " --participant 07", "--participant requires --log");
    refused("run --nonsense", "--nonsense");
    refused("maps", "subcommand is required");
    refused("maps sample " + kAssets + "maps/silicone.map --x-mm 1 --y-mm 1", "[--force-N,--depth-mm] is required");
    refused("maps sample " + kAssets + "maps/silicone.map --x-mm one --y-mm 1 --force-N 1", "--x-mm");
    refused("bench accuracy mechanics --quick -o " + (folder / "bad.json").string(), "expected a folder");
    refused("run none.json", "none.json: found nothing, expected a scene");
    refused("run " + (folder / "bad.json").string() + " --replay " + kTrace + " --headless",
            "name: found 3, expected a text");
    refused("run --headless --replay " + (folder / "none.tsv").string(), "none.tsv: cannot be read");
    refused("run --headless --replay " + (folder / "bad.tsv").string(), "bad.tsv: line 1: found the columns");
    refused("maps info " + folder.path().string(), "map.json: cannot be read");
    refused("maps info " + std::string(5000, 'm'), "found a name that is too long");
    refused("maps import " + (folder / "comma.csv").string() + " -o " + (folder / "n.map").string(),
            "line 2: found 7 fields");
    CHECK_FALSE(std::filesystem::exists(folder / "n.map"));
    refused("maps generate " + (folder / "bad.json").string() + " -o " + (folder / "n.map").string(),
            "name: found an unknown key, expected one of size_mm");
    refused("maps generate " + kAssets + "phantoms/silicone.json -o " + folder.path().string(),
            "nothing is overwritten");
}

TEST_CASE("command line: a trace that does not fit on the disk is not left half written") {
    const TemporaryFolder folder;
    const std::string trace = (folder / "t.tsv").string();
    const Called full = shell("ulimit -f 8; timeout 60 " PALPA_PROGRAM " bench trace --seconds 5 -o " + trace);
    CHECK(full.status == 1);
    CHECK(contains(full.err, "cannot be written to its end"));
    CHECK_FALSE(std::filesystem::exists(trace));
    CHECK_FALSE(std::filesystem::exists(folder / "t.json"));
}

TEST_CASE("command line: without a display the app says so and what can be done instead") {
    const Called run = palpa_with("run", "env -u DISPLAY -u WAYLAND_DISPLAY");
    CHECK(run.status == 1);
    CHECK(contains(run.err, "display"));
    CHECK(contains(run.err, "--headless"));
}
