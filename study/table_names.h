#pragma once
// Names in tables of counts, which people write by hand or in a spreadsheet.

#include <string>
#include <string_view>
#include <vector>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "study/names.h"

namespace palpa::study {

// Returns the name in a field of the current row. Throws InputError with file, line and column if it is none.
inline std::string_view name_in(const files::Table& table, std::size_t column) {
    const std::string_view name = table.field(column);
    if (!is_name(name)) table.fail(column, kNameRule);
    if (has_outer_space(name)) table.fail(column, "a name without a space at its ends");
    return name;
}

// Throws InputError if one of several conditions is the sum of the others.
inline void refuse_sum(const files::Table& table, const std::vector<std::string>& conditions) {
    for (const std::string& condition : conditions) {
        if (conditions.size() < 2 || !names_a_sum(condition)) continue;
        throw files::bad_input(table.file(), "condition", files::shown(condition) + " beside other conditions",
                               "conditions only: a sum would be compared with its parts");
    }
}

}  // namespace palpa::study
