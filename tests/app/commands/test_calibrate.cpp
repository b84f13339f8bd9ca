// palpa calibrate as a person calls it, and what it reaches on recordings of real pens.

#include <cmath>
#include <doctest/doctest.h>
#include <filesystem>
#include <random>

#include "files/json.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/shell.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

const std::string kPens = PALPA_RECORDINGS "/pens/pressure_response.csv";

Called calibrate(const std::string& arguments, const std::string& command_before = "calibrate ") {
    return shell("timeout 300 " PALPA_PROGRAM " " + command_before + arguments);
}

// 57 points of the paper's touchpad, exact.
std::string touchpad() {
    std::string text = "level,force_N\n";
    for (int i = 0; i < 57; ++i) {
        const double level = 1023.0 * i / 56.0;
        text += number_text(level) + "," + number_text(0.0827 * std::exp(0.0039 * level)) + "\n";
    }
    return text;
}

bool recordings() {
    const bool there = std::filesystem::exists(kPens);
    if (!there) MESSAGE("not checked: the recording is not beside the checkout: ", kPens);
    return there;
}

}  // namespace

TEST_CASE("calibrate fit: exact points give the paper's curve, a profile that the program reads, and every key") {
    const TemporaryFolder folder;
    const std::string data = (folder / "d.csv").string();
    const std::string profile = (folder / "p.json").string();
    write_text_atomically(data, touchpad());
    const Called fit =
        calibrate("fit " + data + " -o " + profile + " --model exponential --error newton --pen 'my pen' --json");
    REQUIRE(fit.status == 0);
    const Json json = parse_json(fit.out, "stdout");
    for (const char* key : {"model", "parameters", "r2_newton", "r2_log", "rmse_N", "relative_error_bands",
                            "activation_force_N", "saturation_force_N", "n_points", "warnings", "force_at_full_N",
                            "hysteresis", "drift", "lag_s", "levels", "intervals"}) {
        CHECK_MESSAGE(json.contains(key), key);
    }
    CHECK(json["n_points"] == 57);
    CHECK(json["relative_error_bands"].size() == 5);
    CHECK(std::abs(json["parameters"]["a_N"].get<double>() / 0.0827 - 1.0) < 1e-9);
    CHECK(std::abs(json["parameters"]["b"].get<double>() / 0.0039 - 1.0) < 1e-9);
    const Json written = read_json(profile);
    CHECK(written["device"]["pen"] == "my pen");
    CHECK(written["level"] == "pressure_raw");
    CHECK(written["level_range"] == Json({0.0, 1023.0}));

    const Called check = calibrate("check " + profile + " " + data + " --json");
    REQUIRE(check.status == 0);
    const Json checked = parse_json(check.out, "stdout");
    CHECK(checked["predicted_N"].size() == 57);
    CHECK(checked["predicted_N"][56].get<double>() == close_to(0.0827 * std::exp(0.0039 * 1023.0)).epsilon(1e-9));
    CHECK(checked["median_relative_error"].get<double>() < 1e-9);
    CHECK(checked["relative_error_bands"].size() == 5);
    write_text_atomically(folder / "still.csv", "level,force_N\n100,0\n500,0\n1000,0\n");
    const Called still = calibrate("check " + profile + " " + (folder / "still.csv").string());
    CHECK(still.status == 2);
    CHECK(contains(still.err, "found no point whose level and force are above 0"));

    const Called compare = calibrate("compare " + profile + " " PALPA_SOURCE_DIR "/assets/profiles/bamboo.json --json");
    REQUIRE(compare.status == 0);
    CHECK(parse_json(compare.out, "stdout")["greatest_relative_difference"].get<double>() < 1e-9);
    CHECK(calibrate("compare " + profile + " " PALPA_SOURCE_DIR "/assets/profiles/s-pen.json").status == 0);
    write_text_atomically(folder / "line.csv", "level,force_N\n0.2,0.2\n0.5,0.5\n0.7,0.7\n0.9,0.9\n");
    const std::string line = (folder / "line.json").string();
    REQUIRE(calibrate("fit " + (folder / "line.csv").string() + " --model power -o " + line).status == 0);
    const Called none = calibrate("compare " + line + " " + line);  // 0 N at level 0, both
    CHECK(none.status == 0);
    CHECK_FALSE(contains(none.out, "nan"));
    const Called run = calibrate(PALPA_SOURCE_DIR "/assets/scenes/off.json --json", "explain ");
    CHECK(run.status == 0);
}

TEST_CASE("calibrate fit: a session says what its levels are; profiles of areas are compared at equal areas") {
    const TemporaryFolder folder;
    // one finger, A = 2200 px2 (F / 1 N)^(2/3), as shares of two areas
    for (const double full_px2 : {8000.0, 12000.0}) {
        const auto session = folder / number_text(full_px2);
        std::filesystem::create_directory(session);
        std::string text = "level,force_N\n";
        for (int i = 1; i <= 40; ++i) {
            const double force_N = 0.1 * i;
            text += number_text(2200.0 * std::pow(force_N, 2.0 / 3.0) / full_px2) + "," + number_text(force_N) + "\n";
        }
        write_text_atomically(session / "points.csv", text);
        write_text_atomically(session / "session.json",
                              R"({"sensor": "netft", "level": "contact_area", "full_contact_area_px2": )" +
                                  number_text(full_px2) + "}\n");
        const Called fit = calibrate("fit " + (session / "points.csv").string() + " --model power -o " +
                                     (session / "p.json").string());
        CHECK(fit.status == 0);
        const Json profile = read_json(session / "p.json");
        CHECK(profile["level"] == "contact_area");
        CHECK(profile["full_contact_area_px2"] == full_px2);
        CHECK(calibrate("fit " + (session / "points.csv").string() + " --full-contact-area-px2 9000 --model power -o " +
                        (session / "own.json").string())
                  .status == 0);
        CHECK(read_json(session / "own.json")["full_contact_area_px2"] == 9000.0);  // an option says otherwise
    }
    const auto profile = [&](const char* full) { return (folder / full / "p.json").string(); };
    const Called compared = calibrate("compare " + profile("8000") + " " + profile("12000") + " --json");
    REQUIRE(compared.status == 0);
    CHECK(Json::parse(compared.out)["median_relative_difference"].get<double>() < 0.02);
}

TEST_CASE("calibrate fit: figures are drawn in all three kinds") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "d.csv", touchpad());
    const auto path = [&](const char* name) { return (folder / name).string(); };
    const std::pair<const char*, const char*> kinds[] = {{"f.png", "\x89PNG"}, {"f.svg", "<?xml"}, {"f.pdf", "%PDF"}};
    for (const auto& [name, magic] : kinds) {
        const Called fit = calibrate("fit " + path("d.csv") + " -o " + path("p.json") +
                                     " --pen \"pen's 5 % \\\"x\\\"\" --plot " + path(name));
        CAPTURE(fit.err);
        CHECK(fit.status == 0);
        CHECK(read_text(path(name)).substr(0, 5).find(std::string(magic).substr(0, 4)) == 0);
    }
    const Called refused = calibrate("fit " + path("d.csv") + " -o " + path("q.json") + " --plot " + path("f.gif"));
    CHECK(refused.status == 2);
    CHECK(contains(refused.err, "expected .png, .svg or .pdf"));
    CHECK_FALSE(std::filesystem::exists(folder / "q.json"));
    const Called same = calibrate("fit " + path("d.csv") + " -o " + path("q.png") + " --plot " + path("./q.png"));
    CHECK(same.status == 2);
    CHECK(contains(same.err, "q.png: found the profile's own name, expected another one for the figure"));
    CHECK_FALSE(std::filesystem::exists(folder / "q.png"));
}

TEST_CASE("calibrate: bad input ends with status 2, names what is wrong, and leaves the old profile alone") {
    const TemporaryFolder folder;
    const std::string profile = (folder / "p.json").string();
    write_text_atomically(profile, "as it was");
    const auto refused = [&](const std::string& text, const std::string& options, const char* word) {
        write_text_atomically(folder / "d.csv", text);
        const Called fit = calibrate("fit " + (folder / "d.csv").string() + " -o " + profile + " " + options);
        CAPTURE(fit.err);
        CHECK(fit.status == 2);
        CHECK(contains(fit.err, word));
        CHECK(read_text(profile) == "as it was");
    };
    refused("level,force_N\n0,1\n1,2\n", "", "2 distinct levels");
    refused("level,force_N\n0,1\n1,2\n", "--full-contact-area-px2 9", "found no --level contact_area");
    refused("level,force_N\n0,1\n1,2\n", "--bootstrap 0 --seed 9", "found no --bootstrap above 0");
    refused("level,force_N\n0,1\n0.5,2\n1,3\n", "--keep-lag", "--keep-lag: found no column time_s in ");
    refused("level,force_N\n0,1\n0.5,1\n1,1\n", "", "the same force");
    refused("level,force_N\n0,1\n0.5,-2\n1,3\n", "", "line 3, force_N");
    refused("level,force_N\n0,1\n0.5,nan\n1,3\n", "", "line 3, force_N");
    refused("level,force_N\n0,10\n0.5,100\n1,300\n", "", "force_gf");
    refused("level,force_N\n0,3\n0.5,2\n1,1\n", "", "do not rise");
    refused("time_s,level,force_N\n0,0,1\n0,0.5,2\n1,1,3\n", "", "line 3, time_s");
    refused(touchpad(), "--where level", "COLUMN=VALUE");
    refused(touchpad(), "--where pen=x", "expected a column 'pen'");
    refused(touchpad(), "--level-range 0 100", "at most 100");
    refused(touchpad(), "--level-range 5 1", "the lower level first");
    refused(touchpad(), "--model spline", "spline");
    CHECK(calibrate("check " + profile + " " + (folder / "d.csv").string()).status == 2);
    CHECK(calibrate("compare " + profile + " " + profile).status == 2);
    // a profile of counts is not checked with shares: it is no matter of another calibration
    write_text_atomically(folder / "counts.csv", touchpad());
    const std::string counts = (folder / "counts.json").string(), shares = (folder / "shares.csv").string();
    REQUIRE(calibrate("fit " + (folder / "counts.csv").string() + " -o " + counts).status == 0);
    write_text_atomically(shares, "level,force_N\n0.2,0.2\n0.5,0.5\n0.9,2\n");
    const Called checked = calibrate("check " + counts + " " + shares);
    CHECK(checked.status == 2);
    CHECK(contains(checked.err, "shares.csv: level: found levels from 0.2 to 0.9, expected counts"));
    // a folder that is not there is wrong input, and named
    const Called nowhere = calibrate("fit " + (folder / "d.csv").string() + " -o " + (folder / "none/p.json").string());
    CHECK(nowhere.status == 2);
    CHECK(contains(nowhere.err, "none/p.json"));
}

TEST_CASE("calibrate fit: reads the recordings of real pens as they are") {
    if (!recordings()) return;
    const TemporaryFolder folder;
    const std::string profile = (folder / "p.json").string();
    const Called fit = calibrate("fit " + kPens + " -o " + profile + " --where inventory_id=HUP.0024 --json");
    REQUIRE(fit.status == 0);
    const Json json = parse_json(fit.out, "stdout");
    CHECK(json["n_points"] == 28);
    CHECK(json["activation_force_N"].get<double>() == close_to(0.127486));
    CHECK(json["saturation_force_N"].get<double>() == close_to(2.476179));
    CHECK(read_json(profile)["device"]["tablet"] == "huion.tablet.h640p");
    CHECK(calibrate("check " + profile + " " + kPens + " --where inventory_id=HUP.0024").status == 0);
    const Called all = calibrate("fit " + kPens + " -o " + profile + " --bootstrap 0");
    CHECK(contains(all.err, "94 sessions"));
}

TEST_CASE("bench pens: auto predicts left-out points of 94 real sessions within the stated bounds") {
    if (!recordings()) return;
    const Called bench = calibrate(kPens + " --json", "bench pens ");
    REQUIRE(bench.status == 0);
    const Json json = parse_json(bench.out, "stdout");
    CHECK(json["sessions"] == 94);
    CHECK(json["sessions_left_out"] == 0);
    for (const std::size_t split : {0u, 2u}) {
        CAPTURE(split);
        const Json& best = json["splits"][split]["curves"].back();
        CHECK(best["curve"] == "auto");
        CHECK(best["failed"] == 0);
        CHECK(best["median_light"].get<double>() < 0.04);
        CHECK(best["p90_light"].get<double>() < 0.30);
        CHECK(best["median_firm"].get<double>() < 0.015);
        CHECK(best["p90_firm"].get<double>() < 0.04);
    }
    // the yardsticks: the paper's exponential and a cubic through all points, on the same split
    const Json& curves = json["splits"][0]["curves"];
    CHECK(curves[0]["median_light"].get<double>() == close_to(0.83).epsilon(0.02));
    CHECK(curves[0]["median_firm"].get<double>() == close_to(0.05).epsilon(0.03));
    CHECK(curves[5]["median_light"].get<double>() == close_to(0.027).epsilon(0.05));
}

TEST_CASE("calibrate fit: intervals need enough resampled fits, or none are asked for") {
    const TemporaryFolder folder;
    const std::string data = (folder / "d.csv").string();
    write_text_atomically(data, touchpad());
    const std::string fit = "fit " + data + " -o " + (folder / "p.json").string() + " --bootstrap ";
    const Called few = calibrate(fit + "1");
    CHECK(few.status == 2);
    CHECK(few.err.find("--bootstrap: found 1, expected 0 (no intervals) or 100 to 100000") != std::string::npos);
    CHECK(calibrate(fit + "0").status == 0);
    CHECK(calibrate(fit + "100").status == 0);
}
