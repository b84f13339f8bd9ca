#pragma once
// Reads the logs of a study back, and compares them with its plan.

#include <filesystem>

#include "study/observations.h"
#include "study/run_log.h"

namespace palpa::study {

// Reads all runs of all participants. Practice, interrupted and excluded trials (study/exclusions.h) are only counted, and
// all are compared with the plan of DIR/protocol.json. Throws InputError for logs of two versions of a protocol or of
// none, a participant who appears twice in participants.tsv or not at all, files and folders that are no participant's, a
// trial that was finished twice, counts that the marks contradict, conditions and trials that the protocol does not have,
// and a folder without any trial. What is odd but possible is noted.
Observations read_study(const std::filesystem::path& directory);

}  // namespace palpa::study
