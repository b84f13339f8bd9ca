#pragma once
// What the experimenter decides about data that stay where they are: trials that the analysis leaves out, and dropouts
// whose place another participant takes. Both are tables at the top of a study's folder, to which lines are appended:
//
//     exclusions.tsv     participant trial reason          trial: its number, or all
//     replacements.tsv   participant replaced_by reason

#include <filesystem>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "study/study_folder.h"

namespace palpa::study {

struct Exclusion {
    std::string participant;   // code without "sub-"
    std::optional<int> trial;  // nothing: all trials of this participant
    std::string reason;
};

struct Replacement {
    std::string participant;  // who dropped out
    std::string replaced_by;  // who has that place in the plan now
    std::string reason;
};

// Read the two tables; nothing if there is no such file. Throw InputError with the line for other columns, a code, number
// or reason that is none, a line that is there twice, a participant who replaces two, and a second replacement of somebody
// whose place another participant has begun to take. A line with replaced_by n/a frees the place from who has not come; they
// have a place of their own in the plan if they come later.
std::vector<Exclusion> read_exclusions(const std::filesystem::path& directory);
std::vector<Replacement> read_replacements(const std::filesystem::path& directory);

// Returns who has a participant's place now; "" for a participant who was not replaced. Throws as read_replacements().
std::string replaced_by(const std::filesystem::path& directory, const std::string& code);

// Append a line, which is on the disk when they return. Throw InputError, and write nothing, if it cannot be: the folder is
// no study, the participant is not in participants.tsv, it was decided already (a replacement who has not begun may be replaced
// by another), or the new participant has begun.
void add_exclusion(const std::filesystem::path& directory, const Exclusion& exclusion);
void add_replacement(const std::filesystem::path& directory, const Replacement& replacement);

// Which place in the plan each participant has: people get 1, 2, ... in the order of participants.tsv, but who replaces a
// dropout gets that one's number, so that groups and orders stay balanced over those who finish. Participants who are to
// replace somebody have their number before they are in participants.tsv. Throws InputError for a replacement of somebody
// who is not there.
struct Numbers {
    std::map<std::string, int> of;  // by code
    int next = 1;                   // for a participant who replaces nobody
    int number(const std::string& code) const {
        const auto it = of.find(code);
        return it == of.end() ? next : it->second;
    }
};
Numbers numbers_of(const std::vector<Person>& people, const std::vector<Replacement>& replacements);

}  // namespace palpa::study
