#pragma once
// A bundle: the files of a tablet's log in one JSON file, as a tablet exports it or `palpa serve` collects it.
//
//     {"palpa_bundle": 1, "files": [{"name": "sub-01/beh/sub-01_task-palpation_run-01_events.tsv",
//                                    "sha256": "64 hex digits of the text's bytes", "text": "..."}, ...]}
//
// A bundle comes from another machine, so nothing in it is trusted: names must have the forms of the log's own files,
// and hashes are checked.

#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::study {

// The kinds of files in a folder of logs.
enum class LogFileKind {
    trial,    // sub-XX/beh/sub-XX_task-YY_run-NN_{events,marks,samples}.{tsv,json}, _settings.json, _performance.json;
              // sub-XX/beh/sub-XX_task-ratings_beh.tsv
    dataset,  // dataset_description.json, README, .bidsignore, protocol.json, task-*.json, participants.json,
              // exclusions.json, replacements.json: one for the whole study
    people,   // participants.tsv
    identity  // study.json
};

// Returns the kind of a file by its name in the folder, or nothing for any other name: absolute paths, `..`, other
// folders, other endings.
std::optional<LogFileKind> kind_of_log_file(std::string_view name);

// True for files of answers (ratings and choices), to which lines are added while the participant takes part. A later
// bundle has more of these lines than an earlier one.
bool grows(std::string_view name);

struct BundleFile {
    // The name is of one of the kinds above. Equal copies of a file in a bundle appear here once; only
    // participants.tsv and files that grow may appear with several contents.
    std::string name;
    LogFileKind kind = LogFileKind::trial;
    std::string sha256;  // 64 lower-case hex digits, of `text`
    std::string text;
};

struct Bundle {
    std::vector<BundleFile> files;  // at least one
};

// Reads a bundle from bytes that may hold anything. Throws InputError with `file_name`, key, found and expected if they
// are not JSON, or have another version, unknown keys, a name that is not a log's, two contents for one name, or a hash
// that is not that of the text. The message is one line of at most 400 characters, without control characters.
Bundle read_bundle(std::string_view bytes, const std::string& file_name);

}  // namespace palpa::study
