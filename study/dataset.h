#pragma once
// What stands at the top of a study's folder for readers who know neither this program nor the study: README,
// dataset_description.json, and what the columns of participants.tsv, exclusions.tsv and replacements.tsv mean. The layout is
// that of BIDS 1.8.0 (bids-specification.readthedocs.io, "Modality agnostic files").

#include <filesystem>
#include <string>

#include "study/study_folder.h"

namespace palpa::study {

// Writes those of the files that are not there yet. Throws std::runtime_error if one cannot be written.
void describe_dataset(const std::filesystem::path& directory, const Protocol& protocol, const StudyKind& kind);

std::string readme_text(const Protocol& protocol, const StudyKind& kind);

}  // namespace palpa::study
