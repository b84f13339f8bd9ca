// palpa tactile pins: whether a shape display's boards are safe; what its pins' pulses mean.

#include <CLI/CLI.hpp>
#include <atomic>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <iostream>
#include <memory>
#include <optional>
#include <thread>
#include <unistd.h>

#include "app/commands/command_line.h"
#include "devices/pin_calibration.h"
#include "devices/pin_line.h"
#include "devices/simulators/process.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/printable.h"
#include "files/regular_file.h"
#include "files/temporary_folder.h"
#include "files/text.h"

namespace palpa::app {
namespace {

using devices::BoardHealth;
using devices::PinDevice;
using devices::simulators::SimulatorProcess;

struct PinsOptions {
    std::string device;
    bool simulate = false;
    std::optional<double> timeout_ms;
    bool no_crc = false;
    bool move = false;
    std::uint64_t seed = 1;
    double scatter = 0.1;
    std::string output;
    int pulses = 5;
    bool json = false;
};

std::unique_ptr<SimulatorProcess> simulated_pins(const PinsOptions& options, const std::vector<std::string>& more,
                                                 PinDevice& device) {
    if (!options.simulate) return nullptr;
    std::vector<std::string> arguments{options.device};
    if (options.timeout_ms)
        arguments.insert(arguments.end(), {"--timeout-ms", files::number_text(*options.timeout_ms)});
    if (options.no_crc) arguments.push_back("--no-crc");
    arguments.insert(arguments.end(), more.begin(), more.end());
    auto simulator =
        std::make_unique<SimulatorProcess>(devices::simulators::simulator_program("maestro_simulator"), arguments);
    device.port = simulator->port();
    return simulator;
}

void nap(double seconds) { std::this_thread::sleep_for(std::chrono::duration<double>(seconds)); }

// Holds all pins at these heights for a time, as the driver would.
void hold(const PinDevice& device, const std::vector<double>& heights_m, double seconds, devices::PinLine& line) {
    devices::PinFrame frame;
    devices::pin_frame(device, heights_m, frame);
    for (double done_s = 0.0; done_s < seconds && !line.gone; done_s += device.frame_s) {
        devices::write_line(frame.view(), line);
        nap(device.frame_s);
    }
}

// Holds them in a thread, while a person measures and types. The line is its own meanwhile.
class Holder {
  public:
    Holder(const PinDevice& device, const std::vector<double>& heights_m, devices::PinLine& line)
        : thread_([&, this] {
              while (!done_) hold(device, heights_m, device.frame_s, line);
          }) {}
    ~Holder() {
        done_ = true;
        thread_.join();
    }
    Holder(const Holder&) = delete;
    Holder& operator=(const Holder&) = delete;

  private:
    std::atomic<bool> done_{false};
    std::thread thread_;
};

// Lifts one pin after the other, so that a person sees whether each channel moves the pin that it should.
void move_each(const PinDevice& device, devices::PinLine& line) {
    constexpr double kHold_s = 0.4;
    std::vector<double> heights_m(device.pins.size(), device.rest_m);
    for (std::size_t i = 0; i < heights_m.size(); ++i) {
        if (::isatty(STDERR_FILENO) != 0)
            std::fprintf(stderr, "\r\033[Krow %zu, column %zu", i / static_cast<std::size_t>(device.columns) + 1,
                         i % static_cast<std::size_t>(device.columns) + 1);
        heights_m[i] = device.stroke_m;
        hold(device, heights_m, kHold_s, line);
        heights_m[i] = device.rest_m;
    }
    hold(device, heights_m, kHold_s, line);
    if (::isatty(STDERR_FILENO) != 0) std::fprintf(stderr, "\r\033[K");
}

const char* verdict(const BoardHealth& board, bool wants_crc) {
    if (!board.answers) return "does not answer: power, wiring, baud rate, device number?";
    if (!board.timeout)
        return "NO TIMEOUT in one and a half times the device file's timeout_ms and two frames: its pins would stay up "
               "longer, or for ever, when Palpa is gone; set that timeout in the board";
    if (wants_crc && !board.crc) return "NO CRC: it would take garbled targets; switch CRC on in the board";
    return "safe";
}

files::Json board_json(const BoardHealth& board) {
    return {{"device", board.device},
            {"answers", board.answers},
            {"timeout", board.timeout},
            {"crc", board.crc},
            {"errors", board.errors}};
}

void test_pins(const PinsOptions& options) {
    if (!options.simulate && (options.timeout_ms || options.no_crc))
        throw files::bad_input(options.timeout_ms ? "--timeout-ms" : "--no-crc", "", "no --simulate",
                               "both: it stands in the boards' own settings");
    PinDevice device = devices::read_pin_device(options.device);
    const auto simulator = simulated_pins(options, {}, device);
    devices::PinLine line(device);
    std::vector<BoardHealth> boards(device.boards.size());
    devices::prove_boards(device, line, boards);
    const devices::PinState state = devices::state_of(device, line, boards);
    if (options.move && state == devices::PinState::driving && devices::set_speeds(device, line))
        move_each(device, line);

    files::Json json{{"device", options.device}, {"port", device.port}, {"simulated", options.simulate}};
    json["boards"] = files::Json::array();
    std::string wrong;
    for (std::size_t i = 0; i < boards.size(); ++i) {
        const bool wants_crc = device.boards[i].address.crc;
        const std::string said = verdict(boards[i], wants_crc);
        json["boards"].push_back(board_json(boards[i]));
        if (!options.json)
            std::printf("%sboard %d: %s\n", options.simulate ? "SIMULATED " : "", boards[i].device, said.c_str());
        if (said != "safe")
            wrong += (wrong.empty() ? "" : "; ") + ("board " + std::to_string(boards[i].device) + ": " + said);
        if (!wants_crc)
            std::fprintf(stderr, "palpa: warning: the device file asks for no CRC: garbled targets would be taken\n");
    }
    if (options.json) std::fputs(files::json_text(json).c_str(), stdout);
    if (line.gone) throw std::runtime_error(device.port + ": the port is gone");
    if (!wrong.empty()) throw std::runtime_error(options.device + ": " + wrong);
}

// One line of heights in mm. Throws InputError.
std::vector<double> heights_in(const std::string& text, std::size_t count) {
    std::vector<double> heights_m;
    for (const std::string_view field : files::fields_of(text, ' ')) {
        double height_mm = 0.0;
        if (field.empty()) continue;
        if (!files::parse_number(field, height_mm) || !std::isfinite(height_mm))
            throw files::bad_input("standard input", "", files::shown(field), "a height in mm");
        heights_m.push_back(1e-3 * height_mm);
    }
    if (heights_m.size() != count)
        throw files::bad_input("standard input", "", std::to_string(heights_m.size()) + " numbers",
                               std::to_string(count) + " heights in mm, separated by spaces");
    return heights_m;
}

// Heights that were measured with all pins at one pulse. A slip of a person's is asked again: the lines before it are an
// hour's work.
std::vector<double> typed_heights(std::size_t count, double pulse_share) {
    while (true) {
        std::fprintf(stderr,
                     "all pins at %.0f %% of their pulses: type their %zu heights in mm, row by row, in one line\n",
                     100.0 * pulse_share, count);
        std::string text;
        if (!std::getline(std::cin, text))
            throw files::bad_input("standard input", "", "its end", std::to_string(count) + " heights in mm");
        try {
            return heights_in(text, count);
        } catch (const files::InputError& slip) {
            if (::isatty(STDIN_FILENO) == 0) throw;
            std::fprintf(stderr, "palpa: %s\n", slip.what());
        }
    }
}

// The newest line of the simulator's true heights stands for a gauge.
std::vector<double> gauge_heights(const std::filesystem::path& file, std::size_t count) {
    std::string text = files::read_text(file);
    text.resize(text.rfind('\n') == std::string::npos ? 0 : text.rfind('\n'));  // whole lines
    const auto fields = files::fields_of(std::string_view(text).substr(text.rfind('\n') + 1), '\t');
    std::vector<double> heights_m;
    for (std::size_t i = 1; i < fields.size(); ++i) {
        double height_mm = 0.0;
        files::parse_number(fields[i], height_mm);
        heights_m.push_back(1e-3 * height_mm);
    }
    if (heights_m.size() != count) throw std::runtime_error(file.string() + ": the simulator has written no heights");
    return heights_m;
}

void calibrate_pins(const PinsOptions& options) {
    files::check_output(options.output, {options.device});
    PinDevice device = devices::read_pin_device(options.device);
    const files::TemporaryFolder folder;
    const std::filesystem::path truth = folder / "heights.tsv";
    const auto simulator = simulated_pins(options,
                                          {"--scatter", files::number_text(options.scatter), "--seed",
                                           std::to_string(options.seed), "--heights", truth.string()},
                                          device);
    devices::PinLine line(device);
    std::vector<BoardHealth> boards(device.boards.size());
    devices::prove_boards(device, line, boards);
    if (devices::state_of(device, line, boards) != devices::PinState::driving)
        throw std::runtime_error(options.device + ": its boards are not safe; see palpa tactile pins test");
    devices::set_speeds(device, line);
    devices::PinMeasurements measured;
    for (int i = 0; i < options.pulses; ++i) {
        constexpr double kMargin = 0.05, kSettle_s = 0.6;
        const double share = kMargin + (1.0 - 2.0 * kMargin) * i / (options.pulses - 1);
        const std::vector<double> wanted_m(device.pins.size(), share * device.stroke_m);
        hold(device, wanted_m, kSettle_s, line);
        measured.wanted_m.push_back(share * device.stroke_m);
        std::vector<double> heights_m;
        if (options.simulate) {
            heights_m = gauge_heights(truth, device.pins.size());
        } else {
            const Holder holder(device, wanted_m, line);
            heights_m = typed_heights(device.pins.size(), share);
        }
        if (line.gone) throw std::runtime_error(device.port + ": the port is gone");
        measured.height_m.push_back(std::move(heights_m));
    }
    // heights of boards that no longer listen are those of no pulse
    devices::prove_boards(device, line, boards);
    if (devices::state_of(device, line, boards) != devices::PinState::driving)
        throw std::runtime_error(options.device + ": its boards stopped answering while heights were measured");
    const devices::PinCalibration found = devices::calibrate(device, measured);
    PinDevice calibrated = found.device;
    calibrated.port = devices::read_pin_device(options.device).port;
    const std::string simulated = " (SIMULATED)";  // whoever drives real pins with this file shall see it
    if (options.simulate && !calibrated.name.ends_with(simulated)) calibrated.name += simulated;
    devices::write_pin_device(calibrated, options.output);
    const files::Json json{{"device", options.device},
                           {"simulated", options.simulate},
                           {"error_before_mm", 1e3 * found.before_m},
                           {"error_after_mm", 1e3 * found.after_m},
                           {"written", options.output}};
    if (options.json) {
        std::fputs(files::json_text(json).c_str(), stdout);
    } else {
        std::printf("error rms %.3f mm before, %.3f mm after; %s\n", 1e3 * found.before_m, 1e3 * found.after_m,
                    files::printable(options.output).c_str());
    }
}

}  // namespace

void add_tactile_pins(CLI::App& tactile) {
    CLI::App* pins = tactile.add_subcommand("pins", "A shape display's boards and pins: test, calibrate");
    pins->require_subcommand(1);
    auto options = std::make_shared<PinsOptions>();
    CLI::App* test = pins->add_subcommand(
        "test", "Fall silent once and fail unless every board goes home by itself and refuses garbled commands");
    CLI::App* calibrate = pins->add_subcommand("calibrate", "Find each pin's zero and gain from measured heights");
    for (CLI::App* command : {test, calibrate}) {
        command->add_option("DEVICE", options->device, "device file of the pins")->required();
        command->add_flag("--simulate", options->simulate, "start simulated boards");
        command->add_flag("--json", options->json, "print one JSON object on standard output");
    }
    test->add_option("--timeout-ms", options->timeout_ms, "of the simulated boards; 0: off")
        ->check(CLI::Range(0.0, 1e6));
    test->add_flag("--no-crc", options->no_crc, "simulated boards that check no CRC");
    test->add_flag("--move", options->move, "then lift each pin in turn, to check the wiring");
    test->callback([options] { test_pins(*options); });
    calibrate->add_option("-o,--output", options->output, "device file to write; replaces a file of that name")
        ->required();
    calibrate->add_option("--pulses", options->pulses, "heights at which the pins are measured")
        ->check(CLI::Range(2, 50))
        ->capture_default_str();
    calibrate->add_option("--seed", options->seed, "of the simulated pins")->needs(calibrate->get_option("--simulate"));
    calibrate->add_option("--scatter", options->scatter, "share by which simulated pins differ from the device file")
        ->check(CLI::Range(0.0, 0.5))
        ->needs(calibrate->get_option("--simulate"))
        ->capture_default_str();
    calibrate->callback([options] { calibrate_pins(*options); });
}

}  // namespace palpa::app
