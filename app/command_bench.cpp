// palpa bench trace: a simulated pen's trace, to measure with.

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/bench_speed.h"
#include "app/command_line.h"
#include "app/load.h"
#include "app/prepare.h"
#include "app/raster_trace.h"

namespace palpa {
namespace {

struct TraceOptions {
    std::string scene;
    std::string output;
    RasterOptions raster;
    double speed_mm_per_s = 30.0;
};

void write_raster(const TraceOptions& options) {
    const Scene scene = load_scene(options.scene);
    RasterOptions raster = options.raster;
    raster.speed_m_per_s = 1e-3 * options.speed_mm_per_s;
    const Trace trace = raster_trace(scene, make_plan_here(scene), raster);
    TraceWriter writer(options.output, trace.info);
    for (const Sample& sample : trace.samples) writer.write(sample);
    if (!writer.sync()) throw std::runtime_error(options.output + ": cannot be written to its end");
    std::printf("%s: %zu samples of a simulated pen\n", options.output.c_str(), trace.samples.size());
}

}  // namespace

void add_bench(CLI::App& app) {
    CLI::App* bench = app.add_subcommand("bench", "What to measure with");
    bench->require_subcommand(1);
    add_bench_accuracy(*bench);
    add_bench_speed(*bench);
    add_bench_pens(*bench);
    auto options = std::make_shared<TraceOptions>();
    CLI::App* trace = bench->add_subcommand("trace", "A simulated pen sweeps the tissue: writes a trace");
    trace->add_option("SCENE", options->scene, "scene JSON or map folder (default: the default scene)");
    trace->add_option("-o,--output", options->output, "new trace TRACE.tsv")->required();
    trace->add_option("--rate-Hz", options->raster.rate_Hz, "samples a second (default 120)")->check(CLI::Range(1.0, 1e5));
    trace->add_option("--seconds", options->raster.seconds, "how long at least (default 40)")->check(CLI::Range(0.1, 1e5));
    trace->add_option("--speed-mm-per-s", options->speed_mm_per_s, "of the pen (default 30)")->check(CLI::Range(0.1, 1e4));
    trace->add_option("--force-N", options->raster.force_N, "pressed with (default 2.5)")->check(CLI::Range(0.01, 1e3));
    trace->add_option("--seed", options->raster.seed, "of the jitter (default 1)");
    trace->callback([options] { write_raster(*options); });
}

}  // namespace palpa
