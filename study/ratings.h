#pragma once
// Answers of participants to a protocol's questions before the trials and after each condition, in one table per
// person:
//     sub-01/beh/sub-01_task-ratings_beh.tsv   condition item value

#include <filesystem>
#include <set>
#include <string>
#include <vector>

namespace palpa::study {

struct Rating {
    std::string condition = "n/a";  // n/a: asked before the trials
    std::string item;
    std::string value = "n/a";  // n/a: no answer
    bool chosen = false;        // one of the question's texts, as its protocol says
};

// Returns the file of a participant's answers, whether it is there or not.
std::filesystem::path ratings_file(const std::filesystem::path& directory, const std::string& code);

// Appends the answers; they are on the disk when the function returns. Tabs and line ends in values become spaces,
// double quotes single ones.
// Throws std::runtime_error if they cannot be written.
void add_ratings(const std::filesystem::path& directory, const std::string& code, const std::vector<Rating>& ratings);

// Returns an answer as it stands in the table.
std::string answer_text(const std::string& answer);

// A line of the table as it stands, without its header.
struct RatingLine {
    int number = 0;
    std::string text;
    std::vector<std::string> fields;
    bool cut_off = false;  // the last line, without its end
};
std::vector<RatingLine> rating_lines(const std::filesystem::path& directory, const std::string& code);

// Reads the answers of one participant; returns nothing if there is no file of them. A line that was cut off is left
// out and noted, also if later answers follow it. Line ends may be those of a spreadsheet (CR LF).
std::vector<Rating> read_ratings(const std::filesystem::path& directory, const std::string& code,
                                 std::vector<std::string>& notes);

// Writes what the file's columns mean, once for the whole dataset.
void explain_ratings_once(const std::filesystem::path& directory);

}  // namespace palpa::study
