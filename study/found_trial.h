#pragma once
// One finished trial in which nodules were to be found, as it enters the results of a study: from its log, or straight from
// the loop.

#include <map>
#include <utility>
#include <vector>

#include "study/name_index.h"
#include "study/observations.h"
#include "study/run_files.h"
#include "study/run_log.h"

namespace palpa::study {

// Adds trials to observations. `out` must outlive it, and get names of conditions and nodules only through it.
class FoundTrials {
  public:
    explicit FoundTrials(Observations& out) : conditions(out.conditions), nodules(out.nodules), out_(out) {}

    // Hits and misses of each nodule, false marks, the judged case (unless the answers were typed in) and the figures.
    // `participant`: index in the observations.
    void add(const RunLog& run, int participant, const RunSettings& settings, const std::vector<LoggedMark>& marks);

    NameIndex conditions, nodules;

  private:
    Observations& out_;
    std::map<std::pair<int, int>, int> repeats_;  // trials of a participant under a condition so far
};

}  // namespace palpa::study
