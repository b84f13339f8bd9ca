#pragma once
// The answers of staircases, from the logs: what a running study goes on from, and what the analysis estimates from.

#include <filesystem>
#include <set>
#include <string>
#include <utility>
#include <vector>

#include "study/staircase.h"

namespace palpa::study {

// Returns the answers of one participant's tests under a condition with a staircase, in the order in which they were
// given, without the trials with the numbers `left_out`. Throws InputError for a row that cannot be read, and for a
// comparison that is none of the protocol's levels.
std::vector<StaircaseAnswer> staircase_answers(const std::filesystem::path& directory, const Protocol& protocol,
                                               const std::string& code, std::size_t condition,
                                               const std::set<int>& left_out = {});

// The staircase of one participant under one condition.
struct StaircaseResult {
    std::string condition;
    std::string participant;
    StaircaseMethod method = StaircaseMethod::quest_plus;
    StaircaseEstimate estimate;
};

// Returns one result for each participant and each condition with a staircase, by the folder's protocol.json. Nothing
// without this file, and for participants without answers. `left_out`: participants and numbers of trials that are
// excluded. Notes staircases with answers at levels that the answers before them do not ask for.
std::vector<StaircaseResult> staircase_results(const std::filesystem::path& directory,
                                               const std::vector<std::string>& participants,
                                               const std::set<std::pair<std::string, int>>& left_out,
                                               std::vector<std::string>& notes);

}  // namespace palpa::study
