#pragma once
// What the columns of a report's tables mean, in the form of BIDS: {"column": {"Description": ..., "Units": ...}}.

#include "files/json.h"
#include "study/report.h"

namespace palpa::study {

// Every column of every table of report_tables() has a description; one that is not known is described by its name alone,
// which tests/study/test_table_dictionary.cpp refuses.
files::Json dictionary_of(const ReportTable& table);

}  // namespace palpa::study
