#pragma once
// A bundle: the files of a tablet's log in one JSON file, as it is exported there or collected by `palpa serve`.
//
//     {"palpa_bundle": 1, "files": [{"name": "sub-01/beh/sub-01_task-palpation_run-01_events.tsv",
//                                    "sha256": "64 hex digits of the text's bytes", "text": "..."}, ...]}
//
// A bundle comes from another machine, so nothing in it is trusted: names must have the log's own forms, and hashes are
// checked.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::study {

// What a name in a folder of logs can be.
enum class LogFileKind {
    trial,    // sub-XX/beh/sub-XX_task-YY_run-NN_{events,marks,samples}.{tsv,json}, _settings.json, _performance.json;
              // sub-XX/beh/sub-XX_task-ratings_beh.tsv
    dataset,  // dataset_description.json, .bidsignore, protocol.json, task-..._....json: the same for a whole study
    people,   // participants.tsv
    identity  // study.json
};

// Returns nothing for every other name: absolute names, `..`, other folders, other endings.
std::optional<LogFileKind> kind_of_log_file(std::string_view name);

// True for files of answers (ratings and choices), to which lines are added while the participant takes part. A later
// bundle has more of these lines than an earlier one.
bool grows(std::string_view name);

struct BundleFile {
    std::string
        name;  // of one of the kinds above; what stands twice alike in a bundle is here once. Only people and what grows
               // may stand there with several contents
    LogFileKind kind = LogFileKind::trial;
    std::string sha256;  // 64 lower-case hex digits, of `text`
    std::string text;
};

struct Bundle {
    std::vector<BundleFile> files;  // at least one
};

// Reads a bundle from any bytes. Throws InputError with `file_name`, key, found and expected for: no JSON, another
// version, unknown keys, a name that no log has, two contents for one name, a hash that is not the text's. The message
// is one line of 400 characters at most, without control characters.
Bundle read_bundle(std::string_view bytes, const std::string& file_name);

}  // namespace palpa::study
