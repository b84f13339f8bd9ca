#include "study/subject_folders.h"

#include "files/input_error.h"
#include "study/bundle.h"
#include "study/names.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

// Refuses files of another participant and files that look like logs but have no log's name; notes other files.
void check_subject(const fs::path& folder, const std::string& code, std::vector<std::string>& notes) {
    std::error_code error;
    for (const auto& entry : fs::directory_iterator(folder)) {
        const std::string name = entry.path().filename().string();
        if (name == "beh" || name == "now.json" || name.find(".part-") != std::string::npos) continue;
        notes.push_back(entry.path().string() + ": is no part of a log and is left alone");
    }
    const std::string subject = "sub-" + code;
    for (const auto& entry : fs::directory_iterator(folder / "beh", error)) {
        const std::string name = entry.path().filename().string();
        if (name.find(".part-") != std::string::npos) continue;  // was never given its name
        if (kind_of_log_file(subject + "/beh/" + name) && entry.is_regular_file()) continue;
        const std::string extension = entry.path().extension().string();
        if (name.rfind("sub-", 0) != 0 ||
            (name.rfind(subject + "_", 0) == 0 && extension != ".tsv" && extension != ".json")) {
            notes.push_back(entry.path().string() + ": is no part of a log and is left alone");
            continue;
        }
        throw files::bad_input(entry.path().string(), "", "a file that is no log of this participant",
                               "only files such as " + subject + "_task-palpation_run-01_events.tsv");
    }
}

}  // namespace

std::set<std::string> subject_codes(const fs::path& directory, std::vector<std::string>& notes) {
    std::set<std::string> codes;
    for (const auto& entry : fs::directory_iterator(directory)) {
        const std::string name = entry.path().filename().string();
        if (name.rfind("sub-", 0) != 0) continue;
        if (!entry.is_directory() || !is_code(name.substr(4))) {
            throw files::bad_input(directory.string(), "",
                                   (entry.is_directory() ? "a folder " : "a file ") + files::shown(name),
                                   "sub-CODE for folders of participants only; CODE: " + std::string(kCodeRule));
        }
        codes.insert(name.substr(4));
    }
    for (const std::string& code : codes) check_subject(directory / ("sub-" + code), code, notes);
    return codes;
}

}  // namespace palpa::study
