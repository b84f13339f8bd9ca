// palpa study run PROTOCOL.json --log DIR [--participant CODE]

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/command_study.h"
#include "app/live.h"
#include "files/json.h"

namespace palpa {
namespace {

void run(const RunOptions& options) {
    const auto result = run_live(options);
    if (!result) return;
    const Json& json = *result;
    if (options.json) {
        std::fputs(json_text(json).c_str(), stdout);
        return;
    }
    if (json["of"] == 0) return;
    std::printf("%s: %s of %s trials done\n", json["participant"].get<std::string>().c_str(), json["finished"].dump().c_str(),
                json["of"].dump().c_str());
    if (json["finished"] < json["of"]) std::printf("  the same command goes on with the next one\n");
}

}  // namespace

void add_study_run(CLI::App& study) {
    auto options = std::make_shared<RunOptions>();
    options->participant.clear();
    CLI::App* command = study.add_subcommand("run", "A study with people: instructions, trials, breaks, answers; goes on after a crash");
    command->add_option("PROTOCOL", options->protocol, "protocol JSON")->required();
    command->add_option("--log", options->log, "the study's folder; every participant's logs go there")->required();
    command->add_option("--participant", options->participant, "code of letters and digits (default: asked for)");
    command->add_option("--screenshot", options->screenshot, "PNG of the last frame");
    command->add_option("--quit-after-s", options->quit_after_s, "close the window by itself")->check(CLI::Range(0.0, 1e6));
    command->add_option("--width-px", options->width_px, "of the window (default 1280)")->check(CLI::Range(100, 16384));
    command->add_option("--height-px", options->height_px, "of the window (800)")->check(CLI::Range(100, 16384));
    command->add_flag("--left-handed", options->left_handed, "controls on the right");
    command->add_flag("--json", options->json, "one JSON object on standard output: how far it went");
    command->callback([options] { run(*options); });
}

}  // namespace palpa
