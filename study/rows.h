#pragma once
// Tables of a study: one list of fields gives the header, the explanation (the JSON sidecar) and every row.
//
// A row type R has a function  visit_fields(const R&, visit)  that calls  visit(name, value, unit, description) for
// each column.

#include <charconv>
#include <cstdint>
#include <string>
#include <string_view>

#include "files/json.h"
#include "files/text.h"

namespace palpa::study {

inline void append_field(double value, std::string& row) { files::append_number(value, row); }
// Text in a field: what would end the field, or what tables take for the begin of a quoted one, is replaced.
inline void append_field(std::string_view value, std::string& row) {
    for (const char c : value) row.push_back(static_cast<unsigned char>(c) < 0x20 ? ' ' : c == '"' ? '\'' : c);
}
inline void append_field(std::int64_t value, std::string& row) {
    char digits[24];
    const auto [end, error] = std::to_chars(digits, digits + sizeof digits, value);
    static_cast<void>(error);
    row.append(digits, end);
}

template <class Row>
std::string header_of() {
    std::string header;
    visit_fields(Row{},
                 [&](std::string_view name, auto&&...) { header.append(header.empty() ? "" : "\t").append(name); });
    return header + "\n";
}

// Writes `row` into `line`, replacing its content. Allocates nothing once `line` is long enough.
template <class Row>
void line_of(const Row& row, std::string& line) {
    line.clear();
    visit_fields(row, [&](std::string_view, const auto& field, auto&&...) {
        if (!line.empty()) line.push_back('\t');
        append_field(field, line);
    });
    line.push_back('\n');
}

template <class Row>
std::string explanation_of() {
    files::Json json;
    visit_fields(Row{}, [&](std::string_view name, const auto&, std::string_view unit, std::string_view text) {
        files::Json& column = json[std::string(name)];
        column["Description"] = text;
        if (!unit.empty()) column["Units"] = unit;
    });
    return files::json_text(json);
}

}  // namespace palpa::study
