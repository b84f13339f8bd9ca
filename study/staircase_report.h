#pragma once
// The staircases of a study in the report.

#include <string>

#include "study/report.h"

namespace palpa::study {

files::Json staircase_json(const StaircaseResult& result);
ReportTable staircase_table(const Report& report);

}  // namespace palpa::study
