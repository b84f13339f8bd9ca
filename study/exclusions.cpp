#include "study/exclusions.h"

#include <algorithm>
#include <functional>

#include "files/append_file.h"
#include "files/input_error.h"
#include "files/printable.h"
#include "files/table.h"
#include "files/text.h"
#include "study/count.h"
#include "study/names.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

fs::path exclusions_file(const fs::path& directory) { return directory / "exclusions.tsv"; }
fs::path replacements_file(const fs::path& directory) { return directory / "replacements.tsv"; }

constexpr const char* kExclusionHeader = "participant\ttrial\treason\n";
constexpr const char* kNobody = "n/a";  // as replaced_by: who was to take the place has not come, and has lost it
constexpr const char* kReplacementHeader = "participant\treplaced_by\treason\n";

std::string without_sub(std::string_view code) {
    return std::string(code.substr(0, 4) == "sub-" ? code.substr(4) : code);
}

std::string code_in(const files::Table& table, std::size_t column) {
    const std::string code = without_sub(table.field(column));
    if (!is_code(code)) table.fail(column, kCodeRule);
    return code;
}

std::string reason_in(const files::Table& table) {
    const std::size_t column = table.column("reason");
    if (reads_as_missing(table.field(column))) table.fail(column, "why, in words");
    return std::string(table.field(column));
}

// Calls `row` for each line of a table that has three columns.
void read_rows(const fs::path& file, const char* header, const std::function<void(const files::Table&)>& row) {
    if (!fs::exists(file) || fs::file_size(file) == 0) return;
    files::Table table = files::read_tsv(file);
    std::string columns;
    for (const std::string& column : table.columns()) columns += (columns.empty() ? "" : "\t") + column;
    if (columns + "\n" != header) {
        std::string expected(header);
        std::replace(expected.begin(), expected.end(), '\t', ' ');
        throw files::bad_input(file.string(), "line 1", files::shown(columns),
                               "the columns " + expected.substr(0, expected.size() - 1));
    }
    while (table.next()) row(table);
}

void append_line(const fs::path& file, const char* header, std::string line) {
    const bool fresh = !fs::exists(file) || fs::file_size(file) == 0;
    files::append_synced(file, (fresh ? header : "") + line + "\n");
}

// Returns a reason as it stands in a table.
std::string reason_text(std::string reason) {
    for (char& c : reason) {
        if (static_cast<unsigned char>(c) < 0x20) c = ' ';
        if (c == '"') c = '\'';
    }
    reason.erase(0, std::min(reason.find_first_not_of(' '), reason.size()));
    reason.erase(reason.find_last_not_of(' ') + 1);
    if (!files::is_utf8(reason)) throw files::bad_input("--reason", "", files::shown(reason), "text in UTF-8");
    if (reads_as_missing(reason)) throw files::bad_input("--reason", "", files::shown(reason), "why, in words");
    return reason;
}

std::vector<Person> people_of_study(const fs::path& directory) {
    if (!read_identity(directory))
        throw files::bad_input(directory.string(), "", "no study.json", "the folder of a study");
    std::vector<std::string> notes;
    return read_people(directory, notes);
}

bool is_among(const std::vector<Person>& people, const std::string& code) {
    return std::any_of(people.begin(), people.end(), [&](const Person& one) { return one.code == code; });
}

std::string trial_text(const Exclusion& one) { return one.trial ? std::to_string(*one.trial) : "all"; }

}  // namespace

std::vector<Exclusion> read_exclusions(const fs::path& directory) {
    std::vector<Exclusion> out;
    read_rows(exclusions_file(directory), kExclusionHeader, [&](const files::Table& table) {
        Exclusion one;
        one.participant = code_in(table, table.column("participant"));
        const std::size_t trial = table.column("trial");
        if (table.field(trial) != "all") one.trial = static_cast<int>(whole_number(table, trial, 1, kMostCounts));
        one.reason = reason_in(table);
        const auto same = [&](const Exclusion& other) {
            return other.participant == one.participant && other.trial == one.trial;
        };
        if (std::any_of(out.begin(), out.end(), same)) table.fail(trial, "each trial of a participant once");
        out.push_back(std::move(one));
    });
    return out;
}

std::vector<Replacement> read_replacements(const fs::path& directory) {
    std::vector<Replacement> out;
    std::vector<std::string> notes;
    const std::vector<Person> people = read_people(directory, notes);
    read_rows(replacements_file(directory), kReplacementHeader, [&](const files::Table& table) {
        const std::size_t participant = table.column("participant"), by = table.column("replaced_by");
        Replacement one{code_in(table, participant), "", reason_in(table)};
        const auto earlier = std::find_if(
            out.begin(), out.end(), [&](const Replacement& other) { return other.participant == one.participant; });
        if (table.field(by) == kNobody) {
            if (earlier == out.end()) table.fail(by, "a code: nobody has this place yet");
            out.erase(earlier);  // who was to come had not come
            return;
        }
        one.replaced_by = code_in(table, by);
        if (earlier != out.end()) {
            if (is_among(people, earlier->replaced_by))
                table.fail(participant, "each participant once: " + earlier->replaced_by + " has this place already");
            out.erase(earlier);
        }
        for (const Replacement& other : out) {
            if (other.replaced_by == one.replaced_by) table.fail(by, "a participant who replaces nobody else");
        }
        if (one.participant == one.replaced_by) table.fail(by, "another participant");
        out.push_back(std::move(one));
    });
    return out;
}

void add_exclusion(const fs::path& directory, const Exclusion& exclusion) {
    const std::string reason = reason_text(exclusion.reason);
    if (!is_among(people_of_study(directory), exclusion.participant)) {
        throw files::bad_input("--participant", "", files::shown(exclusion.participant),
                               "a participant in " + (directory / "participants.tsv").string());
    }
    if (exclusion.trial && finished_trials(directory, exclusion.participant).count(*exclusion.trial) == 0) {
        throw files::bad_input("--trial", "", std::to_string(*exclusion.trial),
                               "a trial that " + exclusion.participant + " has finished");
    }
    for (const Exclusion& other : read_exclusions(directory)) {
        const bool within =
            !other.trial || other.trial == exclusion.trial;  // who is left out as a whole has no trial left
        if (other.participant != exclusion.participant || !within) continue;
        throw files::bad_input(exclusions_file(directory).string(), "",
                               (other.trial ? "trial " + trial_text(other) : "all trials") + " of " +
                                   other.participant + " already, because " + files::shown(other.reason),
                               "a trial that is not excluded yet");
    }
    append_line(exclusions_file(directory), kExclusionHeader,
                exclusion.participant + "\t" + trial_text(exclusion) + "\t" + reason);
}

std::string replaced_by(const fs::path& directory, const std::string& code) {
    for (const Replacement& one : read_replacements(directory)) {
        if (one.participant == code) return one.replaced_by;
    }
    return "";
}

void add_replacement(const fs::path& directory, const Replacement& replacement) {
    const std::string reason = reason_text(replacement.reason);
    const std::vector<Person> people = people_of_study(directory);
    const std::string among = " in " + (directory / "participants.tsv").string();
    if (!is_among(people, replacement.participant))
        throw files::bad_input("--participant", "", files::shown(replacement.participant), "a participant" + among);
    if (!is_code(replacement.replaced_by))
        throw files::bad_input("--by", "", files::shown(replacement.replaced_by), kCodeRule);
    if (is_among(people, replacement.replaced_by))
        throw files::bad_input("--by", "", files::shown(replacement.replaced_by),
                               "a code that is not yet" + among + ": who has begun keeps the place in the plan");
    if (const std::string alike = spelled_alike(people, replacement.replaced_by); !alike.empty())
        throw files::bad_input("--by", "", files::shown(replacement.replaced_by),
                               "a code that differs from " + alike + among + " by more than capitals or zeros");
    // simulated participants are called sim0001, sim0002, ... (app/study/simulate.cpp)
    if (read_identity(directory)->kind.simulated && replacement.replaced_by.starts_with("sim"))
        throw files::bad_input(
            "--by", "", files::shown(replacement.replaced_by),
            "a code that does not begin with 'sim': each simulated participant has one place in the plan");
    std::string lines;
    for (const Replacement& other : read_replacements(directory)) {
        if (other.participant == replacement.participant && is_among(people, other.replaced_by))
            throw files::bad_input("--participant", "", files::shown(other.participant),
                                   "somebody whose place is free: " + other.replaced_by + " has begun in it");
        if (other.replaced_by == replacement.replaced_by)
            throw files::bad_input("--by", "", files::shown(other.replaced_by),
                                   "another code: this one replaces " + other.participant + " already");
        // if that one comes all the same, these lines still say who has the place
        if (other.participant == replacement.participant)
            lines = other.participant + "\t" + kNobody + "\t" + other.replaced_by + " has not come\n";
    }
    lines += replacement.participant + "\t" + replacement.replaced_by + "\t" + reason;
    append_line(replacements_file(directory), kReplacementHeader, lines);
}

Numbers numbers_of(const std::vector<Person>& people, const std::vector<Replacement>& replacements) {
    Numbers numbers;
    const auto place_of = [&](const std::string& code) -> std::optional<int> {
        for (const Replacement& one : replacements) {
            if (one.replaced_by != code) continue;
            const auto it = numbers.of.find(one.participant);
            if (it != numbers.of.end()) return it->second;
            throw files::bad_input("replacements.tsv", "participant", files::shown(one.participant),
                                   "a participant who comes before " + code + " in participants.tsv");
        }
        return std::nullopt;
    };
    for (const Person& one : people) {
        const auto place = place_of(one.code);
        numbers.of[one.code] = place ? *place : numbers.next++;
    }
    for (const Replacement& one : replacements) {
        if (numbers.of.count(one.replaced_by) == 0) numbers.of[one.replaced_by] = *place_of(one.replaced_by);
    }
    return numbers;
}

}  // namespace palpa::study
