#pragma once
// Finds out which column of a table is what, and in which unit: from the person's options, the usual names, the unit in
// the name (x_mm, "Fz [N]", force_mN), and the values that are possible.

#include <array>
#include <optional>
#include <string>
#include <vector>

#include "files/table.h"
#include "stiffnessmaps/import/options.h"

namespace palpa::stiffnessmaps {

enum class Role {
    time,
    point,
    x,
    y,
    z,
    depth,
    commanded_depth,
    normal_force,
    force_x,
    force_y,
    force_z,
    normal_x,
    normal_y,
    normal_z,
};
inline constexpr std::size_t kRoles = 14;
const char* name_of(Role role);  // as in --column: "x", "depth_cmd", "fn", ...

struct Column {
    std::size_t index = 0;
    double to_SI = 1.0;
    std::string name;  // as in the file
    std::string unit;  // that it is taken in; "" for a number without one
};

struct Columns {
    std::array<std::optional<Column>, kRoles> of;
    bool has(Role role) const { return of[static_cast<std::size_t>(role)].has_value(); }
    const Column& operator[](Role role) const { return *of[static_cast<std::size_t>(role)]; }
};

// Throws InputError for a role or a column that does not exist, and for a unit that does not fit its role.
Columns find_columns(const files::Table& table, const ImportOptions& options);

// Throws InputError that lists the columns of the table if one of `roles` is missing.
void need(const Columns& columns, const files::Table& table, std::initializer_list<Role> roles);

// Returns the form of recording that these columns indicate. Throws InputError if they indicate none.
RecordingForm form_of(const Columns& columns, const files::Table& table);

// Returns a column of the current row in SI units; NaN for n/a.
inline double value_of(const files::Table& table, const Columns& columns, Role role) {
    const Column& column = columns[role];
    return column.to_SI * table.number(column.index);
}

// Throw InputError if the largest values are implausible in the unit assumed, unless the person has stated the unit.
void check_force_size(double greatest_N, const Columns& columns, const ImportOptions& options, const std::string& file);
void check_length_size(double extent_m, const ImportOptions& options, const std::string& file);
void check_depth_size(double greatest_m, const ImportOptions& options, const std::string& file);

// Returns the separator of a table: tab, semicolon or comma, whichever is most frequent in its first line.
char separator_of(std::string_view first_line);

}  // namespace palpa::stiffnessmaps
