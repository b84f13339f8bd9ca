#pragma once
// Which column of a table is what, and in which unit: by the person's word, by usual names, by the unit in
// the name (x_mm, "Fz [N]", force_mN), and by what the numbers can be.

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
    std::string name;  // in the file
};

struct Columns {
    std::array<std::optional<Column>, kRoles> of;
    bool has(Role role) const { return of[static_cast<std::size_t>(role)].has_value(); }
    const Column& operator[](Role role) const { return *of[static_cast<std::size_t>(role)]; }
};

// Throws InputError for a role or a column that does not exist, and for units that contradict each other.
Columns find_columns(const files::Table& table, const ImportOptions& options);

// Throws InputError that lists what there is, if the column is missing.
void need(const Columns& columns, const files::Table& table, std::initializer_list<Role> roles);

// The form that these columns are of; throws InputError if they are of none.
RecordingForm form_of(const Columns& columns, const files::Table& table);

inline double value_of(const files::Table& table, const Columns& columns, Role role) {
    const Column& column = columns[role];
    return column.to_SI * table.number(column.index);
}

// Refuses numbers of another unit than they claim, unless the person has stated the unit.
void check_force_size(double greatest_N, const Columns& columns, const ImportOptions& options, const std::string& file);
void check_length_size(double extent_m, const ImportOptions& options, const std::string& file);
void check_depth_size(double greatest_m, const ImportOptions& options, const std::string& file);

// The separator of a table: tab, semicolon or comma, whichever stands most often in its first line.
char separator_of(std::string_view first_line);

}  // namespace palpa::stiffnessmaps
