// palpa study preregister PROTOCOL.json

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>
#include <vector>

#include "app/commands/option_checks.h"
#include "app/commands/study.h"
#include "app/scene_choices.h"
#include "app/study/study_scenes.h"
#include "files/regular_file.h"
#include "files/sha256.h"
#include "files/text.h"
#include "study/preregistration.h"
#include "study/protocol_checks.h"

namespace palpa::app {
namespace {

struct PreregisterOptions {
    std::string protocol;
    std::string output;
    int participants = 0;
};

// The hashes of the files that a condition's trials are made from, its scene among them.
std::vector<files::Json> hashes_of(const StudyScenes& scenes) {
    std::vector<files::Json> hashes = identities_of(scenes);
    for (std::size_t i = 0; i < scenes.size(); ++i) {
        if (!scenes[i]) continue;
        if (!scenes[i]->scene.file.empty()) hashes[i]["scene_sha256"] = files::sha256_of_file(scenes[i]->scene.file);
    }
    return hashes;
}

void preregister(const PreregisterOptions& options) {
    study::Protocol protocol = study::read_protocol(options.protocol);
    study::refuse_mixed_ratings(protocol);
    const StudyScenes scenes = load_study_scenes(protocol);
    note_typed_in(scenes, protocol);
    if (!options.output.empty()) {
        std::vector<std::filesystem::path> inputs{options.protocol};
        for (const auto& scene : scenes) {
            if (!scene) continue;
            const std::vector<std::filesystem::path> more = inputs_of(scene->scene);
            inputs.insert(inputs.end(), more.begin(), more.end());
        }
        files::check_output(options.output, inputs);
    }
    const study::SheetOptions sheet{options.participants, "palpa " PALPA_VERSION, hashes_of(scenes)};
    const std::string text = study::preregistration_sheet(protocol, sheet);
    if (options.output.empty()) {
        std::fputs(text.c_str(), stdout);
    } else {
        files::write_text_atomically(options.output, text);
    }
    for (const std::string& missing : study::missing_statements(protocol))
        std::fprintf(stderr, "palpa: %s: not stated: %s\n", options.protocol.c_str(), missing.c_str());
}

}  // namespace

void add_study_preregister(CLI::App& study) {
    auto options = std::make_shared<PreregisterOptions>();
    CLI::App* command = study.add_subcommand(
        "preregister",
        "Make the preregistration sheet of a protocol: design, orders, primary test, stopping rule, hashes");
    command->add_option("PROTOCOL", options->protocol, "protocol JSON, or the name of a shipped one")
        ->required()
        ->transform(protocol_or_name());
    command->add_option("-o,--output", options->output, "Markdown file (default: standard output)");
    command
        ->add_option("--participants", options->participants,
                     "number of participants whose orders are listed (default: the protocol's, else one full round)")
        ->check(CLI::Range(1, 1000));
    command->callback([options] { preregister(*options); });
}

}  // namespace palpa::app
