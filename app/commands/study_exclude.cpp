// palpa study exclude DIR --participant CODE [--trial N] --reason TEXT
// palpa study replace DIR --participant CODE --by CODE --reason TEXT

#include <CLI/CLI.hpp>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/option_checks.h"
#include "app/commands/study.h"
#include "files/folder_lock.h"
#include "files/input_error.h"
#include "study/exclusions.h"
#include "study/study_folder.h"

namespace palpa::app {
namespace {

struct ExcludeArguments {
    std::string directory;
    std::string participant;
    int trial = 0;  // 0: all
    std::string reason;
};

struct ReplaceArguments {
    std::string directory;
    study::Replacement replacement;
};

void check_study(const std::string& directory) {
    if (std::filesystem::is_directory(directory)) return;
    throw files::bad_input(directory, "", "no folder", "the folder of a study");
}

void exclude(const ExcludeArguments& arguments) {
    check_study(arguments.directory);
    const files::FolderLock lock(arguments.directory, study::kOtherWriter);
    study::Exclusion one{arguments.participant, std::nullopt, arguments.reason};
    if (arguments.trial > 0) one.trial = arguments.trial;
    study::add_exclusion(arguments.directory, one);
    const std::string what = one.trial ? "trial " + std::to_string(*one.trial) : "all trials";
    std::printf("%s: %s of %s will be left out of the analysis; the logs stay as they are\n",
                arguments.directory.c_str(), what.c_str(), one.participant.c_str());
}

void replace(const ReplaceArguments& arguments) {
    check_study(arguments.directory);
    const files::FolderLock lock(arguments.directory, study::kOtherWriter);
    study::add_replacement(arguments.directory, arguments.replacement);
    std::printf(
        "%s: %s takes the place of %s, whose trials will be left out of the analysis; the logs stay as they are\n",
        arguments.directory.c_str(), arguments.replacement.replaced_by.c_str(),
        arguments.replacement.participant.c_str());
}

}  // namespace

void add_study_exclude(CLI::App& study) {
    auto left_out = std::make_shared<ExcludeArguments>();
    CLI::App* excluding = study.add_subcommand(
        "exclude", "Leave a trial, or a participant, out of the analysis, with the reason; no data are deleted");
    excluding->add_option("DIR", left_out->directory, "the study's folder")->required();
    excluding->add_option("--participant", left_out->participant, "code of the participant")
        ->required()
        ->transform(code_of_participant());
    excluding->add_option("--trial", left_out->trial, "number of the finished trial (default: all of the participant)")
        ->check(CLI::Range(1, 1000000));
    excluding->add_option("--reason", left_out->reason, "why, in words; the report repeats it")->required();
    excluding->callback([left_out] { exclude(*left_out); });

    auto replaced = std::make_shared<ReplaceArguments>();
    CLI::App* replacing = study.add_subcommand(
        "replace", "Give the place of a participant who dropped out to a new one, who gets the same group and order");
    replacing->add_option("DIR", replaced->directory, "the study's folder")->required();
    replacing->add_option("--participant", replaced->replacement.participant, "code of the participant who dropped out")
        ->required()
        ->transform(code_of_participant());
    replacing->add_option("--by", replaced->replacement.replaced_by, "code of the replacement, who has not begun yet")
        ->required()
        ->transform(code_of_participant());
    replacing->add_option("--reason", replaced->replacement.reason, "why, in words; the report repeats it")->required();
    replacing->callback([replaced] { replace(*replaced); });
}

}  // namespace palpa::app
