#pragma once
// Reads how often which of two surfaces was called the stiffer one: from a table of counts, and from a row of a log of
// forced choices.

#include "files/table.h"
#include "study/observations.h"

namespace palpa::study {

// The columns are condition, reference_kPa, comparison_kPa, stiffer (how often the comparison was called the stiffer
// one), n, and optionally participant. Throws InputError with file, line and column for an unknown column, a stiffness
// that is no number above 0, n below 1, stiffer > n, two rows with the same condition, participant and stiffnesses, and
// a condition with one level only, through which no curve can be put.
Observations read_stiffer_counts(files::Table& table);

// The current row of a log of forced choices as one answer; x is NaN if the log lacks the columns that tell it. Throws
// InputError for a stiffness that is no number above 0, and for an answer or order with another name.
StifferAnswers stiffer_choice(const files::Table& table);

}  // namespace palpa::study
