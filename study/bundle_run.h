#pragma once
// Makes the bundles (study/bundle.h) that a tablet keeps, sends to the desk and exports. The bundle of one run of a
// study can be analysed by itself: it also holds study.json, protocol.json, the participant's line of participants.tsv,
// and the answers given so far.

#include <filesystem>
#include <string>
#include <vector>

#include "study/sample_log.h"

namespace palpa::study {

// Returns the bundle of one run from its files on the disk. Throws InputError for a file that cannot be read.
std::string bundle_text(const RunFiles& run);

// Returns the bundle of a participant's answers in a study, without a run. Throws InputError for a file that cannot be
// read.
std::string bundle_of_answers(const std::filesystem::path& directory, const std::string& code);

// Returns the folder of the study that a run belongs to, or an empty path for a run outside a study.
std::filesystem::path study_of(const RunFiles& run);

// Returns the files that a study needs to continue: its identity, its protocol, its participants, and the answers of
// participant `code`. The list holds only files that exist, participants.tsv with all its lines.
std::vector<std::filesystem::path> study_files(const std::filesystem::path& directory, const std::string& code);

// Returns the participant's code from the name of a run.
std::string code_of(const RunFiles& run);

}  // namespace palpa::study
