#pragma once
// How often which of two surfaces was called the stiffer one: from a table of counts, and from the answers of forced
// choices.

#include "files/table.h"
#include "study/observations.h"

namespace palpa::study {

// The columns are condition, reference_kPa, comparison_kPa, stiffer (how often the comparison was called the stiffer
// one), n, and optionally participant. Throws InputError with file, line and column for an unknown column, a stiffness
// that is no number above 0, n below 1, stiffer > n, two rows with the same condition, participant and stiffnesses, and
// a condition with one level only, through which no curve can be put.
Observations read_stiffer_counts(files::Table& table);

// A stiffness in kPa. Throws InputError if it is no number above 0.
double stiffness_kPa(const files::Table& table, std::size_t column);

// One forced choice between a reference and a comparison.
struct StifferQuestion {
    double reference_kPa = 0.0;
    double comparison_kPa = 0.0;
    bool reference_first = false;
    bool reference_stays = false;  // under one condition: the axis is comparison / reference
};

// The answer to it at its level; its condition and participant are left open.
StifferAnswers stiffer_choice(const StifferQuestion& question, bool reference_softer);

}  // namespace palpa::study
