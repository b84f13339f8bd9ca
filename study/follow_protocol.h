#pragma once
// What a study's own files say about how its results are compared.

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "study/observations.h"
#include "study/protocol.h"
#include "study/study_folder.h"

namespace palpa::study {

// Brings the conditions and the groups into the order of the protocol, so that the sign of a difference does not depend on which log
// was read first, and takes over the comparison that the protocol states. What the protocol does not name
// stands last.
void follow_protocol(const Protocol& protocol, Observations& seen);

// Estimates the staircases of all participants but those left out, without the trials left out (participant, number).
// The share of right answers of a staircase follows from its method, so its answers are removed from `choices`; they
// stay in `stiffer`.
void take_staircases(const std::filesystem::path& directory, const std::set<std::string>& left_out,
                     const std::set<std::pair<std::string, int>>& left_out_trials, Observations& seen);

// Gives each participant the group of participants.tsv.
void take_groups(const std::vector<Person>& people, Observations& seen);

}  // namespace palpa::study
