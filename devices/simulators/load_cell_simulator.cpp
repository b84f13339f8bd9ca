// Simulates an Arduino with an HX711 on a pseudo-terminal, which sends lines "t_us,raw". Prints "port PATH" first, and at
// its end what it sent. To unplug it closes the terminal; plugged in again, a new one stands behind the same --link.

#include <filesystem>
#include <string>
#include <unistd.h>

#include "devices/load_cell.h"
#include "devices/simulators/stream.h"
#include "devices/simulators/terminal.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::devices::simulators;

int main(int argc, char** argv) {
    StreamOptions options;
    std::string link;
    std::uint32_t first_us = 0;
    double counts_per_N = 40000.0;
    std::int32_t zero = 84000;
    double garble = 0.0;
    CLI::App app("A simulated load cell (HX711, Arduino) on a pseudo-terminal");
    add_stream_options(app, options);
    add_link_option(app, link);
    app.add_option("--first-us", first_us, "of the clock, to see it wrap around");
    app.add_option("--counts-per-N", counts_per_N, "below zero: the cell pulls")
        ->check(CLI::Range(-1e12, 1e12))
        ->capture_default_str();
    app.add_option("--zero", zero, "counts without load")->capture_default_str();
    app.add_option("--garble", garble, "share of the lines with a broken character")->check(CLI::Range(0.0, 1.0));
    CLI11_PARSE(app, argc, argv);
    if (!std::isfinite(counts_per_N)) {
        std::fprintf(stderr, "load_cell_simulator: --counts-per-N: found %g, expected a finite number\n", counts_per_N);
        return 2;
    }
    Terminal terminal = plug_in(link);
    if (terminal.master < 0) {
        std::perror("load_cell_simulator");
        return 1;
    }
    listen_to_signals();  // before the line of its port: who has read that may end it
    std::printf("port %s\n", link.empty() ? terminal.path.c_str() : link.c_str());
    std::fflush(stdout);

    Line<LoadCellLine> line(options);
    const auto send = [&](const LoadCellLine& reading) {
        std::string text = std::to_string(reading.t_us) + "," + std::to_string(reading.raw) + "\r\n";
        if (std::uniform_real_distribution<double>()(line.random) < garble) text[text.size() / 2] = '?';
        const ssize_t n = ::write(terminal.master, text.data(), text.size());  // without a reader the text is lost
        static_cast<void>(n);
    };
    const double began_s = steady_s();
    const double step_s = 1.0 / options.rate_Hz;
    for (double due_s = began_s; ended == 0 && (options.seconds <= 0.0 || due_s - began_s < options.seconds);
         due_s += step_s) {
        std::this_thread::sleep_for(std::chrono::duration<double>(std::max(0.0, due_s - steady_s())));
        const bool gone = silent(options, due_s - began_s);
        if (gone && terminal.master >= 0) unplug(terminal);
        if (!gone && terminal.master < 0) terminal = plug_in(link);
        if (gone) continue;
        LoadCellLine reading;
        reading.t_us = first_us + static_cast<std::uint32_t>(static_cast<std::int64_t>(1e6 * (due_s - began_s)));
        const double force_N = hand_N(options, due_s - options.lag_s) + line.noise_N();
        reading.raw = zero + static_cast<std::int32_t>(std::lround(counts_per_N * force_N));
        line.pass(reading, send);
    }
    print_sent(line.sent);
    // keeps the terminal until the reader has taken what was sent
    for (int i = 0; i < 20 && ended == 0; ++i) std::this_thread::sleep_for(std::chrono::milliseconds(50));
    if (!link.empty()) std::filesystem::remove(link);
    return 0;
}
