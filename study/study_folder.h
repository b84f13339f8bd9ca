#pragma once
// The folder of one study: DIR/protocol.json (a copy), DIR/study.json (the version of the protocol, and whether
// participants are simulated), the participants, and the runs of study/sample_log.h. Existing files are never
// overwritten; an interrupted study continues in its folder.

#include <filesystem>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "study/order.h"

namespace palpa::study {

// Who may hold the lock of a study's whole folder (files/folder_lock.h): simulate, import, exclude, replace and
// withdraw take it while they write. Screens of `study run` share the folder, and lock the folders of their participants.
inline constexpr const char* kOtherWriter = "another palpa that writes into this folder";

struct StudyKind {
    bool simulated = false;
    std::uint64_t seed = 0;  // of the simulation
    std::string program;     // name and version
    double rate_Hz = 0.0;    // of the simulated pen
};

// Creates the folder, or continues in a folder of the same protocol and kind. Throws InputError if the folder holds
// another protocol's logs (naming both versions), logs of another kind, logs of a program with other orders, or logs
// without study.json; std::runtime_error if it cannot be written.
void open_study(const std::filesystem::path& directory, const Protocol& protocol, const StudyKind& kind);

// Throws InputError if the folder is a study's: single runs never share it.
void check_no_study(const std::filesystem::path& directory);

// The content of study.json. read_identity() returns nothing if there is no such file (logs of single runs). Throws
// InputError if the file cannot be read.
struct StudyIdentity {
    std::string name;
    std::string version;
    std::string sha256;
    StudyKind kind;
    int orders_version = 1;  // of the program that began the study (order.h); files without the key have 1
};
std::optional<StudyIdentity> read_identity(const std::filesystem::path& directory);
StudyIdentity identity_in(std::string_view study_json, const std::string& file_name);

// One line of participants.tsv; what is not known is n/a.
struct Person {
    std::string code;  // without "sub-"
    std::string age = "n/a", sex = "n/a", handedness = "n/a", vision = "n/a";
    std::string palpation_experience = "n/a", vr_experience = "n/a", group = "n/a";
    bool operator==(const Person&) const = default;
};

// Reads participants.tsv in the order of the file. A line that was cut off is left out and noted. Throws InputError for
// a code that appears twice.
std::vector<Person> read_people(const std::filesystem::path& directory, std::vector<std::string>& notes);
std::vector<Person> people_in(std::string_view participants_tsv, const std::string& file_name,
                              std::vector<std::string>& notes);

// The code of a participant that `code`, of nobody yet, was probably meant to be: they differ by capitals or zeros in front of
// numbers alone; "" if there is none.
std::string spelled_alike(const std::vector<Person>& people, const std::string& code);

// Appends the participants whose codes are not in the file yet; they are on the disk when the function returns. Throws
// std::runtime_error if they cannot be written.
void add_people(const std::filesystem::path& directory, const std::vector<Person>& people);

// Returns the numbers of this participant's trials that are finished and on the disk.
std::set<int> finished_trials(const std::filesystem::path& directory, const std::string& code);

// Returns the first trial that is not finished, with which a study continues after a break, a crash or a power cut;
// nothing if all trials are finished.
std::optional<PlannedTrial> next_trial(const PlannedParticipant& plan, const std::set<int>& finished);

// The progress of a participant: what a screen needs to begin, or to continue after a crash.
struct StudyProgress {
    bool known = false;       // the code is in participants.tsv already
    PlannedParticipant plan;  // of the participant's number (study/exclusions.h), or of the next free one
    std::set<int> finished;
    std::optional<PlannedTrial> next;  // nothing: all trials are finished
};
StudyProgress progress_of(const std::filesystem::path& directory, const Protocol& protocol, const std::string& code);

// Returns the instructions that the participant reads before this trial.
std::string instructions_for(const Protocol& protocol, const PlannedTrial& trial);

}  // namespace palpa::study
