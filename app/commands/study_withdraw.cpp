// palpa study withdraw DIR --participant CODE --data keep|leave-out

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cstdio>
#include <filesystem>
#include <memory>

#include "app/commands/option_checks.h"
#include "app/commands/study.h"
#include "files/folder_lock.h"
#include "files/input_error.h"
#include "files/text.h"
#include "study/study_folder.h"
#include "study/withdrawal.h"

namespace palpa::app {
namespace {

struct WithdrawOptions {
    std::string directory;
    std::string participant;
    std::string data;
};

// A withdrawal that was cut off says nothing yet: it is what this command completes.
bool has_taken_data(const WithdrawOptions& options) {
    try {
        return study::withdrawal_of(options.directory, options.participant) == study::Withdrawal::takes_data;
    } catch (const files::InputError&) {
        return false;
    }
}

void withdraw_participant(const WithdrawOptions& options) {
    if (!study::read_identity(options.directory)) {
        throw files::bad_input(options.directory, "", "no study.json",
                               "the folder of a study (--log of palpa study run)");
    }
    const files::FolderLock lock(options.directory, study::kOtherWriter);
    std::vector<std::string> notes;
    const std::vector<study::Person> people = study::read_people(options.directory, notes);
    const auto same = [&](const study::Person& one) { return one.code == options.participant; };
    // who stopped at the first questions has a folder, but no line among the participants yet
    const bool began =
        std::filesystem::is_directory(std::filesystem::path(options.directory) / ("sub-" + options.participant));
    if (!began && std::none_of(people.begin(), people.end(), same)) {
        throw files::bad_input("--participant", "", files::shown(options.participant),
                               "a code that is in " + options.directory);
    }
    if (has_taken_data(options)) {
        throw files::bad_input("--participant", "", files::shown(options.participant) + ", who has withdrawn the data",
                               "a participant whose data are in use");
    }
    const bool keep = options.data == "keep";
    study::withdraw(options.directory, options.participant,
                    keep ? study::Withdrawal::keeps_data : study::Withdrawal::takes_data);
    std::printf("%s has withdrawn from the study; the data %s\n", options.participant.c_str(),
                keep ? "may be used" : "stay on the disk and are left out of the analysis");
}

}  // namespace

void add_study_withdraw(CLI::App& study) {
    auto options = std::make_shared<WithdrawOptions>();
    CLI::App* command = study.add_subcommand(
        "withdraw", "Note that a participant has withdrawn, and whether the data may be used; deletes nothing");
    command->add_option("DIR", options->directory, "the study's folder")->required();
    command->add_option("--participant", options->participant, "participant's code")
        ->required()
        ->transform(code_of_participant());
    command->add_option("--data", options->data, "keep: may be used; leave-out: the analysis leaves them out")
        ->required()
        ->check(one_of({"keep", "leave-out"}));
    command->callback([options] { withdraw_participant(*options); });
}

}  // namespace palpa::app
