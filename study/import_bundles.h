#pragma once
// Imports bundles (study/bundle.h) into the folder of a study.

#include <filesystem>
#include <string>
#include <vector>

namespace palpa::study {

struct BundleReport {
    std::vector<std::string> written;        // names within the folder
    std::vector<std::string> already_there;  // identical in the folder, or there with more answers
    std::vector<std::string> grown;          // files of answers to which lines were added
    std::vector<std::string> passed_over;    // bundles of single runs, which do not belong to this study
    int people_added = 0;                    // lines added to participants.tsv
};

// Everything is checked before the first byte is written. Throws InputError, and writes nothing, for a file that exists
// with other content, a symbolic link at its place, two bundles that differ in one file, the study.json of another
// study, a participant who is described differently, and a trial that a participant finished a second time. New files that
// a full disk interrupts are removed again. After
// a kill each file is whole or absent, and the same call completes the import. When the function returns, the files are
// on the disk; the events of a trial are written after its other files. Participants are added to those of the folder,
// and answers (ratings, choices) to those of an earlier bundle. Of study.json only the keys that identify the study are
// compared. If the folder holds a study, or a bundle brings one, bundles of single runs are passed over. Throws
// std::runtime_error if it cannot write.
BundleReport import_bundles(const std::vector<std::filesystem::path>& bundles, const std::filesystem::path& directory);

}  // namespace palpa::study
