#include "files/table.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/input_error.h"
#include "files/printable.h"
#include "files/text.h"

namespace palpa::files {
namespace {

// Takes a field in double quotes from the front of `line`, which lies in `text`. It ends at the next single quote; two
// in a row stand for one in the field, and the gap that this leaves is closed inside `text`. Returns false if no quote
// closes the field.
bool take_quoted(std::string& text, std::string_view& line, std::string_view& field) {
    char* const begin = text.data() + (line.data() - text.data()) + 1;
    const char* const end = line.data() + line.size();
    const char* from = begin;
    char* to = begin;
    for (; from != end; ++from) {
        if (*from == '"') {
            const bool doubled = from + 1 != end && from[1] == '"';
            if (!doubled) {
                field = {begin, static_cast<std::size_t>(to - begin)};
                line.remove_prefix(static_cast<std::size_t>(from + 1 - line.data()));
                return true;
            }
            ++from;
        }
        *to++ = *from;
    }
    return false;
}

}  // namespace

Table::Table(std::string text, std::string file_name, char separator)
    : text_(std::move(text)), file_(std::move(file_name)), separator_(separator) {
    constexpr std::string_view kByteOrderMark = "\xef\xbb\xbf";
    if (std::string_view(text_).substr(0, 3) == kByteOrderMark) at_ = 3;
    std::string_view header;
    if (!next_line(header) || header.empty()) throw bad_input(file_, "line 1", "nothing", "a header line");
    split(header);
    columns_.assign(fields_.begin(), fields_.end());
    std::vector<std::string_view> sorted = fields_;
    std::sort(sorted.begin(), sorted.end());
    const auto twice = std::adjacent_find(sorted.begin(), sorted.end());
    if (twice != sorted.end()) throw bad_input(file_, "line 1", "the column " + shown(*twice) + " twice", "it once");
}

bool Table::has_column(std::string_view name) const {
    return std::find(columns_.begin(), columns_.end(), name) != columns_.end();
}

std::size_t Table::column(std::string_view name) const {
    const auto it = std::find(columns_.begin(), columns_.end(), name);
    if (it != columns_.end()) return static_cast<std::size_t>(it - columns_.begin());
    std::string found = "the columns";
    for (const auto& column : columns_) found += " " + shown(column);
    throw bad_input(file_, "line 1", found, "a column " + shown(name));
}

bool Table::next_line(std::string_view& out) {
    if (at_ >= text_.size()) return false;
    const std::string_view rest = std::string_view(text_).substr(at_);
    const auto end = std::min(rest.find('\n'), rest.size());
    out = rest.substr(0, end);
    if (!out.empty() && out.back() == '\r') out.remove_suffix(1);
    at_ += end + 1;
    ++line_;
    return true;
}

// Quotes have no meaning in tables that are separated by tabs, whose fields hold no tab.
void Table::split(std::string_view line) {
    fields_.clear();
    while (true) {
        std::string_view field = line.substr(0, line.find(separator_));
        if (separator_ != '\t' && line.starts_with('"')) {
            if (!take_quoted(text_, line, field) || !(line.empty() || line.front() == separator_)) {
                throw bad_input(file_, "line " + std::to_string(line_), "a quote that opens the field " + shown(field),
                                "one that closes it, at the end of the field");
            }
        } else {
            line.remove_prefix(field.size());
        }
        fields_.push_back(field);
        if (line.empty()) return;
        line.remove_prefix(1);
    }
}

bool Table::next() {
    std::string_view line;
    do {
        if (!next_line(line)) return false;
    } while (line.empty());
    split(line);
    if (fields_.size() != columns_.size()) {
        const bool comma_for_point = separator_ == ',' && fields_.size() > columns_.size();
        throw bad_input(file_, "line " + std::to_string(line_), std::to_string(fields_.size()) + " fields",
                        std::to_string(columns_.size()) + " as in the header" +
                            (comma_for_point ? " (a decimal comma? numbers need a point)" : ""));
    }
    return true;
}

double Table::done() const {
    return text_.empty() ? 1.0 : static_cast<double>(std::min(at_, text_.size())) / static_cast<double>(text_.size());
}

void Table::fail(std::size_t column, std::string_view expected) const {
    throw bad_input(file_, "line " + std::to_string(line_) + ", " + columns_[column], shown(fields_[column]), expected);
}

double Table::number(std::size_t column) const {
    const std::string_view text = fields_[column];
    if (text.empty() || text == "n/a") return std::numeric_limits<double>::quiet_NaN();
    double value = 0.0;
    if (!parse_number(text, value) || std::isinf(value)) {
        const bool comma = text.find(',') != std::string_view::npos;
        fail(column, comma ? "a number with a decimal point, not a comma" : "a finite number or n/a");
    }
    return value;
}

double Table::finite_number(std::size_t column) const {
    const double value = number(column);
    if (std::isnan(value)) fail(column, "a finite number");
    return value;
}

Table read_tsv(const std::filesystem::path& path) {
    std::string text = read_text(path);
    if (!is_utf8(text)) {  // names of another encoding would be told apart here and be one in JSON
        std::string_view rest = text;
        for (int line = 1; !rest.empty(); ++line) {
            const std::string_view here = rest.substr(0, rest.find('\n'));
            if (!is_utf8(here))
                throw bad_input(path.string(), "line " + std::to_string(line), shown(here), "text in UTF-8");
            rest.remove_prefix(std::min(here.size() + 1, rest.size()));
        }
    }
    return Table(std::move(text), path.string(), '\t');
}
Table read_csv(const std::filesystem::path& path) { return Table(read_text(path), path.string(), ','); }

}  // namespace palpa::files
