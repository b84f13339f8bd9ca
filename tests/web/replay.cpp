// A trace through the chain and into a log, as `palpa run --headless --log` does it, without the command line:
//     replay SCENE.json TRACE.tsv FOLDER [REPEATS]
// Prints microseconds per sample of the fastest repeat. Built for node.js and, to compare, for this machine.

#include "session/replay.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <stdlib.h>

#include "app/scene_choices.h"
#include "session/log_rows.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::study;
using namespace palpa::session;
using namespace palpa::app;

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

void run(const char* scene_file, const char* trace_file, const char* folder, int repeats) {
    const Scene scene = load_scene(scene_file);
    const Plan plan = make_plan(scene);
    const Trace trace = read_trace(trace_file);
    {
        SampleLog log(next_run(folder, "01"));
        replay(scene, plan, trace, 0,
               [&](const Sample& sample, const State& state) { log.write(row_of(sample, plan, state)); });
        if (!log.sync()) throw std::runtime_error("the log could not be written");
    }
    double best_s = 1e300;
    for (int i = 0; i < repeats; ++i) {
        const double began_s = seconds();
        replay(scene, plan, trace, 0);
        best_s = std::min(best_s, seconds() - began_s);
    }
    std::printf("%zu samples, %.3f us per sample\n", trace.samples.size(),
                1e6 * best_s / static_cast<double>(trace.samples.size()));
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) return std::fprintf(stderr, "replay SCENE.json TRACE.tsv FOLDER [REPEATS]\n"), 2;
    setenv("PALPA_ASSETS", PALPA_SOURCE_DIR "/assets", 1);  // node.js hands on no environment
    try {
        run(argv[1], argv[2], argv[3], argc > 4 ? std::atoi(argv[4]) : 5);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "replay: %s\n", error.what());
        return 1;
    }
    return 0;
}
