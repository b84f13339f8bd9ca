// Simulates the Maestro boards of a shape display (device file) on a pseudo-terminal, with their servos and pins. Prints
// "port PATH" first, and at its end what came. To unplug it closes the terminal; plugged in again, a new one stands behind
// the same --link.

#include <CLI/CLI.hpp>
#include <poll.h>

#include "devices/simulators/line_faults.h"
#include "devices/simulators/maestro_board.h"
#include "devices/simulators/stream.h"
#include "devices/simulators/terminal.h"
#include "platform/real_time.h"

using namespace palpa;
using namespace palpa::devices;
using namespace palpa::devices::simulators;

namespace {

void write_head(const PinDevice& device, std::FILE* file) {
    std::fprintf(file, "t_host_s");
    for (std::size_t i = 0; i < device.pins.size(); ++i) std::fprintf(file, "\tpin_%zu_mm", i);
    std::fprintf(file, "\n");
}

void write_heights(double now_s, const MaestroBoards& boards, std::FILE* file) {
    std::fprintf(file, "%.6f", now_s);
    for (const SimulatedPin& pin : boards.pin) std::fprintf(file, "\t%.5f", 1e3 * pin.height_m);
    std::fprintf(file, "\n");
    std::fflush(file);
}

void talk(const LineFaults& faults, const Terminal& terminal, MaestroBoards& boards, std::mt19937_64& random) {
    std::uint8_t bytes[1024];
    const ssize_t n = ::read(terminal.master, bytes, sizeof bytes);
    if (n > 0) take_bytes(through(faults, std::span(bytes, static_cast<std::size_t>(n)), random), boards);
    const std::vector<std::uint8_t> reply = through(faults, boards.out, random);
    boards.out.clear();
    const ssize_t written = reply.empty() ? 0 : ::write(terminal.master, reply.data(), reply.size());
    static_cast<void>(written);  // without a reader the reply is lost
}

}  // namespace

int main(int argc, char** argv) {
    StreamOptions options;
    std::string file, link, heights;
    double timeout_ms = -1.0, scatter = 0.0;
    bool no_crc = false;
    std::vector<std::size_t> stuck;
    LineFaults faults;
    CLI::App app("Simulated Pololu Maestro boards with servos and pins on a pseudo-terminal");
    const auto share = CLI::Range(0.0, 1.0);
    app.add_option("DEVICE", file, "device file of the pins")->required();
    add_link_option(app, link);
    app.add_option("--heights", heights, "table of the pins' true heights, every 4 ms");
    app.add_option("--seed", options.seed)->capture_default_str();
    app.add_option("--scatter", scatter, "share by which the pins differ from the device file")->check(share);
    app.add_option("--timeout-ms", timeout_ms, "the boards' own setting, 0: off (default: as in the device file)");
    app.add_flag("--no-crc", no_crc, "boards that check no CRC");
    app.add_option("--stuck", stuck, "pins that never move");
    add_line_options(app, faults);
    app.add_option("--silent-from-s", options.silent_from_s, "unplugged then, or at SIGUSR1");
    app.add_option("--silent-s", options.silent_s, "for so long");
    CLI11_PARSE(app, argc, argv);
    MaestroBoards boards;
    try {
        const PinDevice device = read_pin_device(file);
        MaestroSettings settings;
        settings.timeout_s = timeout_ms < 0.0 ? device.timeout_s : 1e-3 * timeout_ms;
        settings.crc = !no_crc && device.boards.front().address.crc;
        settings.frame_s = device.frame_s;
        settings.pin_speed_m_per_s = device.speed_m_per_s;
        boards = make_maestro_boards(device, settings, scatter, options.seed);
    } catch (const std::exception& error) {
        std::fprintf(stderr, "maestro_simulator: %s\n", error.what());
        return 2;
    }
    for (const std::size_t pin : stuck) {
        if (pin >= boards.pin.size()) {
            std::fprintf(stderr, "maestro_simulator: --stuck: found %zu, expected a pin from 0 to %zu\n", pin,
                         boards.pin.size() - 1);
            return 2;
        }
        boards.pin[pin].stuck = true;
    }
    std::FILE* truth = heights.empty() ? nullptr : std::fopen(heights.c_str(), "w");
    Terminal terminal = plug_in(link);
    if (terminal.master < 0 || (!heights.empty() && truth == nullptr)) {
        std::perror("maestro_simulator");
        return 1;
    }
    if (truth != nullptr) write_head(boards.device, truth);
    listen_to_signals();  // before the line of its port: who has read that may end it
    std::printf("port %s\n", link.empty() ? terminal.path.c_str() : link.c_str());
    std::fflush(stdout);
    platform::set_real_time(true);

    std::mt19937_64 random(options.seed);
    const double began_s = steady_s();
    for (double truth_s = began_s; ended == 0;) {
        pollfd waiting{terminal.master, POLLIN, 0};
        ::poll(&waiting, 1, 1);
        const double now_s = steady_s();
        const bool gone = silent(options, now_s - began_s);
        if (gone && terminal.master >= 0) unplug(terminal);
        if (!gone && terminal.master < 0) terminal = plug_in(link);
        // in whole milliseconds, so that a busy line does not make the steps small
        if (const double due_s = now_s - began_s - boards.time_s; due_s >= 1e-3)
            advance(1e-3 * std::floor(1e3 * due_s), boards);
        if (terminal.master >= 0) talk(faults, terminal, boards, random);
        constexpr double kTruth_s = 4e-3;
        if (truth == nullptr || now_s < truth_s) continue;
        write_heights(now_s, boards, truth);
        truth_s = now_s + kTruth_s;
    }
    for (const SimulatedBoard& board : boards.board) {
        std::printf("board %d commands %lld errors %lld timeouts %lld\n", board.address.device,
                    static_cast<long long>(board.commands), static_cast<long long>(board.error_events),
                    static_cast<long long>(board.timeouts));
    }
    if (!link.empty()) std::filesystem::remove(link);
    if (truth != nullptr && std::fclose(truth) != 0) {
        std::fprintf(stderr, "maestro_simulator: %s: could not be written to its end\n", heights.c_str());
        return 1;
    }
    return 0;
}
