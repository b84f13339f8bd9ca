// A trace through the chain and into a log, as `palpa run --headless --log` does it, without the command line:
//     replay SCENE.json TRACE.tsv FOLDER [REPEATS]
// Prints microseconds per sample of the fastest repeat. Built for node.js and, to compare, for this machine.

#include "session/replay.h"

#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <exception>
#include <memory>
#include <stdexcept>
#include <stdlib.h>
#include <utility>

#include "app/scene_choices.h"
#include "scene/advance.h"

using namespace palpa;
using namespace palpa::platform;
using namespace palpa::scene;
using namespace palpa::session;
using namespace palpa::app;

namespace {

double seconds() { return std::chrono::duration<double>(std::chrono::steady_clock::now().time_since_epoch()).count(); }

// What a sample and a frame cost without a trial and its log.
void run_chain(const Scene& scene, const Plan& plan, const Trace& trace) {
    State state = start(scene, plan, screen_of(trace.info));
    state.time_every = 0;
    VirtualDisplay display;
    for (const Sample& sample : trace.samples) {
        advance(scene, plan, sample, state);
        show_due(scene, plan, state, display);
    }
}

void run(const char* scene_file, const char* trace_file, const char* folder, int repeats) {
    Session session;
    Scene chosen = load_scene(scene_file);
    auto plan = std::make_shared<const Plan>(make_plan(chosen));
    change_tissue(std::move(chosen), std::move(plan), {}, session);
    const Trace trace = read_trace(trace_file);
    double best_s = 1e300;
    for (int i = 0; i < repeats; ++i) {
        const double began_s = seconds();
        run_chain(session.scene, *session.plan, trace);
        best_s = std::min(best_s, seconds() - began_s);
    }
    begin_replay({folder, "01", ""}, trace.info, std::nullopt, session);
    replay(trace, session);
    if (!close_files({}, session)) throw std::runtime_error("the log could not be written");
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
