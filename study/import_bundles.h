#pragma once
// Bundles of study/bundle.h into the folder of a study.

#include <filesystem>
#include <string>
#include <vector>

namespace palpa {

struct ImportReport {
    std::vector<std::string> written;        // names within the folder
    std::vector<std::string> already_there;  // the same to the last byte
    int people_added = 0;                    // to participants.tsv
};

// All is checked before the first byte is written: a file that is there with other content, a link in the way, two
// bundles that differ in one file, another study's study.json and a participant who is described otherwise throw
// InputError. Then nothing is written; what a full disk interrupts is taken back, what a kill interrupts is whole or
// absent file by file, and the same call goes on. Files are on the disk when it returns, events of a trial after
// its other files. Participants are added to those that are there; of study.json only what names the study counts.
// Throws std::runtime_error if it cannot write.
ImportReport import_bundles(const std::vector<std::filesystem::path>& bundles, const std::filesystem::path& directory);

}  // namespace palpa
