#pragma once
// Marks and ratings of any laboratory as a table MARKS.tsv, with the columns
//
//     condition participant case kind lesion rating [group]
//
// kind `lesion`: one row for each lesion of a case, for each person and condition; `rating` is that of the highest mark on
// it, n/a if it is unmarked. `nl`: a mark on no lesion, with its rating; `lesion` is n/a. `case`: a case that has no lesion
// and no mark; `lesion` and `rating` are n/a.

#include "files/table.h"
#include "study/observations.h"

namespace palpa::study {

// Reads the table: `judged`, and the hits, misses and false marks for the other tests, where a nodule is named "case
// lesion". Throws InputError with file, line and column for other columns, a kind that is none, a mark without a rating, a
// rating outside the scale, a lesion that is there twice, a row `case` beside others of the case, and a case that has other
// lesions for one person than for another.
Observations read_marks_table(files::Table& table, const RatingScale& scale = {});

}  // namespace palpa::study
