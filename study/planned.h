#pragma once
// Logs against the plan: what each participant was to do under each condition, and what of it was done.

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "study/order.h"
#include "study/protocol.h"

namespace palpa::study {

// The tests of one participant under one condition. Practice is not counted.
struct Progress {
    std::string participant;
    std::string group;
    std::string condition;
    int planned = 0;
    int finished = 0;           // those that are excluded among them
    int interrupted = 0;        // runs that ended without finish
    int excluded = 0;           // finished, and left out of the analysis
    std::string replaced_by{};  // who has the participant's place now; or empty
    bool counts = true;         // false: who has the place now has begun, and plans these tests again
    int missing() const { return counts && planned > finished ? planned - finished : 0; }
};

// One run or one choice, as the log labels it.
struct Logged {
    int trial = 0;
    int condition = -1;  // index in the protocol
    bool practice = false;
    bool finished = false;
    bool excluded = false;
    int comparison = -1;  // of a choice: index in comparisons_kPa
    bool reference_first = false;
    std::int64_t seed = 0;  // 0: not in the log
};

// Returns one row for each condition that the participant was to do, or did, in the order of the plan. Notes trials whose
// condition, block, pair or seed is not the plan's. Needs trial numbers that the plan has.
std::vector<Progress> compare_with_plan(const Protocol& protocol, const PlannedParticipant& plan,
                                        const std::string& participant, const std::vector<Logged>& logged,
                                        std::vector<std::string>& notes);

// Returns the number whose plan has this seed for this trial: `likely` if its plan has it, else one of 1 ... `most`;
// nothing if none has it.
std::optional<int> number_with_seed(const Protocol& protocol, int trial, std::int64_t seed, int likely, int most);

}  // namespace palpa::study
