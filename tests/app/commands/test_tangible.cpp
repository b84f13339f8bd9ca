// palpa tangible: the commands as a person calls them, on a strip of few cells.

#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>

#include "files/json.h"
#include "files/table.h"
#include "files/text.h"
#include "tests/app/palpa_with.h"
#include "tests/assets.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::test;

namespace {

struct StripFolder {
    TemporaryFolder folder;

    StripFolder() {
        files::Json strip = files::read_json(kAssets / "devices" / "strip.json");
        strip["mesh"]["box"]["elements"] = {50, 2, 2};
        files::write_text_atomically(folder / "strip.json", strip.dump());
        files::write_text_atomically(folder / "scene.json", R"({"name": "soft", "mapping": {"kind": "direct"},
            "tissue": {"force_curve": {"stiffness_N_per_mm": 0.1, "growth_mm": 1000, "greatest_depth_mm": 8}},
            "tangible": {"device": "strip.json", "plant": "exact", "fidelity": "linear"}})");
    }
    std::string path(const std::string& name) const { return (folder / name).string(); }
    std::string press(const std::string& more) const {
        return "tangible characterise " + path("strip.json") +
               " --stiffness-N-per-mm 0.1 --depth-mm 3 --speed-mm-per-s 20 --fidelity linear --json " + more;
    }
};

files::Json result_of(const Called& called) {
    CAPTURE(called.err);
    REQUIRE(called.status == 0);
    return files::parse_json(called.out, "standard output");
}

}  // namespace

TEST_CASE("tangible info: the counts of the two devices of the paper, and what to beware of") {
    const files::Json strip = result_of(palpa_with("tangible info strip --json"));
    CHECK(strip["nodes"] == 765);
    CHECK(strip["elements"] == 400);
    REQUIRE(strip["actuators"].size() == 2);
    for (const char* key : {"name", "kind", "unit", "lower", "upper", "tie"})
        CHECK(strip["actuators"][0].contains(key));
    CHECK(strip["weight_N"].get<double>() == close_to(0.08).epsilon(0.1));
    const files::Json accordion = result_of(palpa_with("tangible info accordion.json --json"));
    CHECK(accordion["nodes"].get<double>() == close_to(858).epsilon(0.03));
    CHECK(accordion["elements"].get<double>() == close_to(2743).epsilon(0.03));
    CHECK(accordion["actuators"].size() == 4);
    CHECK_FALSE(accordion["warnings"].empty());  // one linear tetrahedron through a thin wall
    CHECK(accordion["fit"]["lag_ms"] == 0.0);
    const StripFolder folder;
    files::Json worn = files::read_json(folder.path("strip.json"));
    worn["fit"] = {{"modulus_factor", 0.9}, {"lag_ms", 50.0}};
    files::write_text_atomically(folder.path("worn.json"), worn.dump());
    CHECK(contains(palpa_with("tangible info " + folder.path("worn.json")).out, "fit: modulus 0.9 of the file's"));
    CHECK(contains(palpa_with("tangible info " + folder.path("worn.json")).out, "lag 50 ms"));
}

TEST_CASE("tangible solve: every term of a press that can be rendered, and what limits one that cannot") {
    const StripFolder strip;
    const std::string solve = "tangible solve " + strip.path("strip.json") + " --depth-mm 3 --json --force-N ";
    const files::Json soft = result_of(palpa_with(solve + "0.3"));
    CHECK(soft["reachable"] == true);
    CHECK(soft["converged"] == true);
    CHECK(std::abs(soft["residual_mm"].get<double>()) < 1e-6);
    for (const char* key : {"actuation", "rank", "active", "limited_by", "iterations", "time_us"})
        CHECK(soft.contains(key));
    for (const char* key : {"name", "value", "unit", "length_mm"}) CHECK(soft["actuation"][0].contains(key));
    const files::Json hard = result_of(palpa_with(solve + "5"));
    CHECK(hard["reachable"] == false);
    CHECK(hard["limited_by"].is_string());
}

TEST_CASE("tangible solve: d is called the gap with the actuators at zero, and W a + d is what is left") {
    const StripFolder strip;
    const std::string solve = "tangible solve " + strip.path("strip.json") + " --depth-mm 3 --force-N 0.3";
    const std::string text = palpa_with(solve).out;
    CHECK(contains(text, "d, the linearised gap of the depth with the actuators at zero: "));
    CHECK(contains(text, "what is left, W a + d: "));
}

TEST_CASE("tangible run: on a plant in virtual time the log repeats byte for byte, and none is overwritten") {
    const StripFolder strip;
    const std::string run = "tangible run " + strip.path("scene.json") + " --headless --seconds 1 --json --log ";
    const files::Json json = result_of(palpa_with(run + strip.path("a")));
    for (const char* key :
         {"ticks", "missed_ticks", "period_us", "force_rms_percent", "saturated_share", "held_ms", "faults", "devices"})
        CHECK(json.contains(key));
    CHECK(json["ticks"] == 101);
    result_of(palpa_with(run + strip.path("b")));
    CHECK(files::read_text(strip.folder / "a/ticks.tsv") == files::read_text(strip.folder / "b/ticks.tsv"));
    const Called again = palpa_with(run + strip.path("a"));
    CHECK(again.status == 2);
    CHECK(contains(again.err, "a/ticks.tsv: found something of that name, expected a new name"));
}

TEST_CASE("tangible run: a press in virtual time that a signal stops is written as far as it went, and says so") {
    const StripFolder strip;
    const std::string log = strip.path("log");
    const Called called =
        shell(stopped_once(log + "/ticks.tsv", PALPA_PROGRAM " tangible run " + strip.path("scene.json") +
                                                   " --headless --seconds 100000 --log " + log));
    CAPTURE(called.err);
    CHECK(called.status == 0);
    CHECK(contains(called.err, "stopped by a signal before the press was over"));
    const files::Json kept = files::read_json(log + "/performance.json");
    CHECK(contains(kept["notes"].dump(), "stopped by a signal"));
    const std::string ticks = files::read_text(log + "/ticks.tsv");
    CHECK(std::count(ticks.begin(), ticks.end(), '\n') == 1 + kept["ticks"].get<std::ptrdiff_t>());
}

TEST_CASE(
    "tangible run: the shipped soft block bears a light press by force, and is pressed in its middle wherever it is "
    "touched") {
    const TemporaryFolder folder;
    std::string press = "t_s\tx_mm\ty_mm\tforce_N\n";
    for (int i = 0; i <= 100; ++i)
        press += files::short_number(0.01 * i) + "\t70\t20\t" +
                 files::short_number(std::min(0.01 * i / 0.3, 1.0) * 0.36) + "\n";
    files::write_text_atomically(folder / "press.tsv", press);
    const Called called =
        palpa_with("tangible run tangible-block --headless --json --press " + (folder / "press.tsv").string());
    CHECK(result_of(called)["faults"].empty());
    CHECK(called.err.find("beside") == std::string::npos);
}

TEST_CASE("tangible run: a replay takes the fidelity and the rate of the run, and says when it is told others") {
    const StripFolder strip;
    const std::string run = "tangible run " + strip.path("scene.json") + " --json --log ";
    result_of(palpa_with(run + strip.path("a") + " --headless --seconds 1 --fidelity linear --rate-Hz 200"));
    const std::string replay = " --replay " + strip.path("a/press.tangible.tsv");
    const files::Json same = result_of(palpa_with(run + strip.path("b") + replay));
    CHECK(same["fidelity"] == "linear");
    CHECK(same["rate_Hz"] == 200.0);
    CHECK(same["ticks"] == 201);
    const auto commands = [&](const char* log) {
        std::vector<std::string> out;
        for (files::Table ticks = files::read_tsv(strip.folder / log / "ticks.tsv"); ticks.next();)
            out.emplace_back(ticks.field(ticks.column("left_N")));
        return out;
    };
    CHECK(commands("a") == commands("b"));
    CHECK(same["seed"].is_null());  // rows have no plant
    CHECK(contains(palpa_with(run + strip.path("c") + replay + " --seed 3").err, "--seed: found beside --replay"));
    const Called other = palpa_with(run + strip.path("c") + replay + " --fidelity step");
    CHECK(other.status == 0);
    CHECK(contains(other.err, "the run had --fidelity linear --rate-Hz 200; the commands are others"));
}

TEST_CASE("tangible run and characterise: a depth that the device cannot have is refused before anything runs") {
    const StripFolder strip;
    files::write_text_atomically(strip.folder / "press.tsv", "t_s\tx_mm\ty_mm\tdepth_mm\n0\t0\t0\t0\n1\t0\t0\t1e6\n");
    const Called run = palpa_with("tangible run " + strip.path("scene.json") + " --headless --press " +
                                  strip.path("press.tsv") + " --log " + strip.path("log"));
    CHECK(run.status == 2);
    CHECK(contains(run.err, "press.tsv: depth_mm: found 1e+06, expected at most the device's size, "));
    CHECK_FALSE(std::filesystem::exists(strip.folder / "log"));
    files::Json small = files::read_json(strip.folder / "strip.json");
    small["mesh"]["box"]["size_mm"] = {60, 20, 4};
    files::write_text_atomically(strip.folder / "small.json", small.dump());
    const Called press = palpa_with("tangible characterise " + strip.path("small.json") +
                                    " --stiffness-N-per-mm 0.1 --depth-mm 90 -o " + strip.path("out"));
    CHECK(press.status == 2);
    CHECK(contains(press.err, "--depth-mm: found 90, expected at most the device's size, "));
    CHECK_FALSE(std::filesystem::exists(strip.folder / "out"));
}

TEST_CASE("tangible run: the recorded rows of a run give its commands again, without a plant") {
    const StripFolder strip;
    const std::string run = "tangible run " + strip.path("scene.json") + " --json --log ";
    result_of(palpa_with(run + strip.path("a") + " --headless --seconds 1"));
    const std::string replay = " --replay " + strip.path("a/press.tangible.tsv");
    const files::Json json = result_of(palpa_with(run + strip.path("b") + replay));
    CHECK(json["ticks"] == 101);
    CHECK(json["plant"].is_null());
    CHECK(json["command"].is_null());  // the rows do not say what the drives were told
    CHECK(json["missed_ticks"].is_null());
    for (const files::Json& device : json["devices"]) CHECK(device["simulated"] == true);
    files::Table first = files::read_tsv(strip.folder / "a/ticks.tsv");
    files::Table again = files::read_tsv(strip.folder / "b/ticks.tsv");
    while (first.next()) {
        REQUIRE(again.next());
        for (std::size_t i = 0; i < first.columns().size(); ++i) {
            CAPTURE(first.columns()[i]);
            // the plant's force is what nobody knows any more
            CHECK(again.field(i) == (first.columns()[i] == "force_N" ? "n/a" : first.field(i)));
        }
    }
    CHECK_FALSE(again.next());
    const Called both = palpa_with(run + strip.path("c") + replay + " --plant exact");
    CHECK(both.status == 2);
    CHECK(contains(both.err, "--plant: found beside --replay"));
    CHECK_FALSE(std::filesystem::exists(strip.folder / "c"));
}

TEST_CASE("tangible run: a press deeper than the tissue is known for is named") {
    const StripFolder strip;
    files::write_text_atomically(strip.folder / "p.tsv", "t_s\tx_mm\ty_mm\tdepth_mm\n0\t0\t0\t0\n0.4\t0\t0\t9\n");
    const Called deep =
        palpa_with("tangible run " + strip.path("scene.json") + " --headless --json --press " + strip.path("p.tsv"));
    CHECK(deep.status == 0);
    CHECK(contains(deep.err, "goes 9 mm deep, and the tissue is known for 8 mm"));
}

TEST_CASE("tangible run: a press beside the tissue is named, unless the place is fixed or the tissue is a curve") {
    const StripFolder strip;
    files::Json scene = files::read_json(strip.folder / "scene.json");
    const files::Json curve = scene["tissue"];
    scene["tissue"] = {{"map", (kAssets / "maps" / "silicone.map").string()}};
    files::write_text_atomically(strip.folder / "scene.json", scene.dump());
    files::write_text_atomically(strip.folder / "p.tsv", "t_s\tx_mm\ty_mm\tdepth_mm\n0\t60\t60\t0\n0.2\t500\t60\t2\n");
    const std::string run =
        "tangible run " + strip.path("scene.json") + " --headless --json --press " + strip.path("p.tsv");
    const Called beside = palpa_with(run);
    CHECK(beside.status == 0);
    CHECK(contains(beside.err, "p.tsv: 1 of 2 rows are beside the tissue (x "));
    CHECK(contains(result_of(beside)["notes"].dump(), "1 of 2 rows are beside the tissue"));
    scene["tangible"]["at_mm"] = {60, 60};
    files::write_text_atomically(strip.folder / "scene.json", scene.dump());
    CHECK_FALSE(contains(palpa_with(run).err, "beside the tissue"));
    scene["tangible"].erase("at_mm");
    scene["tissue"] = curve;
    files::write_text_atomically(strip.folder / "scene.json", scene.dump());
    CHECK_FALSE(contains(palpa_with(run).err, "beside the tissue"));
}

TEST_CASE("tangible run: a hand that a motion leads has no effect, which is said") {
    const StripFolder strip;
    files::write_text_atomically(strip.folder / "hand.json", R"({"name": "h", "hand": {"mass_kg": 0.2}})");
    files::write_text_atomically(strip.folder / "p.tsv", "t_s\tx_mm\ty_mm\tforce_N\n0\t0\t0\t0\n0.2\t0\t0\t0.1\n");
    const std::string run =
        "tangible run " + strip.path("scene.json") + " --headless --seconds 0.2 --plant " + strip.path("hand.json");
    CHECK(contains(palpa_with(run).out, "hand.json has no effect: the finger follows a motion here"));
    CHECK_FALSE(contains(palpa_with(run + " --press " + strip.path("p.tsv")).out, "has no effect"));
}

TEST_CASE("tangible run: ticks that were missed are named") {
    const StripFolder strip;
    const Called live = palpa_with("tangible run " + strip.path("scene.json") +
                                   " --fidelity converged --rate-Hz 2000 --seconds 0.5 --json");
    const files::Json json = result_of(live);
    REQUIRE(json["missed_ticks"].get<int>() > json["ticks"].get<int>());  // a tick takes far more than 0.5 ms
    CHECK(contains(live.err, "ticks were missed: a tick takes"));
}

TEST_CASE("tangible characterise and fit: a plant that is a tenth stiffer is found from its press") {
    const StripFolder strip;
    const files::Json json = result_of(palpa_with(strip.press("--modulus-factor 1.1 -o " + strip.path("out"))));
    for (const char* key :
         {"wanted_N_per_mm", "rendered_N_per_mm", "force_rms_percent", "hysteresis_N", "saturated_share"})
        CHECK(json["presses"][0].contains(key));
    for (const char* key : {"model", "mesh", "sensor", "delay", "actuator"})
        CHECK(json["contributions_percent"].contains(key));
    for (const char* key : {"depth_mm", "stiffness_N_per_mm", "reachable"}) CHECK(json["reach"].contains(key));
    CHECK(json["contributions_percent"]["model"].get<double>() > 0.5);
    CHECK(json["contributions_percent"]["mesh"] == 0.0);
    const std::string table = strip.path("out/press-0.1-N-per-mm.tsv");
    REQUIRE(std::filesystem::exists(table));
    const std::string fit = "tangible fit " + strip.path("strip.json") + " " + table + " --json -o ";
    CHECK(palpa_with(fit + strip.path("strip.json")).status == 2);  // an input is never replaced
    CHECK(result_of(palpa_with(fit + strip.path("new.json")))["modulus_factor"].get<double>() ==
          close_to(1.1).epsilon(0.02));
    CHECK(files::read_json(strip.folder / "new.json")["fit"].contains("friction_share"));
    const files::Json lag = result_of(palpa_with(fit + strip.path("lag.json") + " --lag"));
    CHECK(lag["lag_ms"] == 0.0);
    CHECK(lag["lag_error_ms"].is_null());
    files::write_text_atomically(strip.folder / "m.tsv",
                                 "time_s\tdepth_mm\tforce_N\tleft_N\tright_N\n0\t4000\t0.1\t1\t1\n");
    const Called metres = palpa_with("tangible fit " + strip.path("strip.json") + " " + strip.path("m.tsv") + " -o " +
                                     strip.path("x.json"));
    CHECK(metres.status == 2);
    CHECK(contains(metres.err, "line 2"));
    CHECK(contains(metres.err, "the device's size"));
}

TEST_CASE("tangible characterise: a press in which the device was mostly relaxed renders no stiffness") {
    const StripFolder strip;
    const std::string press =
        "tangible characterise " + strip.path("strip.json") + " --depth-mm 3 --speed-mm-per-s 20 --stiffness-N-per-mm ";
    const std::string text = palpa_with(press + "1000").out;
    CHECK(contains(text, "NOT RENDERED, the figures are of a device that mostly rested: "));
    CHECK(contains(text, "NOT all that was wanted is reachable"));
    const files::Json hard = result_of(palpa_with(press + "1000 --json"))["presses"][0];
    CHECK(hard["failed_share"].get<double>() > 0.5);
    const std::string soft = palpa_with(press + "0.1").out;
    CHECK(contains(soft, "relaxed, held or without equilibrium in 0 %"));
    CHECK_FALSE(contains(soft, "NOT"));
}

TEST_CASE("tangible: explain names the stages of a scene's soft device, and what a tick of it costs here") {
    const StripFolder folder;
    const files::Json json = result_of(palpa_with("explain " + folder.path("scene.json") + " --json"));
    REQUIRE(json.contains("tangible"));
    const files::Json& stages = json["tangible"]["stages"];
    REQUIRE(stages.size() == 3);
    CHECK(stages[0]["name"] == "world");
    CHECK(stages[1]["name"] == "inverse");
    CHECK(contains(stages[1]["fidelity"].get<std::string>(), "linear: the linear model about the pretension"));
    CHECK(contains(stages[1]["error"].get<std::string>(), "2.9 % (strip)"));
    CHECK(stages[1]["cost_us"].get<double>() > 0.0);
    CHECK(contains(palpa_with("explain " + folder.path("scene.json")).out, "soft device strip"));
}

TEST_CASE("tangible: a device with a wrong key, and one that is not there, are named") {
    const StripFolder strip;
    files::Json json = files::read_json(strip.folder / "strip.json");
    json["cables"][0]["lower_n"] = 1;
    files::write_text_atomically(strip.folder / "wrong.json", json.dump());
    const Called wrong = palpa_with("tangible info " + strip.path("wrong.json"));
    CHECK(wrong.status == 2);
    CHECK(contains(wrong.err, "wrong.json"));
    CHECK(contains(wrong.err, "lower_n"));
    CHECK(palpa_with("tangible info " + strip.path("none.json")).status == 2);
}
