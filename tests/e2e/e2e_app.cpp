// From the X server to the avatar: a pen with pressure strokes the tissue in the app's window; what was
// recorded replays without a window to the same log, byte for byte. Run it under tests/platform/xorg/with-xorg.

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <string>

#include "files/json.h"
#include "files/text.h"
#include "tests/close_to.h"
#include "tests/e2e/run_app.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

constexpr double kScale = 0.94 * 800 / 120.0;      // px per mm of the default scene on 1280 x 800
constexpr double kColumn_px = 64.0 * 96.0 / 25.4;  // the controls, left of the tissue
double x_px(double x_mm) { return 0.5 * (kColumn_px + 1280.0) + (x_mm - 60.0) * kScale; }
double y_px(double y_mm) { return 400.0 - (y_mm - 60.0) * kScale; }

// Hover, press, 25 mm along y = 35 mm at 500 Hz up to the flank of nodule A, and stay there.
int write_script(const std::filesystem::path& file) {
    std::ofstream out(file);
    out << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    int rows = 0;
    const auto row = [&](double t_s, const char* phase, double x_mm, double pressure) {
        out << t_s << "\tpen\t0\t" << phase << '\t' << x_px(x_mm) << '\t' << y_px(35.0) << '\t' << pressure << '\n';
        ++rows;
    };
    row(0.00, "hover", 5.0, 0.0);
    row(0.05, "hover", 5.1, 0.0);
    row(0.10, "down", 5.2, 0.76);
    for (int i = 1; i <= 410; ++i) row(0.10 + 0.002 * i, "move", 5.2 + 0.06 * i, 0.76);
    return rows;
}

}  // namespace

TEST_CASE("app: a pen on a real X server presses the tissue, and the run replays byte for byte") {
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder / name).string(); };
    const int rows = write_script(folder / "script.tsv");
    const std::string arguments = "--quit-after-s 8 --log " + path("live") + " --screenshot " + path("p.png");
    REQUIRE(run_app(folder, arguments, [&] { CHECK(play_script(folder) == 0); }) == 0);

    const Json result = read_json(folder / "out.json");
    MESSAGE("samples ", result["samples"].dump(), ", lag ", result["max_lag_mm"].dump(), " mm, sample to frame ",
            result["latency_ms"].dump(), " ms, CPU a frame ", result["frame_cpu_ms"].dump(), " ms");
    CHECK(result["samples"].get<int>() >= rows - 1);  // the first hover may be the server's own entry into the window
    CHECK(result["samples"].get<int>() <= rows + 4);
    CHECK(result["max_force_N"].get<double>() == close_to(0.1008 * std::exp(4.2081 * 0.76)).epsilon(1e-3));
    CHECK(result["max_lag_mm"].get<double>() > 0.5);
    CHECK(result["dropped_steps"] == 0);
    CHECK(result["counts"]["without_level"] == 0);

    const std::string replay = std::string(PALPA_PROGRAM " run --headless --replay ") + path("t.tsv") + " --log " +
                               path("again") + " >/dev/null";
    CHECK(shell(replay) == 0);
    const std::string log = "/sub-01/beh/sub-01_task-palpation_run-01_samples.tsv";
    const std::string live = read_text(path("live") + log);
    CHECK(live == read_text(path("again") + log));
    CHECK(live.find("pen\tmove") != std::string::npos);

    CHECK(std::filesystem::file_size(folder / "p.png") > 20000);
}
