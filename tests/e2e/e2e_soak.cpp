// Two fingers with pressure at 1,000 Hz each: every event of theirs is a row of the trace. 3 s; as long as
// PALPA_SOAK_S says in scripts/soak. Run it under tests/platform/xorg/with-xorg.

#include <cmath>
#include <doctest/doctest.h>
#include <fstream>
#include <stdlib.h>
#include <string>

#include "files/json.h"
#include "platform/trace.h"
#include "tests/e2e/run_app.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::test;

namespace {

// Both fingers move and press at each millisecond. Returns how many moves each makes.
int write_script(const std::filesystem::path& file, double seconds) {
    std::ofstream out(file);
    out << "t_s\tkind\tid\tphase\tx_px\ty_px\tpressure\n";
    const int n = static_cast<int>(1000.0 * seconds);
    const auto row = [&](double t_s, int id, const char* phase) {
        const double x_px = 600.0 + 250.0 * id + 80.0 * std::sin(2.0 * t_s);
        const double y_px = 400.0 + 80.0 * std::cos(3.0 * t_s);
        out << t_s << "\ttouch\t" << id << '\t' << phase << '\t' << x_px << '\t' << y_px << '\t'
            << 0.5 + 0.3 * std::sin(5.0 * t_s) << '\n';
    };
    for (const int id : {0, 1}) row(0.0, id, "down");
    for (int i = 1; i <= n; ++i) {
        for (const int id : {0, 1}) row(0.001 * i, id, "move");
    }
    for (const int id : {0, 1}) row(seconds + 0.01, id, "up");
    return n;
}

}  // namespace

TEST_CASE("app: two pointers at 1,000 Hz, and no sample is lost") {
    const TemporaryFolder folder;
    const auto path = [&](const char* name) { return (folder / name).string(); };
    const char* wanted = ::getenv("PALPA_SOAK_S");
    const double seconds = wanted != nullptr ? std::stod(wanted) : 3.0;
    const int moves = write_script(folder / "script.tsv", seconds);
    const std::string arguments = "--quit-after-s " + std::to_string(seconds + 6.0) + " --log " + path("log");
    REQUIRE(run_app(folder, arguments, [&] { CHECK(play_script(folder) == 0); }) == 0);
    const Trace trace = read_trace(folder / "t.tsv");
    std::int64_t first = 0;
    int counts[2] = {0, 0};
    for (const Sample& sample : trace.samples) {
        if (sample.tool != Tool::finger || sample.phase != Phase::move) continue;
        if (first == 0) first = sample.pointer_id;
        ++counts[sample.pointer_id == first ? 0 : 1];
    }
    const Json result = read_json(folder / "out.json");
    MESSAGE(counts[0], " and ", counts[1], " of ", moves, " moves; sample to frame ", result["latency_ms"].dump(),
            " ms, besides drawing ", result["latency_besides_drawing_ms"].dump(), " ms, frame ",
            result["frame_cpu_ms"].dump(), " ms");
    CHECK(counts[0] == moves);
    CHECK(counts[1] == moves);
    CHECK(result["dropped_steps"] == 0);
}
