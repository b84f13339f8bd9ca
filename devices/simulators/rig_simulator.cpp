// Simulates the wires of a soft device (a file with its rig) on pseudo-terminals, with a finger that goes to and fro whatever
// the actuators do: for tests of the wires. Prints "port NAME=PATH ..." first, and at its end whether a target ever left its
// range. To unplug it closes the terminals; plugged in again, new ones stand behind the same --links.

#include <CLI/CLI.hpp>

#include "devices/simulators/rig_wires.h"
#include "devices/simulators/stream.h"
#include "devices/simulators/truth_file.h"
#include "files/text.h"
#include "platform/real_time.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::devices::simulators;

namespace {

std::string truth_row(const ActuatorRig& rig, const RigWires& wires, double now_s) {
    bool relaxed = true;
    std::string row = files::number_text(now_s);
    for (std::size_t i = 0; i < rig.channels.size(); ++i) {
        relaxed = relaxed && wires.relaxed(i);
        row += '\t' + files::number_text(wires.value(i));
    }
    return row + (relaxed ? "\t1\n" : "\t0\n");
}

}  // namespace

int main(int argc, char** argv) {
    std::string file, truth_path;
    WiresOptions options;
    double depth_mm = 6.0, period_s = 4.0;
    CLI::App app("Simulated wires of a soft device on pseudo-terminals");
    app.add_option("RIG", file, "file with its ports and actuators")->required();
    app.add_option("--truth", truth_path,
                   "table of what the actuators do, every 2 ms: time, values, 1 if all is relaxed");
    app.add_option("--depth-mm", depth_mm, "of each press")->capture_default_str();
    app.add_option("--period-s", period_s, "from one press to the next")->check(CLI::Range(0.1, 1e3));
    add_wires_options(app, options);
    CLI11_PARSE(app, argc, argv);
    try {
        const files::Json json = files::read_json(file);
        const ActuatorRig rig = read_rig(files::JsonReader(json, file));
        RigWires wires(rig, options);
        TruthFile truth(truth_path);
        listen_to_signals();  // before the line of its port: who has read that may end it
        std::printf("port %s\n", wires.ports().c_str());
        std::fflush(stdout);
        platform::set_real_time(true);
        constexpr double kTruth_s = 2e-3;
        for (double truth_s = 0.0; ended == 0;) {
            wires.run();
            const double turn = 2.0 * std::numbers::pi * wires.elapsed_s() / period_s;
            wires.show_displacement(1e-3 * depth_mm * (0.5 - 0.5 * std::cos(turn)));
            if (!truth.wanted() || wires.elapsed_s() < truth_s) continue;
            truth.add(truth_row(rig, wires, steady_s()));
            truth_s = wires.elapsed_s() + kTruth_s;
        }
        std::printf("out_of_range %lld\n", static_cast<long long>(wires.out_of_range()));
    } catch (const std::exception& error) {
        std::fprintf(stderr, "rig_simulator: %s\n", error.what());
        return 2;
    }
    return 0;
}
