// One sample from pressure to avatar state on the shipped scenes, against the same scene with every effect
// off, and the parts of it. Each benchmark also reports quantiles of single samples, clock included.

#include <algorithm>
#include <benchmark/benchmark.h>
#include <string>

#include "app/scene_choices.h"
#include "app/screens/tissue_drawing.h"
#include "scene/advance.h"
#include "session/raster_trace.h"
#include "stiffnessmaps/map_file.h"

namespace {

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::stiffnessmaps;
using namespace palpa::avatar;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;

struct Loaded {
    Scene scene;
    Plan plan;
    Trace trace;
    explicit Loaded(const char* name)
        : scene(load_scene(std::string(PALPA_SOURCE_DIR "/assets/scenes/") + name)), plan(make_plan(scene)) {
        RasterOptions options;
        options.rate_Hz = 1000.0;
        options.seconds = 40.0;
        trace = raster_trace(scene, plan, options);
    }
};

void samples(benchmark::State& bench, const char* name) {
    const Loaded loaded(name);
    State state = start(loaded.scene, loaded.plan, {1280, 800});
    std::size_t i = 0;
    for (auto _ : bench) {
        if (i == loaded.trace.samples.size()) {
            bench.PauseTiming();
            state = start(loaded.scene, loaded.plan, {1280, 800});
            i = 0;
            bench.ResumeTiming();
        }
        advance(loaded.scene, loaded.plan, loaded.trace.samples[i++], state);
        benchmark::DoNotOptimize(state.avatar);
    }
    Meter single;
    state = start(loaded.scene, loaded.plan, {1280, 800});
    for (const Sample& sample : loaded.trace.samples) {
        const std::int64_t before_ns = steady_ns();
        advance(loaded.scene, loaded.plan, sample, state);
        single.add_ns(static_cast<double>(steady_ns() - before_ns));
    }
    bench.counters["p50_ns"] = single.quantile_ns(0.5);
    bench.counters["p99_ns"] = single.quantile_ns(0.99);
    bench.counters["worst_ns"] = single.worst_ns();
}

Field shipped_field() { return make_field(read_map(PALPA_SOURCE_DIR "/assets/maps/silicone.map"), {}); }

void depth_look_up(benchmark::State& bench) {
    const Field field = shipped_field();
    double x = 0.0;
    for (auto _ : bench) {
        x = x < 0.11 ? x + 3e-5 : 0.01;
        const Place place = place_at(field, {x, 0.035});
        benchmark::DoNotOptimize(depth_at(field, place, 1.5));
    }
}

void tangential_look_up(benchmark::State& bench) {
    const Field field = shipped_field();
    double x = 0.0;
    for (auto _ : bench) {
        x = x < 0.11 ? x + 3e-5 : 0.01;
        const Place place = place_at(field, {x, 0.035});
        benchmark::DoNotOptimize(tangential_force_N(field, place, {0.8, 0.6}, 4e-3));
    }
}

void surface(benchmark::State& bench) {
    double depth_m = 0.0;
    for (auto _ : bench) {
        depth_m = depth_m < 7e-3 ? depth_m + 1e-5 : 0.0;
        benchmark::DoNotOptimize(surface_curve(depth_m, 4e-3, 25e-3));
    }
}

BENCHMARK_CAPTURE(samples, default_scene, "default.json");
BENCHMARK_CAPTURE(samples, delay_scene, "delay.json");
BENCHMARK_CAPTURE(samples, effects_off, "off.json");
BENCHMARK(depth_look_up);
BENCHMARK(tangential_look_up);
BENCHMARK(surface);

}  // namespace

BENCHMARK_MAIN();
