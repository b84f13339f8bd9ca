#pragma once
// Forced choices that were broken off: a person had begun to feel the two surfaces, but there is no answer. Each surface
// felt in a scene is a run of its own, ..._task-interval_..., beside the answers in ..._task-softer_....

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace palpa::study {

struct BrokenChoice {
    std::filesystem::path events;  // of the run that was broken off, or of the last one before
    int trial = 0;
    bool practice = false;
};

// Each interruption of the choices whose intervals are in sub-XX/beh, in the order of the runs: an interval without its
// row finish, and finished intervals to which neither the other interval nor an answer came. `answered`: trials that have
// an answer. Choices whose surfaces the experimenter presents have no runs, so their interruptions are not known. A file
// that was killed before its first row counts with trial 0. Notes lines that were cut off; throws InputError for events
// that cannot be read.
std::vector<BrokenChoice> broken_choices(const std::filesystem::path& subject, const std::set<int>& answered,
                                         std::vector<std::string>& notes);

}  // namespace palpa::study
