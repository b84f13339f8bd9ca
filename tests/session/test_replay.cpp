#include <doctest/doctest.h>

#include "app/scene_choices.h"
#include "files/text.h"
#include "session/log_rows.h"
#include "session/raster_trace.h"
#include "session/replay.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::study;
using namespace palpa::session;
using namespace palpa::app;
using namespace palpa::test;

namespace {

std::string log_of(const char* scene_name, const Trace& trace) {
    const TemporaryFolder folder;
    const Scene scene = load_scene(std::string(PALPA_SOURCE_DIR "/assets/scenes/") + scene_name);
    const Plan plan = make_plan(scene);
    const RunFiles files = next_run(folder.path(), "01");
    {
        SampleLog log(files);
        replay(scene, plan, trace, 16,
               [&](const Sample& sample, const State& state) { log.write(row_of(sample, plan, state)); });
    }
    return read_text(files.file("_samples.tsv"));
}

}  // namespace

TEST_CASE("replay: the same trace gives the same log, byte for byte, for every shipped scene") {
    const Trace trace = read_trace(default_trace());
    for (const char* scene : {"default.json", "delay.json", "touchpad.json", "off.json"}) {
        CAPTURE(scene);
        const std::string first = log_of(scene, trace);
        CHECK(first == log_of(scene, trace));
        CHECK(std::count(first.begin(), first.end(), '\n') == static_cast<std::ptrdiff_t>(trace.samples.size() + 1));
        CHECK(first.find("nan") == std::string::npos);
        CHECK(first.find("inf") == std::string::npos);
    }
}

TEST_CASE("replay: over the nodules the avatar lags at least 0.5 mm and 5 times more than beside them") {
    const Scene scene = load_scene("");
    const Plan plan = make_plan(scene);
    const ReplayResult result = replay(scene, plan, read_trace(default_trace()), 0);
    CHECK(result.over.size() == 3);
    for (const NodulePass& pass : result.over) {
        CAPTURE(pass.id);
        CHECK(pass.lag_m > 0.5e-3);
        CHECK(pass.lag_m > 5.0 * result.lag_beside_m);
    }
    CHECK(result.state.counters.dropped_steps == 0);
    CHECK(result.state.counters.off_tissue == 0);
}

TEST_CASE("replay: a trace that was written reads back to the same run") {
    const TemporaryFolder folder;
    const Trace trace = read_trace(default_trace());
    {
        TraceWriter writer(folder / "t.tsv", trace.info);
        for (const Sample& sample : trace.samples) writer.write(sample);
        CHECK(writer.sync());
    }
    CHECK(read_text(folder / "t.tsv") == read_text(default_trace()));
    CHECK(log_of("default.json", read_trace(folder / "t.tsv")) == log_of("default.json", trace));
}

TEST_CASE("replay: a trace made at another rate gives the same lags") {
    const Scene scene = load_scene("");
    const Plan plan = make_plan(scene);
    RasterOptions options;
    options.seconds = 20.0;
    double lag_m[2];
    for (int i = 0; i < 2; ++i) {
        options.rate_Hz = i == 0 ? 133.0 : 1000.0;
        lag_m[i] = replay(scene, plan, raster_trace(scene, plan, options), 0).over[0].lag_m;
    }
    CHECK(lag_m[1] == doctest::Approx(lag_m[0]).epsilon(0.03));  // jitter and rounding differ
}
