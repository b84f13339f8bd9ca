#pragma once
// The folders of participants in a study's folder, and what may be in them.

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace palpa::study {

// Returns the codes of the folders sub-CODE. Throws InputError for a file or a folder sub-... that is no participant's, for
// a participant's folder that holds another one's logs, as a copied folder does, and for a table whose name is no log's.
// Notes other files, which are left alone.
std::set<std::string> subject_codes(const std::filesystem::path& directory, std::vector<std::string>& notes);

}  // namespace palpa::study
