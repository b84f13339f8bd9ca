#pragma once
// The comparisons of a report as JSON and as tables.

#include <vector>

#include "files/json.h"
#include "study/report.h"

namespace palpa::study {

// Adds the keys primary, pairs, ppv_pairs, choice_pairs and group_comparisons.
void add_comparisons(const Report& report, files::Json& json);

// A test over participants: design, people, difference, ci, t, df, p, p_permutation, status. What is not known is null.
files::Json people_test_json(const PeopleTest& test);

std::vector<ReportTable> comparison_tables(const Report& report);

}  // namespace palpa::study
