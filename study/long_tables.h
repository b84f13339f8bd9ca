#pragma once
// The results of a study with one row for each nodule, trial and choice, for other programs: each row names everything
// that it depends on, so that no other file is needed to read it.

#include <string>
#include <vector>

#include "files/json.h"
#include "study/observations.h"
#include "study/report.h"

namespace palpa::study {

struct LongTable {
    ReportTable table;
    files::Json dictionary;  // by column: Description, and Units where there are some
};

// nodules_long: one row for each nodule that a named person judged: participant group condition nodule repeat found missed.
LongTable nodules_long(const Observations& seen);

// trials_long: one row for each finished trial of logs in which nodules were to be found: participant group condition repeat
// duration_s path_mm mean_force_N max_force_N found missed false_marks.
LongTable trials_long(const Observations& seen);

// choices_long: one row for each forced choice of logs, or for each row of a table of counts: participant group condition
// comparison correct n axis log_ratio stiffer. Of staircases, whose share of right answers follows from the method, and
// of counts the columns that are not known are n/a.
LongTable choices_long(const Observations& seen);

// All three, without those that have no row.
std::vector<LongTable> long_tables(const Observations& seen);
const std::vector<std::string>& long_table_names();

}  // namespace palpa::study
