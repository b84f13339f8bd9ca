// palpa study run PROTOCOL.json --log DIR [--participant CODE]

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/option_checks.h"
#include "app/commands/study.h"
#include "app/live/live.h"
#include "files/json.h"

namespace palpa::app {
namespace {

void run(const RunOptions& options) {
    const auto result = run_live(options);
    if (!result) return;
    const files::Json& json = *result;
    if (options.json) {
        std::fputs(files::json_text(json).c_str(), stdout);
        return;
    }
    if (json["of"] == 0 || json["participant"] == "") return;  // closed between two participants
    std::printf("%s: %s of %s trials done\n", json["participant"].get<std::string>().c_str(),
                json["finished"].dump().c_str(), json["of"].dump().c_str());
    if (json["step"] == "withdrawn")
        std::printf("  has withdrawn: this code takes part no more\n");
    else if (json["finished"] < json["of"])
        std::printf("  the same command continues with the next one\n");
    else if (json["step"] != "done")
        std::printf("  the same command asks what is left\n");
}

}  // namespace

void add_study_run(CLI::App& study) {
    auto options = std::make_shared<RunOptions>();
    options->participant.clear();
    CLI::App* command = study.add_subcommand(
        "run", "Run a study with people: instructions, trials, breaks, answers; resumes after a crash");
    command->add_option("PROTOCOL", options->protocol, "protocol JSON, or the name of a shipped one")
        ->required()
        ->transform(protocol_or_name());
    command->add_option("--log", options->log, "the study's folder, for the logs of all participants")->required();
    command
        ->add_option("--participant", options->participant,
                     "participant's code of letters and digits (default: the app asks for it)")
        ->transform(code_of_participant());
    command->add_option("--screenshot", options->screenshot, "write a PNG of the last frame");
    command
        ->add_option("--quit-after-s", options->quit_after_s,
                     "close the window this many seconds after its first frame")
        ->check(CLI::Range(0.0, 1e6));
    command->add_option("--width-px", options->width_px, "width of the window (default: as last time, 1280 at first)")
        ->check(CLI::Range(100, 16384));
    command->add_option("--height-px", options->height_px, "height of the window (default: as last time, 800 at first)")
        ->check(CLI::Range(100, 16384));
    command->add_flag("--simulate", options->simulate_devices,
                      "start simulators of the scenes' devices, and connect to them instead of real ones");
    command->add_flag("--left-handed", options->left_handed, "put the controls on the right");
    command->add_flag("--json", options->json, "print one JSON object on standard output: how far the study went");
    command->callback([options] { run(*options); });
}

}  // namespace palpa::app
