#pragma once
// Imports bundles (study/bundle.h) into the folder of a study.

#include <filesystem>
#include <string>
#include <vector>

namespace palpa::study {

struct BundleReport {
    std::vector<std::string> written;        // names within the folder
    std::vector<std::string> already_there;  // the same to the last byte, or with more answers
    std::vector<std::string> grown;          // answers that were added to those that were there
    std::vector<std::string> passed_over;    // bundles of single runs, which are no part of this study
    int people_added = 0;                    // to participants.tsv
};

// Everything is checked before the first byte is written. InputError is thrown, and nothing written, for a file that
// exists with other content, a link in the way, two bundles that differ in one file, another study's study.json and a
// participant who is described otherwise. An import that a full disk interrupts is taken back. After a kill each file
// is whole or absent, and the same call goes on. When the function returns, the files are on the disk; the events of a
// trial get there after its other files. Participants are added to those in the folder, and answers (ratings, choices)
// to those of an earlier bundle. Of study.json only the keys that name the study are compared. Where a study is
// imported, bundles of single runs are passed over. Throws std::runtime_error if it cannot write.
BundleReport import_bundles(const std::vector<std::filesystem::path>& bundles, const std::filesystem::path& directory);

}  // namespace palpa::study
