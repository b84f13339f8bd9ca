#pragma once
// The log of one run, from its ..._events.tsv, also one that a kill or a power cut left behind: a line that was cut off is
// left out and noted, and a trial without its last row counts as interrupted.

#include <cstdint>
#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::study {

// Returns `text` up to its last newline. What follows was cut off and is noted.
std::string_view whole_lines(std::string_view text, const std::string& file, std::vector<std::string>& notes);

// The log of one run, from its ..._events.tsv. NaN: not in the log.
struct RunLog {
    std::filesystem::path events;
    std::size_t text_hash = 0;  // of its text, to find copies
    bool finished = false;
    bool practice = false;
    int trial = 0;
    std::string condition;
    std::int64_t seed = 0;                   // of the trial; 0: not in the log
    std::optional<std::int64_t> marks_left;  // marks that were not undone, where the log tells their places
    double duration_s = std::numeric_limits<double>::quiet_NaN();
    std::int64_t tp = 0, fp = 0, fn = 0;
    double path_m = std::numeric_limits<double>::quiet_NaN();
    double mean_force_N = std::numeric_limits<double>::quiet_NaN();
    double max_force_N = std::numeric_limits<double>::quiet_NaN();
    struct Choice {
        int trial = 0;
        std::string condition;
        std::string comparison;
        double reference_kPa = 0.0;
        double comparison_kPa = 0.0;
        bool reference_first = false;
        std::string reference_on;  // the condition of the reference; empty: that of the row
        bool reference_softer = false;
        bool correct = false;
        bool practice = false;
        std::int64_t seed = 0;
        std::size_t line = 0;
    };
    std::vector<Choice> choices;  // of a run of forced choices; each of them is finished
};

// Reads the events of one run. Throws InputError for a line that cannot be read, unless it was cut off, and for lines that
// contradict one another: a block that is neither practice nor test, a second trial in a run, anything done after finish, a
// choice whose `correct` is not what its answer says.
RunLog read_run(const std::filesystem::path& events, std::vector<std::string>& notes);
// The same from the text of such a file.
RunLog run_in(const std::string& text, const std::filesystem::path& events, std::vector<std::string>& notes);

// Lists sub-XX/beh/*_events.tsv in the order of their runs. The intervals of forced choices are left out, since their
// answers are in task-softer.
std::vector<std::filesystem::path> events_files(const std::filesystem::path& subject);

// Lists the intervals of forced choices, in the order of their runs.
std::vector<std::filesystem::path> interval_files(const std::filesystem::path& subject);

}  // namespace palpa::study
