#pragma once
// Bundles of study/bundle.h into the folder of a study.

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

// All is checked before the first byte is written: a file that is there with other content, a link in the way, two
// bundles that differ in one file, another study's study.json and a participant who is described otherwise throw
// InputError. Then nothing is written; what a full disk interrupts is taken back, what a kill interrupts is whole or
// absent file by file, and the same call goes on. Files are on the disk when it returns, events of a trial after
// its other files. Participants are added to those that are there, and answers (ratings, choices) to those of an earlier
// bundle; of study.json only what names the study counts. Where a study is imported, bundles of single runs are passed over.
// Throws std::runtime_error if it cannot write.
BundleReport import_bundles(const std::vector<std::filesystem::path>& bundles, const std::filesystem::path& directory);

}  // namespace palpa::study
