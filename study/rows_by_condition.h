#pragma once
// Observations in the order in which a report takes them, so that it reads each row a few times and not once for every
// condition and nodule: tables may hold hundreds of thousands of rows.

#include <span>

#include "study/observations.h"

namespace palpa::study {

// Sorts rows by condition, nodule, participant and repeat, and choices by condition, comparison and participant.
void sort_rows(Observations& seen);

// Return the rows of a condition, or of one nodule or comparison under it (-1: of all). Need sorted rows.
std::span<const Observation> rows_of(const Observations& seen, int condition, int nodule = -1);
std::span<const Choices> choice_rows_of(const Observations& seen, int condition, int comparison = -1);

}  // namespace palpa::study
