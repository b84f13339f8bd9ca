// A calibration session on a real X server: a pen with pressure in the window, a simulated Net F/T under it, one hand
// for both. Run it under tests/platform/xorg/with-xorg.

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <string>
#include <thread>

#include "devices/simulators/process.h"
#include "devices/simulators/stream.h"
#include "files/json.h"
#include "files/text.h"
#include "tests/e2e/run_app.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::devices;
using namespace palpa::test;
using palpa::devices::simulators::SimulatorProcess;

namespace {

// The pen under the hand from `from_s` of the steady clock on, 200 Hz: level = log(F / 0.05) / log(2.5 / 0.05).
void write_pen(const simulators::StreamOptions& hand, double from_s, double seconds,
               const std::filesystem::path& file) {
    std::ofstream out(file);
    out << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    out << "-1.5\tpen\t0\thover\t600\t400\t0\n";
    bool down = false;
    for (int i = 0; i < static_cast<int>(200.0 * seconds); ++i) {
        const double felt_N = std::max(simulators::hand_N(hand, from_s + 0.005 * i), 1e-9);
        const double level = std::clamp(std::log(felt_N / 0.05) / std::log(2.5 / 0.05), 0.0, 1.0);
        const char* phase = level > 0.0 ? (down ? "move" : "down") : (down ? "up" : "hover");
        down = level > 0.0;
        out << 0.005 * i << "\tpen\t0\t" << phase << '\t' << 600 + i % 2 << "\t400\t" << level << '\n';
    }
    // a pen that stayed down at one level would be paired with the hand's further presses
    if (down) out << seconds << "\tpen\t0\tup\t600\t400\t0\n";
}

}  // namespace

TEST_CASE("record: a pen on a real X server and a force sensor give points of one curve") {
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder / name).string(); };
    simulators::StreamOptions hand;
    hand.steps = 16;  // each too short to be taken for the sensor's rest before the pen is there
    hand.greatest_N = 2.4;
    hand.period_s = 5.0;
    SimulatorProcess sensor(PALPA_NETFT_SIMULATOR,
                            {"--rate-Hz", "1000", "--steps", "16", "--greatest-N", "2.4", "--period-s", "5"});
    int status = -1;
    std::thread session([&] {
        const std::string command = "timeout 60 " PALPA_PROGRAM " calibrate record -o " + path("s") +
                                    " --sensor netft:127.0.0.1:" + sensor.port() +
                                    " --steady-s 0.12 --seconds 18 --json >" + path("out.json");
        status = shell(command);
    });
    // the streams are opened after the window, so the pen may come once they are there
    for (int i = 0; i < 200 && !std::filesystem::exists(folder / "s/levels-01.tsv"); ++i) sleep_s(0.05);
    sleep_s(1.5);
    const double from_s = steady_s() + 2.0;  // time to open the device; from then on one hand moves pen and sensor
    write_pen(hand, from_s, 11.0, folder / "pen.tsv");
    CHECK(shell("timeout 40 " PALPA_XORG_PEN " " + path("pen.tsv") + " " + number_text(from_s)) == 0);
    session.join();
    REQUIRE(status == 0);
    const Json result = read_json(folder / "out.json");
    CHECK(result["points"].get<int>() > 12);
    CHECK(result["samples"].get<int>() > 2000);
    CHECK(result["sensor"]["health"]["lost"] == 0);

    const std::string fit = "timeout 60 " PALPA_PROGRAM " calibrate fit " + path("s/points.csv") + " -o " +
                            path("p.json") + " --json >" + path("fit.json");
    CHECK(shell(fit) == 0);
    const Json fitted = read_json(folder / "fit.json");
    MESSAGE(result["points"].dump(), " points of ", result["repeats"].dump(), " presses, off by ",
            fitted["median_relative_error"].dump());
    CHECK(fitted["median_relative_error"].get<double>() < 0.05);
}
