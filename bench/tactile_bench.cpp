// A step of the shape display on the slab of 10,240 nodes: live, by table, and its parts, each against the alternative.
// Each benchmark reports median, 99th percentile and worst of single steps (clock included), and the ratio of its median
// to that of what it is compared with.

#include <benchmark/benchmark.h>
#include <map>
#include <string>

#include "accuracy/timing.h"
#include "files/cache.h"
#include "tactile/table.h"

namespace {

using namespace palpa;
using namespace palpa::tactile;
using accuracy::quantile_us;
using accuracy::Timing;

constexpr int kSteps = 20000;

const scene::LinearTissue& slab() {
    static const scene::LinearTissue tissue = [] {
        scene::LinearOptions options;
        options.phantom = PALPA_SOURCE_DIR "/assets/phantoms/slab.json";
        options.spacing_m = 3.2e-3;
        options.grading = mechanics::Grading{{0.05, 0.05}, 1.5e-3};
        return scene::make_linear_tissue(options, files::cache_folder(), {});
    }();
    return tissue;
}

mechanics::PinShape pins(int per_side, mechanics::Sheet sheet) {
    mechanics::PinGrid grid;
    grid.rows = grid.columns = per_side;
    mechanics::PinShapeOptions options;
    options.sheet = sheet;
    options.dither = true;
    return mechanics::make_pin_shape(grid, options);
}

Renderer renderer_of(FingerContact contact, const mechanics::PinShape& shape) {
    return make_renderer(slab(), {contact, 16e-3, {}}, 1.0, 2.5, observation_of(shape));
}

// A hand that slides at 20 mm/s and presses up to 4 mm deep, at 1 kHz.
Eigen::Vector2d place_m(int k) { return {0.04 + 2e-5 * (k % 1000), 0.047}; }
double depth_m(int k) { return 2e-3 * (1.0 - std::cos(2e-3 * k)); }

// The medians of what was measured before, for the ratios.
std::map<std::string, double>& medians_us() {
    static std::map<std::string, double> list;
    return list;
}

template <class Step>
void measure(benchmark::State& bench, const std::string& name, const std::string& against, Step&& step) {
    int k = 0;
    for (auto _ : bench) step(k++);
    const Timing single = accuracy::time_calls(kSteps, kSteps, 1e9, step);
    medians_us()[name] = quantile_us(single, 0.5);
    bench.counters["p50_us"] = quantile_us(single, 0.5);
    bench.counters["p99_us"] = quantile_us(single, 0.99);
    bench.counters["worst_us"] = quantile_us(single, 1.0);
    const auto other = medians_us().find(against);
    if (other != medians_us().end()) bench.counters["ratio"] = quantile_us(single, 0.5) / other->second;
}

// From the depth to heights that a device could be sent.
struct Road {
    mechanics::PinShape shape;
    Renderer renderer;
    RendererWork work;
    Eigen::VectorXd sink_m, height_m, carried_m, reached_m;
    mechanics::PinReport report;
    Road(FingerContact contact, int per_side, mechanics::Sheet sheet)
        : shape(pins(per_side, sheet)), renderer(renderer_of(contact, shape)), work(make_work(renderer)) {
        const int n = per_side * per_side;
        for (Eigen::VectorXd* list : {&sink_m, &height_m, &carried_m, &reached_m}) list->setZero(n);
    }
    double step(int k) {
        const Press press = press_to_depth(renderer, place_m(k), depth_m(k), work);
        shape_m(renderer, work, sink_m);
        mechanics::pins_from_sinks_m(shape, press.depth_m, sink_m, height_m, report);
        mechanics::slew_pins_m(shape.grid, 1e-3, height_m, reached_m);
        height_m = reached_m;
        mechanics::round_to_steps_m(shape, carried_m, height_m);
        return press.force_N;
    }
};

void live(benchmark::State& bench, const std::string& name, FingerContact contact) {
    Road road(contact, 6, mechanics::Sheet::free);
    measure(bench, name, "live_parabola", [&](int k) { benchmark::DoNotOptimize(road.step(k)); });
}

const Table& table_of(const Renderer& renderer) {
    static std::map<int, Table> made;
    const auto [place, is_new] = made.try_emplace(static_cast<int>(renderer.observed.map.rows()));
    if (is_new) place->second = make_table(renderer, {}, files::cache_folder());
    return place->second;
}

void by_table(benchmark::State& bench, const std::string& name, int per_side) {
    Road road(FingerContact::parabola, per_side, mechanics::Sheet::free);
    const Table& table = table_of(road.renderer);
    if (!table.good) return bench.SkipWithError(table.note.c_str());
    adopt(&table, road.work);
    bench.counters["error_percent"] = 100.0 * table.error;
    bench.counters["shape_error_mm"] = 1e3 * table.shape_error_m;
    bench.counters["table_MB"] = 4e-6 * static_cast<double>(table.value_m.size() + 2 * table.depth_m.size());
    measure(bench, name, "live_parabola", [&](int k) { benchmark::DoNotOptimize(road.step(k)); });
}

// The clock would take longer than the look-up: 100 of them are one step here.
void force_look_up(benchmark::State& bench) {
    Road road(FingerContact::parabola, 6, mechanics::Sheet::free);
    const Table& table = table_of(road.renderer);
    if (!table.good) return bench.SkipWithError(table.note.c_str());
    adopt(&table, road.work);
    measure(bench, "100_force_look_ups", "live_parabola", [&](int k) {
        for (int i = 0; i < 100; ++i)
            benchmark::DoNotOptimize(press_to_depth(road.renderer, place_m(k + i), depth_m(k + i), road.work));
    });
}

void sheet_inverse(benchmark::State& bench) {
    const mechanics::PinShape shape = pins(10, mechanics::Sheet::free);
    const Eigen::VectorXd u_m = Eigen::VectorXd::LinSpaced(shape.sample_m.cols(), 0.0, 1e-3);
    Eigen::VectorXd sink_m(100);
    measure(bench, "sheet_inverse_100", "live_parabola", [&](int) {
        mechanics::pin_sinks_m(shape, u_m, sink_m);
        benchmark::DoNotOptimize(sink_m.data());
    });
}

void make_table_once(benchmark::State& bench) {
    const mechanics::PinShape shape = pins(6, mechanics::Sheet::off);
    const Renderer renderer = renderer_of(FingerContact::parabola, shape);
    for (auto _ : bench) {
        const Table table = make_table(renderer, {}, {});
        bench.counters["places"] = table.count[0] * table.count[1];
        bench.counters["good"] = table.good;
    }
}

BENCHMARK_CAPTURE(live, parabola, "live_parabola", FingerContact::parabola)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(live, rigid, "live_rigid", FingerContact::rigid)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(live, pad, "live_pad", FingerContact::pad)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(by_table, 36_pins, "table_36", 6)->Unit(benchmark::kMicrosecond);
BENCHMARK_CAPTURE(by_table, 100_pins, "table_100", 10)->Unit(benchmark::kMicrosecond);
BENCHMARK(force_look_up)->Unit(benchmark::kMicrosecond);
BENCHMARK(sheet_inverse)->Unit(benchmark::kMicrosecond);
BENCHMARK(make_table_once)->Unit(benchmark::kMillisecond)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
