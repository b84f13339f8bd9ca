#pragma once
// Reads logs back, also those that a kill or a power cut left behind: a line that was cut off is left out and noted,
// and a trial without its last row counts as interrupted.

#include <filesystem>
#include <limits>
#include <string>
#include <string_view>
#include <vector>

#include "study/observations.h"

namespace palpa::study {

// Returns `text` up to its last newline. What follows was cut off and is noted.
std::string_view whole_lines(std::string_view text, const std::string& file, std::vector<std::string>& notes);

// The log of one run, from its ..._events.tsv. NaN: not in the log.
struct RunLog {
    std::filesystem::path events;
    bool finished = false;
    bool practice = false;
    int trial = 0;
    std::string condition;
    double duration_s = std::numeric_limits<double>::quiet_NaN();
    std::int64_t tp = 0, fp = 0, fn = 0;
    double path_m = std::numeric_limits<double>::quiet_NaN();
    double mean_force_N = std::numeric_limits<double>::quiet_NaN();
    double max_force_N = std::numeric_limits<double>::quiet_NaN();
    struct Choice {
        int trial = 0;
        std::string condition;
        std::string comparison;
        bool correct = false;
        bool practice = false;
        StiffnessAxis axis = StiffnessAxis::second_first;
        double x = std::numeric_limits<double>::quiet_NaN();  // NaN: the log does not tell the level
        bool stiffer = false;                                 // the second, or the comparison, was called stiffer
    };
    std::vector<Choice> choices;  // of a run of forced choices; each of them is finished
};

// Reads the events of one run. Throws InputError for a line that cannot be read, unless it was cut off.
RunLog read_run(const std::filesystem::path& events, std::vector<std::string>& notes);

// Lists sub-XX/beh/*_events.tsv in the order of their runs. The intervals of forced choices are left out, since their
// answers are in task-softer.
std::vector<std::filesystem::path> events_files(const std::filesystem::path& subject);

// Reads all runs of all participants. Practice and interrupted trials are only counted. Throws InputError for logs of
// two versions of a protocol, a participant who appears twice in participants.tsv, a trial that was finished twice,
// files that are no logs, and a folder without any trial.
Observations read_study(const std::filesystem::path& directory);

}  // namespace palpa::study
