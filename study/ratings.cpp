#include "study/ratings.h"

#include <algorithm>
#include <stdexcept>

#include "files/append_file.h"
#include "files/input_error.h"
#include "files/json.h"
#include "files/text.h"

namespace palpa::study {
namespace {

namespace fs = std::filesystem;

constexpr const char* kHeader = "condition\titem\tvalue";
constexpr const char* kCutOff = "\t\t\tcut off";  // four fields at least: a half answer never becomes a whole one

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
    files::append_synced(file, lines, kCutOff);
}

std::vector<RatingLine> rating_lines(const fs::path& directory, const std::string& code) {
    std::vector<RatingLine> out;
    const fs::path file = ratings_file(directory, code);
    if (!fs::exists(file)) return out;
    const std::string text = files::read_text(file);
    int number = 0;
    for (std::string_view row : files::fields_of(text, '\n')) {
        ++number;
        const bool cut_off = row.data() + row.size() == text.data() + text.size();
        constexpr std::string_view kByteOrderMark = "\xEF\xBB\xBF";
        if (number == 1 && row.substr(0, kByteOrderMark.size()) == kByteOrderMark)
            row.remove_prefix(kByteOrderMark.size());
        if (!row.empty() && row.back() == '\r') row.remove_suffix(1);  // saved by a spreadsheet
        if (row.empty() || (number == 1 && row == kHeader)) continue;
        RatingLine line{number, std::string(row), {}, cut_off};
        for (const std::string_view field : files::fields_of(row, '\t')) line.fields.emplace_back(field);
        out.push_back(std::move(line));
    }
    return out;
}

std::vector<Rating> read_ratings(const fs::path& directory, const std::string& code, std::vector<std::string>& notes) {
    std::vector<Rating> out;
    const std::string file = ratings_file(directory, code).string();
    for (const RatingLine& line : rating_lines(directory, code)) {
        const std::string place = file + ": line " + std::to_string(line.number) + " is left out: ";
        if (line.cut_off) {
            notes.push_back(place + "it was cut off after " + std::to_string(line.text.size()) + " bytes");
        } else if (line.fields.size() != 3) {  // a line that was cut off, and to which a later one was appended
            notes.push_back(place + files::shown(line.text) + " is not an answer with 3 fields");
        } else {
            out.push_back({line.fields[0], line.fields[1], line.fields[2]});
        }
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
