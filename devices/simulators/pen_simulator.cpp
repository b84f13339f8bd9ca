// Simulates a pen under the same hand as the simulated sensors. Prints its level, one line per sample, as `palpa calibrate
// record --levels` reads it. Level = log(F / first) / log(full / first), 0 below `first`, 1 above `full`.

#include <algorithm>

#include "devices/simulators/stream.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::devices::simulators;

int main(int argc, char** argv) {
    StreamOptions options;
    options.rate_Hz = 200.0;
    double first_N = 0.05;
    double full_N = 2.5;
    CLI::App app("A simulated pen's pressure on standard output");
    add_stream_options(app, options);
    app.add_option("--first-N", first_N, "first response")->capture_default_str();
    app.add_option("--full-N", full_N, "full pressure")->capture_default_str();
    CLI11_PARSE(app, argc, argv);
    listen_to_signals();
    Line<double> line(options);
    const double began_s = steady_s();
    for (double due_s = began_s; ended == 0 && (options.seconds <= 0.0 || due_s - began_s < options.seconds);
         due_s += 1.0 / options.rate_Hz) {
        std::this_thread::sleep_for(std::chrono::duration<double>(std::max(0.0, due_s - steady_s())));
        const double felt_N = std::max(hand_N(options, due_s - options.lag_s) + line.noise_N(), 1e-9);
        const double level = std::clamp(std::log(felt_N / first_N) / std::log(full_N / first_N), 0.0, 1.0);
        const bool gone = std::printf("%.4f\n", level) < 0 || std::fflush(stdout) != 0;
        if (gone) break;  // nobody reads
    }
    return 0;
}
