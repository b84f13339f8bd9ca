#pragma once
// What a tablet keeps, sends to the desk and exports, as a bundle (docs/formats.md):
//     {"palpa_bundle": 1, "files": [{"name": "sub-01/beh/...", "sha256": "64 hex digits", "text": "..."}]}
// A bundle of a study's run can be analysed by itself: it also holds study.json, protocol.json, the participant's line
// of participants.tsv, and the answers so far.

#include <filesystem>
#include <string>
#include <vector>

#include "study/sample_log.h"

namespace palpa::study {

// The bundle of one run's files, as they are on the disk now. Throws InputError for a file that cannot be read.
std::string bundle_text(const RunFiles& run);

// The bundle of what a participant of a study has answered, without a run. Throws InputError likewise.
std::string bundle_of_answers(const std::filesystem::path& directory, const std::string& code);

// The folder of the study that a run belongs to; empty for a single run.
std::filesystem::path study_of(const RunFiles& run);

// The files that a study needs to go on: its identity, its people, and a participant's answers. The list holds only
// files that exist, each to be taken whole.
std::vector<std::filesystem::path> study_files(const std::filesystem::path& directory, const std::string& code);

// The participant's code in a run's name.
std::string code_of(const RunFiles& run);

}  // namespace palpa::study
