// palpa bench trace: the trace of a simulated pen, for measurements.

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/command_line.h"
#include "app/commands/option_checks.h"
#include "app/scene_choices.h"
#include "files/input_error.h"
#include "files/progress_line.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "session/plan_in_progress.h"
#include "session/raster_trace.h"

namespace palpa::app {
namespace {

struct TraceOptions {
    std::string scene;
    std::string output;
    session::RasterOptions raster;
    double speed_mm_per_s = 30.0;
};

void write_raster(const TraceOptions& options) {
    const scene::Scene scene = load_scene(options.scene);
    files::check_output(options.output, inputs_of(scene));
    constexpr double kMostSamples = 2e7;  // some 2 GB
    if (options.raster.rate_Hz * options.raster.seconds > kMostSamples)
        throw files::bad_input("--seconds", "",
                               files::short_number(options.raster.seconds) + " s at " +
                                   files::short_number(options.raster.rate_Hz) + " Hz",
                               "at most 2e7 samples, some 2 GB");
    session::RasterOptions raster = options.raster;
    raster.speed_m_per_s = 1e-3 * options.speed_mm_per_s;
    const scene::Plan plan = session::make_plan_here(scene);
    check_force_N(raster.force_N, scene, plan.profile);
    std::size_t samples = 0;
    bool whole = false;
    {
        files::ProgressLine line;
        platform::TraceWriter writer(options.output,
                                     session::raster_info(raster));  // refuses files that are there already
        session::draw_raster(scene, plan, raster, [&](const platform::Sample& sample) {
            writer.write(sample);
            if (++samples % 1000 == 0) line.show("drawing", std::min(1.0, sample.t_host_s / raster.seconds));
        });
        whole = writer.sync();
    }
    if (!whole) {  // half a trace would be measured as a whole one
        std::error_code none;
        std::filesystem::remove(options.output, none);
        std::filesystem::remove(std::filesystem::path(options.output).replace_extension(".json"), none);
        throw std::runtime_error(options.output + ": cannot be written to its end (is the disk full?)");
    }
    std::printf("%s: %zu samples of a simulated pen\n", options.output.c_str(), samples);
}

}  // namespace

void add_bench(CLI::App& app) {
    CLI::App* bench = app.add_subcommand("bench", "Measure accuracy and cost, and make traces to measure with");
    bench->require_subcommand(1);
    add_bench_accuracy(*bench);
    add_bench_speed(*bench);
    add_bench_pens(*bench);
    add_bench_visibility(*bench);
    auto options = std::make_shared<TraceOptions>();
    CLI::App* trace = bench->add_subcommand("trace", "Write a trace of a simulated pen that sweeps the tissue");
    trace->add_option("SCENE", options->scene,
                      "scene JSON, map folder or the name of a shipped one (default: the default scene)");
    trace->add_option("-o,--output", options->output, "new trace TRACE.tsv")->required();
    trace->add_option("--rate-Hz", options->raster.rate_Hz, "samples per second (default 120)")
        ->check(CLI::Range(1.0, 1e5));
    trace->add_option("--seconds", options->raster.seconds, "least duration of the trace (default 40)")
        ->check(CLI::Range(0.1, 1e5));
    trace->add_option("--speed-mm-per-s", options->speed_mm_per_s, "speed of the pen (default 30)")
        ->check(CLI::Range(0.1, 1e4));
    trace->add_option("--force-N", options->raster.force_N, "mean force of the pen (default 2.5)")
        ->check(CLI::Range(0.01, 1e3));
    trace->add_option("--seed", options->raster.seed, "seed of the jitter (default 1)");
    trace->callback([options] { write_raster(*options); });
}

}  // namespace palpa::app
