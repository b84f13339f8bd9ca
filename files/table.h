#pragma once
// Tables with one header line, separated by tabs, commas or semicolons; with the latter two a field may be in double
// quotes (RFC 4180). Rows are read one after the other; messages name the file, the line and the column.

#include <filesystem>
#include <string>
#include <string_view>
#include <vector>

namespace palpa::files {

class Table {
  public:
    Table(std::string text, std::string file_name, char separator);
    // Not copied: the fields of the row point into the text, and a short text is stored inside its string object.
    Table(const Table&) = delete;
    Table& operator=(const Table&) = delete;

    const std::vector<std::string>& columns() const { return columns_; }
    // Throws InputError if the column is missing; the message lists the columns that exist.
    std::size_t column(std::string_view name) const;
    bool has_column(std::string_view name) const;

    // Moves to the next row; returns false at the end. Blank lines are skipped. Throws InputError if the number of
    // fields differs from the header's.
    bool next();

    std::string_view field(std::size_t column) const { return fields_[column]; }
    // Returns a finite number, or NaN for "n/a", "nan" and an empty field; throws InputError for all other fields.
    double number(std::size_t column) const;
    double finite_number(std::size_t column) const;  // throws for NaN too
    // Throws InputError for a field of the current row.
    [[noreturn]] void fail(std::size_t column, std::string_view expected) const;
    std::size_t line() const { return line_; }
    double done() const;  // share of the text read so far, 0 ... 1
    const std::string& file() const { return file_; }

  private:
    bool next_line(std::string_view& out);
    void split(std::string_view line);

    std::string text_;
    std::string file_;
    char separator_;
    std::size_t at_ = 0;
    std::size_t line_ = 0;
    std::vector<std::string> columns_;
    std::vector<std::string_view> fields_;
};

Table read_tsv(const std::filesystem::path& path);  // throws InputError for text that is not UTF-8
Table read_csv(const std::filesystem::path& path);

}  // namespace palpa::files
