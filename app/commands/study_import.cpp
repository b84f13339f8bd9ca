// palpa study import FILE... -o STUDY_DIR

#include <CLI/CLI.hpp>
#include <cstdio>
#include <memory>

#include "app/commands/study.h"
#include "files/json.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "study/import_bundles.h"

namespace palpa::app {
namespace {

struct ImportOptions {
    std::vector<std::string> bundles;
    std::string output;
    bool json = false;
};

void import(const ImportOptions& options) {
    files::check_output_folder(options.output);
    const study::BundleReport report =
        study::import_bundles({options.bundles.begin(), options.bundles.end()}, options.output);
    if (options.json) {
        const files::Json json{{"written", report.written},
                               {"already_there", report.already_there},
                               {"people_added", report.people_added},
                               {"grown", report.grown},
                               {"passed_over", report.passed_over}};
        std::fputs(files::json_text(json).c_str(), stdout);
        return;
    }
    for (const std::string& name : report.already_there) std::printf("%s: there already, the same\n", name.c_str());
    for (const std::string& name : report.grown) std::printf("%s: answers added\n", name.c_str());
    for (const std::string& name : report.passed_over)
        std::printf("%s: a single run, no part of the study; passed over\n", name.c_str());
    std::printf("%s: %s written, %zu there already, %s added\n", options.output.c_str(),
                files::counted(static_cast<std::int64_t>(report.written.size()), "file").c_str(),
                report.already_there.size(), files::counted(report.people_added, "participant").c_str());
}

}  // namespace

void add_study_import(CLI::App& study) {
    auto options = std::make_shared<ImportOptions>();
    CLI::App* command = study.add_subcommand(
        "import", "Add the logs of tablets to a study's folder; existing files are never overwritten");
    command->add_option("FILE", options->bundles, "bundles, exported by a tablet or collected by palpa serve")
        ->required();
    command->add_option("-o,--output", options->output, "the study's folder; it is created if it does not exist")
        ->required();
    command->add_flag("--json", options->json, "print one JSON object on standard output");
    command->callback([options] { import(*options); });
}

}  // namespace palpa::app
