// `palpa devices` on a real X server: what it lists, and what it says of a pen and fingers that were there. Run it
// under tests/platform/xorg/with-xorg.

#include <doctest/doctest.h>
#include <fstream>
#include <string>
#include <thread>

#include "files/json.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/e2e/run_app.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

int run(const std::string& command) { return shell("timeout 60 " + command); }

const Json& device(const char* tool, const Json& json) {
    for (const Json& entry : json["devices"]) {
        if (entry["tool"] == tool) return entry;
    }
    FAIL("no device that is a " << tool);
    return json;
}

// 2 s: the pen at 250 Hz with rising pressure, two fingers at 100 Hz that always press alike. The window lies in
// the middle of the screen.
void write_script(const std::filesystem::path& file) {
    std::ofstream out(file);
    out << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    const auto row = [&](double t_s, const char* kind, int id, const char* phase, double x_px, double y_px,
                         double pressure) {
        out << t_s << '\t' << kind << '\t' << id << '\t' << phase << '\t' << x_px << '\t' << y_px << '\t' << pressure
            << '\n';
    };
    row(0.0, "pen", 0, "hover", 500.0, 300.0, 0.0);
    for (int i = 0; i < 500; ++i)
        row(0.02 + 0.004 * i, "pen", 0, i == 0 ? "down" : "move", 500.0 + 0.5 * i, 300.0, 0.1 + 0.001 * i);
    row(2.02, "pen", 0, "up", 749.5, 300.0, 0.0);
    for (int i = 0; i < 200; ++i) {
        for (int id = 1; id <= 2; ++id) {
            const char* phase = i == 0 ? "down" : i == 199 ? "up" : "move";
            row(2.1 + 0.01 * i + 0.005 * (id - 1), "touch", id, phase, 400.0 + 200.0 * id + 0.5 * i, 500.0,
                1023.0 / 2047.0);
        }
    }
}

}  // namespace

TEST_CASE("devices: the list") {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.json").string();
    REQUIRE(run(PALPA_PROGRAM " devices --json >" + out) == 0);
    const Json json = read_json(out);
    CHECK(device("pen", json)["levels"] == 1001);
    CHECK(device("pen", json)["pressure_range"] == Json({0.0, 1000.0}));
    CHECK(device("finger", json)["levels"] == 2048);
    CHECK(device("mouse", json)["has_pressure"] == false);
    CHECK(contains(device("pen", json)["axes"].dump(), "Abs Pressure"));
    CHECK_FALSE(json.contains("seen"));

    REQUIRE(run(PALPA_PROGRAM " devices >" + out) == 0);
    CHECK(contains(read_text(out), "pen: pen, pressure 0 to 1000 (1001 levels)"));
}

TEST_CASE("devices: what a pen and two fingers really send") {
    const TemporaryFolder folder;
    const std::string out = (folder / "out.json").string();
    write_script(folder / "script.tsv");
    int status = -1;
    std::thread command([&] { status = run(PALPA_PROGRAM " devices --json --seconds 9 >" + out); });
    sleep_s(3.0);  // its window is there by then, sanitizers and all
    CHECK(play_script(folder) == 0);
    command.join();
    REQUIRE(status == 0);
    const Json json = read_json(out);
    MESSAGE(json["seen"].dump());

    const Json& pen = json["seen"]["pen"];
    CHECK(pen["samples"] == 502);
    CHECK(pen["touching"] == 500);
    CHECK(pen["distinct_pressures"] == 500);
    CHECK(pen["pressure"] == "varies");
    CHECK(pen["pressure_raw_range"] == Json({100.0, 599.0}));
    CHECK(pen["tilt"] == false);
    CHECK(pen["x_px"][1].get<double>() - pen["x_px"][0].get<double>() == close_to(249.5).epsilon(1e-3));
    CHECK(pen["rate_Hz"].get<double>() > 0.0);
    CHECK(pen["clock_drift_ppm"].is_null());  // 2 s are too short

    const Json& finger = json["seen"]["finger"];
    CHECK(finger["samples"] == 400);
    CHECK(finger["pressure"] == "constant");
    CHECK(finger["distinct_pressures"] == 1);
}
