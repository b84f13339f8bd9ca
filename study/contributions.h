#pragma once
// Sums the rows of a study by participant.

#include <vector>

#include "study/observations.h"
#include "study/people.h"

namespace palpa::study {

// Returns what each participant contributed to a condition. `item` is a nodule, or with Quantity::correct a comparison;
// -1 takes all. Empty if some of the rows do not name their participant, or if there is no row.
People people_of(const Observations& seen, int condition, Quantity quantity, int item = -1);

// The same without gaps for those who did not take part, in the order of the participants. Needs rows that sort_rows()
// has sorted (study/rows_by_condition.h), and reads only those that it sums.
People people_who_took_part(const Observations& sorted, int condition, Quantity quantity, int item = -1);

// As people_of() with all items, for every condition.
std::vector<People> people_by_condition(const Observations& seen, Quantity quantity);

// The rows of the participants of one group.
Observations only_group(const Observations& seen, int group);

}  // namespace palpa::study
