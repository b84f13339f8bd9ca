#include "study/ratings.h"

#include <algorithm>
#include <stdexcept>

#include "files/append_file.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/text.h"
#include "study/run_log.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader = "condition\titem\tvalue";

std::string one_field(std::string text) {
    std::replace_if(
        text.begin(), text.end(), [](char c) { return c == '\t' || c == '\n' || c == '\r'; }, ' ');
    std::replace(text.begin(), text.end(), '"', '\'');  // tables take a double quote for the begin of a quoted field
    return text.empty() ? "n/a" : text;
}

}  // namespace

fs::path ratings_file(const fs::path& directory, const std::string& code) {
    return directory / ("sub-" + code) / "beh" / ("sub-" + code + "_task-ratings_beh.tsv");
}

std::string answer_text(const std::string& answer) { return one_field(answer); }

void add_ratings(const fs::path& directory, const std::string& code, const std::vector<Rating>& ratings) {
    if (ratings.empty()) return;
    const fs::path file = ratings_file(directory, code);
    std::error_code error;
    fs::create_directories(file.parent_path(), error);
    if (error) throw std::runtime_error(file.parent_path().string() + ": cannot be created: " + error.message());
    std::string lines;
    if (!fs::exists(file) || fs::file_size(file) == 0) lines = std::string(kHeader) + "\n";
    for (const Rating& r : ratings)
        lines += one_field(r.condition) + "\t" + one_field(r.item) + "\t" + one_field(r.value) + "\n";
    files::append_synced(file, lines);
}

std::vector<Rating> read_ratings(const fs::path& directory, const std::string& code, std::vector<std::string>& notes) {
    std::vector<Rating> out;
    const fs::path file = ratings_file(directory, code);
    if (!fs::exists(file)) return out;
    const std::string text = files::read_text(file);
    const std::string_view whole = whole_lines(text, file.string(), notes);
    if (whole.empty()) return out;
    int line = 0;
    for (std::string_view row : files::fields_of(whole.substr(0, whole.size() - 1), '\n')) {
        ++line;
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (line == 1 && row.substr(0, kByteOrderMark.size()) == kByteOrderMark)
            row.remove_prefix(kByteOrderMark.size());
        if (!row.empty() && row.back() == '\r') row.remove_suffix(1);  // saved by a spreadsheet
        if (row.empty() || (line == 1 && row == kHeader)) continue;
        const auto fields = files::fields_of(row, '\t');
        if (fields.size() != 3) {  // a line that was cut off, and to which a later one was appended
            notes.push_back(file.string() + ": line " + std::to_string(line) + " is left out: " + files::shown(row) +
                            " is not an answer with 3 fields");
            continue;
        }
        out.push_back({std::string(fields[0]), std::string(fields[1]), std::string(fields[2])});
    }
    return out;
}

void explain_ratings_once(const fs::path& directory) {
    const fs::path file = directory / "task-ratings_beh.json";
    if (fs::exists(file)) return;
    files::write_text_atomically(
        file, files::json_text(
                  {{"condition",
                    {{"Description", "of the protocol, after whose trials it was asked; n/a: before all trials"}}},
                   {"item", {{"Description", "id of the question in protocol.json"}}},
                   {"value", {{"Description", "the answer, as it was chosen or typed; n/a: none"}}}}));
}

}  // namespace palpa::study
