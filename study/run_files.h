#pragma once
// What stands beside the events of a run, its settings and its marks, and whether all three agree.

#include <filesystem>
#include <limits>
#include <optional>
#include <string>
#include <vector>

#include "study/judged_cases.h"

namespace palpa::study {

struct RunLog;

struct RunSettings {
    bool there = false;
    std::string sha256;         // of the protocol; empty for a single run
    std::optional<int> number;  // of the participant in the plan
    bool simulated = false;
    bool typed = false;  // the answers were typed in: the events hold no marks
    struct Nodule {
        std::string id;
        double diameter_mm = 0.0;
    };
    std::optional<int> interval;  // 1 or 2, of a forced choice
    std::string tissue;           // its name; empty for answers that were typed in
    std::vector<Nodule> nodules;
};

// Reads ..._settings.json; if there is no such file, the result says so. Throws InputError.
RunSettings read_run_settings(const std::filesystem::path& file);

// Returns when a trial began, UTC in ISO 8601, as its ..._performance.json says; empty if there is no such file. Throws
// InputError.
std::string began_utc(const std::filesystem::path& performance_json);

struct LoggedMark {
    std::string nodule;        // n/a: none
    double distance_mm = 0.0;  // NaN: not known
    bool hit = false;
    double confidence = std::numeric_limits<double>::quiet_NaN();  // 1 to 5; NaN: not given
};

// The marks of a finished run as free-response data: of several marks on one nodule the highest rating counts, and whatever
// is within a found nodule's acceptance radius is on it.
JudgedCase judged_case(const RunSettings& settings, const std::vector<LoggedMark>& marks);

// Reads ..._marks.tsv; nothing if there is no such file. Throws InputError; a line that was cut off is noted.
std::optional<std::vector<LoggedMark>> read_marks_left(const std::filesystem::path& file,
                                                       std::vector<std::string>& notes);

// Compares the counts of a finished run's last row with its marks and its settings. A mark without a hit is false unless
// it is on a nodule that another mark found (study/score.h). Throws InputError that names what disagrees.
void check_counts(const RunLog& run, const RunSettings& settings, const std::vector<LoggedMark>& marks);

}  // namespace palpa::study
