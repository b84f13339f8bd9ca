#pragma once
// Sums the rows of a study by participant.

#include <vector>

#include "study/observations.h"
#include "study/people.h"

namespace palpa::study {

// Returns what each participant contributed to a condition. `item` is a nodule, or with Quantity::correct a comparison;
// -1 takes all. Empty if some of the rows do not name their participant, or if there is no row.
People people_of(const Observations& seen, int condition, Quantity quantity, int item = -1);

// The same with all items, for every condition.
std::vector<People> people_by_condition(const Observations& seen, Quantity quantity);

// The rows of the participants of one group.
Observations only_group(const Observations& seen, int group);

}  // namespace palpa::study
