// palpa study simulate PROTOCOL.json --participants N --seed S -o DIR

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <memory>
#include <thread>

#include "app/commands/option_checks.h"
#include "app/commands/study.h"
#include "app/study/simulate.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "study/protocol_checks.h"

namespace palpa::app {
namespace {

struct SimulateArguments {
    SimulateOptions options;
    std::string protocol;
    std::string output;
    std::string samples = "all";
    int jobs = 0;
    bool json = false;
};

void simulate(const SimulateArguments& arguments) {
    SimulateOptions options = arguments.options;
    options.output = arguments.output;
    options.samples = arguments.samples == "all";
    const auto cores = static_cast<int>(std::thread::hardware_concurrency());
    // twice as many threads as cores, since a participant that waits for the disk leaves its core to another
    options.jobs = std::min(options.participants, arguments.jobs > 0 ? arguments.jobs : 2 * std::max(1, cores));
    files::check_output_folder(arguments.output);
    const study::Protocol protocol = study::read_protocol(arguments.protocol);
    if (!std::filesystem::exists(std::filesystem::path(arguments.output) / "protocol.json"))
        study::refuse_mixed_ratings(protocol);
    if (options.practice && protocol.practice_trials == 0)
        throw files::bad_input("--practice", "", arguments.protocol + ", which has no practice trials",
                               "a protocol with practice");
    const SimulateResult result = simulate_study(protocol, options);
    const double MB_per_s = result.wall_s > 0.0 ? result.written_MB / result.wall_s : 0.0;
    if (arguments.json) {
        const files::Json json{{"simulated", true},
                               {"participants", options.participants},
                               {"trials", result.trials},
                               {"already_there", result.already_there},
                               {"left_out", result.left_out},
                               {"samples", result.samples},
                               {"samples_MB", result.written_MB},
                               {"samples_MB_per_s", MB_per_s},
                               {"wall_s", result.wall_s}};
        std::fputs(files::json_text(json).c_str(), stdout);
        return;
    }
    std::printf("%s: %s, %s now, %d already there, in %.1f s\n", arguments.output.c_str(),
                files::counted(options.participants, "SIMULATED participant").c_str(),
                files::counted(result.trials, "trial").c_str(), result.already_there, result.wall_s);
    if (result.left_out > 0) {
        std::printf("  %s left out: by hand on a real phantom, or on devices that are not simulated\n",
                    files::counted(result.left_out, "trial").c_str());
    }
    // trials by hand or on arm and pins have no pen
    if (options.samples && result.samples > 0) {
        std::printf("  %lld samples of the pen, %.1f MB, %.1f MB/s\n", static_cast<long long>(result.samples),
                    result.written_MB, MB_per_s);
    }
}

}  // namespace

void add_study_simulate(CLI::App& study) {
    auto arguments = std::make_shared<SimulateArguments>();
    CLI::App* command =
        study.add_subcommand("simulate", "Run a study with simulated participants, through the real loop and logs");
    command->add_option("PROTOCOL", arguments->protocol, "protocol JSON, or the name of a shipped one")
        ->required()
        ->transform(protocol_or_name());
    command->add_option("--participants", arguments->options.participants, "number of simulated participants")
        ->required()
        ->check(CLI::Range(1, 9999));
    command->add_option("--seed", arguments->options.seed, "seed of the simulated hands and eyes (default 1)")
        ->check(CLI::Range(0, 2000000000));
    command->add_option("-o,--output", arguments->output, "the study's folder; an interrupted call is resumed there")
        ->required();
    command->add_option("--samples", arguments->samples, "samples of the pen to log: all or none")
        ->check(one_of({"none", "all"}))
        ->capture_default_str();
    command->add_flag("--practice", arguments->options.practice, "simulate the practice trials too");
    command->add_option("--rate-Hz", arguments->options.rate_Hz, "sample rate of the pen (default 60)")
        ->check(CLI::Range(10.0, 2000.0));
    command->add_option("-j,--jobs", arguments->jobs, "number of participants at a time (default: twice the cores)")
        ->check(CLI::Range(1, 256));
    command->add_flag("--json", arguments->json, "print one JSON object on standard output");
    command->callback([arguments] { simulate(*arguments); });
}

}  // namespace palpa::app
