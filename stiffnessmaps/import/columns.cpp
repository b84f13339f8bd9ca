#include "stiffnessmaps/import/columns.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <string_view>

#include "files/input_error.h"
#include "files/text.h"

namespace palpa::stiffnessmaps {
namespace {

using Names = std::vector<std::string_view>;

struct KnownRole {
    Role role;
    const char* name;
    Names usual;  // without the unit, in lower case, the likeliest first
};

// Entries in the order of Role.
const std::array<KnownRole, kRoles>& known_roles() {
    static const std::array<KnownRole, kRoles> known{{
        {Role::time, "t", {"t", "time", "timestamp"}},
        {Role::point, "point", {"point", "point_id", "location", "site"}},
        {Role::x, "x", {"ref_x", "x", "pos_x", "x_pos", "position_x", "contact_x", "px", "tip_x"}},
        {Role::y, "y", {"ref_y", "y", "pos_y", "y_pos", "position_y", "contact_y", "py", "tip_y"}},
        {Role::z, "z", {"z", "pos_z", "z_pos", "position_z", "pz", "tip_z"}},
        {Role::depth, "depth", {"depth", "indentation", "penetration", "indent"}},
        {Role::commanded_depth, "depth_cmd", {"depth_cmd", "cmd_depth", "commanded_depth", "depth_commanded"}},
        {Role::normal_force, "fn", {"fn", "normal_force", "force_normal", "f_n", "force", "load", "f", "normal"}},
        {Role::force_x, "fx", {"fx", "force_x", "f_x", "x_force"}},
        {Role::force_y, "fy", {"fy", "force_y", "f_y", "y_force"}},
        {Role::force_z, "fz", {"fz", "force_z", "f_z", "z_force"}},
        {Role::normal_x, "n_x", {"n_x", "nx", "normal_x"}},
        {Role::normal_y, "n_y", {"n_y", "ny", "normal_y"}},
        {Role::normal_z, "n_z", {"n_z", "nz", "normal_z"}},
    }};
    return known;
}

bool is_force(Role role) { return role >= Role::normal_force && role <= Role::force_z; }
bool is_depth(Role role) { return role == Role::depth || role == Role::commanded_depth; }
bool is_position(Role role) { return role == Role::x || role == Role::y || role == Role::z; }

struct Unit {
    const char* name;
    double to_SI;
    char of;  // l length, f force, t time
};
// "m" always means metres: a column "fx_m" is not taken for a force
constexpr std::array<Unit, 14> kUnits{{{"mm", 1e-3, 'l'},
                                       {"um", 1e-6, 'l'},
                                       {"cm", 1e-2, 'l'},
                                       {"m", 1.0, 'l'},
                                       {"mN", 1e-3, 'f'},
                                       {"kN", 1e3, 'f'},
                                       {"N", 1.0, 'f'},
                                       {"gf", 9.80665e-3, 'f'},
                                       {"kgf", 9.80665, 'f'},
                                       {"lbf", 4.4482216152605, 'f'},
                                       {"uN", 1e-6, 'f'},
                                       {"in", 0.0254, 'l'},
                                       {"ms", 1e-3, 't'},
                                       {"s", 1.0, 't'}}};

bool is_blank(char c) { return c == ' ' || c == '"' || c == '\''; }

// Letters that say a unit elsewhere, of which it is not known what they mean here (g of a scale: mass, force?). The last part
// of a name that is one of them is no unit-less name, and is not taken for mm or N.
constexpr std::array kOtherUnits{
    "gr",     "volt", "volts", "count", "counts", "adc", "g",  "kg",  "mg",  "gram",  "grams",  "lb",  "lbs", "pound",
    "pounds", "oz",   "ozf",   "dyn",   "dyne",   "cN",  "kp", "Pa",  "kPa", "MPa",   "bar",    "psi", "V",   "mV",
    "nm",     "dm",   "km",    "inch",  "inches", "ft",  "yd", "mil", "px",  "pixel", "pixels", "us",  "ns",  "min"};

// A name whose last part stands in brackets or behind a slash states a unit, whatever it is.
bool states_a_unit(std::string_view name) {
    while (!name.empty() && is_blank(name.back())) name.remove_suffix(1);
    return !name.empty() && (name.back() == ')' || name.back() == ']' || name.find('/') != std::string_view::npos);
}

struct SplitName {
    std::string bare;            // lower case
    const Unit* unit = nullptr;  // null if the name has none
};

std::string lower(std::string_view text) {
    std::string out(text);
    for (char& c : out) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return out;
}

// What follows the last blank, underscore, bracket or slash of a name: its unit, if it has one. "" for a name of one part.
std::string_view last_part(std::string_view name) {
    while (!name.empty() && (is_blank(name.back()) || name.back() == ')' || name.back() == ']')) name.remove_suffix(1);
    const auto cut = name.find_last_of("_ ([/");
    return cut == std::string_view::npos || cut == 0 ? std::string_view() : name.substr(cut + 1);
}

// Splits a name into its bare part and its unit: "Fz [mN]", "fz_mN", "x (mm)", "x".
SplitName split_name(std::string_view name) {
    while (!name.empty() && is_blank(name.front())) name.remove_prefix(1);
    const std::string_view last = last_part(name);
    for (const Unit& unit : kUnits) {
        if (last != unit.name) continue;
        name = name.substr(0, static_cast<std::size_t>(last.data() - name.data()) - 1);
        while (!name.empty() && (name.back() == ' ' || name.back() == '_' || name.back() == '/')) name.remove_suffix(1);
        return {lower(name), &unit};
    }
    while (!name.empty() && (is_blank(name.back()) || name.back() == ')' || name.back() == ']')) name.remove_suffix(1);
    return {lower(name), nullptr};
}

// Returns the unit that a name states and that is none of the known ones; "" if it states none.
std::string_view other_unit(std::string_view name) {
    if (split_name(name).unit != nullptr) return {};
    const std::string_view last = last_part(name);
    const bool other = std::find(kOtherUnits.begin(), kOtherUnits.end(), last) != kOtherUnits.end();
    return other || states_a_unit(name) ? last : std::string_view();
}

// Returns the name before such a unit, in lower case.
std::string bare_name(std::string_view name) {
    const std::string_view unit = other_unit(name);
    if (unit.empty()) return split_name(name).bare;
    name = name.substr(0, static_cast<std::size_t>(unit.data() - name.data()) - 1);
    return split_name(name).bare;
}

char kind_of(Role role) {
    if (is_force(role)) return 'f';
    if (is_depth(role) || is_position(role)) return 'l';
    return role == Role::time ? 't' : ' ';
}

// Returns the option that states the unit of a role; null if there is none.
const char* unit_option(Role role) {
    return is_force(role)      ? "--force-unit N or mN"
           : is_depth(role)    ? "--depth-unit mm, m or um"
           : is_position(role) ? "--length-unit mm, m or um"
                               : nullptr;
}

std::string units_wanted(Role role) {
    const char kind = kind_of(role);
    const std::string known = kind == 'f'   ? "N, mN, uN, kN, gf, kgf or lbf"
                              : kind == 'l' ? "mm, m, cm, um or in"
                                            : "s or ms";
    const char* option = unit_option(role);
    return known + (option != nullptr ? std::string(", or its unit stated by ") + option : std::string());
}

bool unit_stated(Role role, const ImportOptions& options) {
    return (is_force(role) && options.force_unit) || (is_depth(role) && options.depth_unit) ||
           (is_position(role) && options.length_unit);
}

double metres_of(LengthUnit unit) { return unit == LengthUnit::mm ? 1e-3 : unit == LengthUnit::m ? 1.0 : 1e-6; }

double unit_of(Role role, const SplitName& name, const ImportOptions& options, const std::string& column,
               const std::string& file) {
    const char kind = kind_of(role);
    if (kind == 'f' && options.force_unit) return *options.force_unit == ForceUnit::N ? 1.0 : 1e-3;
    if (is_depth(role) && options.depth_unit) return metres_of(*options.depth_unit);
    if (is_position(role) && options.length_unit) return metres_of(*options.length_unit);
    if (name.unit != nullptr) {
        if (name.unit->of != kind) {
            throw files::bad_input(file, "line 1", "the column " + files::shown(column) + " as " + name_of(role),
                                   kind == 'f'   ? "a force (N, mN, gf)"
                                   : kind == 'l' ? "a length (mm, m, um)"
                                   : kind == 't' ? "a time (s, ms)"
                                                 : "a number without a unit");
        }
        return name.unit->to_SI;
    }
    if (const std::string_view other = other_unit(column); kind != ' ' && !other.empty()) {
        throw files::bad_input(
            file, "line 1",
            "the column " + files::shown(column) + " as " + name_of(role) + ", in " + files::shown(other),
            "one in " + units_wanted(role));
    }
    return kind == 'l' ? 1e-3 : 1.0;
}

std::string unit_named(Role role, double to_SI) {
    for (const Unit& unit : kUnits) {
        if (unit.of == kind_of(role) && unit.to_SI == to_SI) return unit.name;
    }
    return "";
}

std::optional<std::size_t> index_of(const std::vector<std::string>& columns, std::string_view name) {
    const auto it = std::find(columns.begin(), columns.end(), name);
    if (it == columns.end()) return std::nullopt;
    return static_cast<std::size_t>(it - columns.begin());
}

// Returns the column that has the first of the role's usual names that any column has.
std::optional<std::size_t> usual_index(const KnownRole& known, const std::vector<SplitName>& names) {
    for (const std::string_view usual : known.usual) {
        for (std::size_t i = 0; i < names.size(); ++i) {
            const bool fits = names[i].unit == nullptr || names[i].unit->of == kind_of(known.role);
            if (fits && names[i].bare == usual) return i;
        }
    }
    return std::nullopt;
}

// Returns the column that has one of the role's usual names before a unit that is not known.
std::optional<std::size_t> other_unit_index(const KnownRole& known, const std::vector<std::string>& columns) {
    for (const std::string_view usual : known.usual) {
        for (std::size_t i = 0; i < columns.size(); ++i) {
            if (!other_unit(columns[i]).empty() && bare_name(columns[i]) == usual) return i;
        }
    }
    return std::nullopt;
}

// Takes columns of other units where the person states the unit, unless one of that kind is known by its own name: then
// the option is meant for that one.
void take_stated_units(const files::Table& table, const std::vector<SplitName>& names, const ImportOptions& options,
                       Columns& columns) {
    const Columns before = columns;
    for (const KnownRole& known : known_roles()) {
        const auto same_kind = [&](const KnownRole& other) {
            return before.has(other.role) && is_force(other.role) == is_force(known.role) &&
                   is_depth(other.role) == is_depth(known.role) && is_position(other.role) == is_position(known.role);
        };
        const auto& roles = known_roles();
        if (!unit_stated(known.role, options) || std::any_of(roles.begin(), roles.end(), same_kind)) continue;
        const auto index = other_unit_index(known, table.columns());
        if (!index) continue;
        const std::string& name = table.columns()[*index];
        const double to_SI = unit_of(known.role, names[*index], options, name, table.file());
        columns.of[static_cast<std::size_t>(known.role)] = Column{*index, to_SI, name, unit_named(known.role, to_SI)};
    }
}

// Throws InputError if one of the columns would be the role's, were its unit known.
void refuse_other_unit(const KnownRole& known, const files::Table& table) {
    const auto index = other_unit_index(known, table.columns());
    if (!index) return;
    const std::string& name = table.columns()[*index];
    throw files::bad_input(table.file(), "line 1",
                           "the column " + files::shown(name) + ", in " + files::shown(other_unit(name)),
                           "a column for " + std::string(known.name) + " in " + units_wanted(known.role));
}

std::string all_roles() {
    std::string out;
    for (const KnownRole& known : known_roles()) out += (out.empty() ? "" : ", ") + std::string(known.name);
    return out;
}

}  // namespace

const char* name_of(Role role) { return known_roles()[static_cast<std::size_t>(role)].name; }

Columns find_columns(const files::Table& table, const ImportOptions& options) {
    for (const auto& [role, name] : options.columns) {
        const auto& known = known_roles();
        const bool is_known =
            std::any_of(known.begin(), known.end(), [&asked = role](const KnownRole& k) { return asked == k.name; });
        if (!is_known) throw files::bad_input("--column", "", files::shown(role), "one of " + all_roles());
        table.column(name);
    }
    std::vector<SplitName> names;
    for (const std::string& column : table.columns()) names.push_back(split_name(column));
    Columns columns;
    for (const KnownRole& known : known_roles()) {
        const auto asked = options.columns.find(known.name);
        const auto index =
            asked != options.columns.end() ? index_of(table.columns(), asked->second) : usual_index(known, names);
        if (!index) continue;
        const std::string& name = table.columns()[*index];
        const double to_SI = unit_of(known.role, names[*index], options, name, table.file());
        columns.of[static_cast<std::size_t>(known.role)] = Column{*index, to_SI, name, unit_named(known.role, to_SI)};
    }
    take_stated_units(table, names, options, columns);
    return columns;
}

void need(const Columns& columns, const files::Table& table, std::initializer_list<Role> roles) {
    for (const Role role : roles) {
        if (columns.has(role)) continue;
        const KnownRole& known = known_roles()[static_cast<std::size_t>(role)];
        refuse_other_unit(known, table);
        if (role == Role::normal_force)  // in whose place a force along z may stand
            refuse_other_unit(known_roles()[static_cast<std::size_t>(Role::force_z)], table);
        std::string found = "the columns";
        for (const std::string& column : table.columns()) found += " " + files::shown(column);
        std::string expected = "a column for " + std::string(known.name) + " (";
        for (const std::string_view usual : known.usual)
            expected += (expected.back() == '(' ? "" : ", ") + std::string(usual);
        throw files::bad_input(table.file(), "line 1", found,
                               expected + ", with or without a unit; or name it: --column " + known.name + "=NAME)");
    }
}

RecordingForm form_of(const Columns& columns, const files::Table& table) {
    const bool forces = columns.has(Role::force_z) || columns.has(Role::normal_force);
    if (columns.has(Role::time) && columns.has(Role::z) && forces && !columns.has(Role::point))
        return RecordingForm::sliding;
    if (columns.has(Role::point) || columns.has(Role::depth)) return RecordingForm::probing;
    if (columns.has(Role::z) && forces) return RecordingForm::probing;
    for (const Role role : {Role::depth, Role::z, Role::normal_force, Role::force_z}) {
        if (!columns.has(role)) refuse_other_unit(known_roles()[static_cast<std::size_t>(role)], table);
    }
    std::string found = "the columns";
    for (const std::string& column : table.columns()) found += " " + files::shown(column);
    throw files::bad_input(table.file(), "line 1", found,
                           "probing (x, y, depth or z, fn or fz, ...) or sliding (t, x, y, z, fx, fy, fz); name "
                           "them with --column");
}

void check_force_size(double greatest_N, const Columns& columns, const ImportOptions& options,
                      const std::string& file) {
    if (options.force_unit || greatest_N == 0.0) return;
    constexpr double kLeast_N = 0.01;
    constexpr double kMost_N = 200.0;
    if (greatest_N >= kLeast_N && greatest_N <= kMost_N) return;
    const Role role = columns.has(Role::normal_force) ? Role::normal_force : Role::force_z;
    const bool raw = columns.has(role) || (options.quantity == Quantity::force && !options.scale_stated);
    throw files::bad_input(file, columns.has(role) ? columns[role].name : "",
                           "a greatest force of " + files::short_number(greatest_N) + " N",
                           std::string("from 0.01 to 200 N on soft tissue: ") +
                               (raw ? "state the column's unit by --force-unit mN, or N if it is right"
                                    : "another --scale, or --force-unit N if the force is right"));
}

void check_length_size(double extent_m, const ImportOptions& options, const std::string& file) {
    constexpr double kAbsurd_m = 100.0;
    if (!(extent_m <= kAbsurd_m)) {
        throw files::bad_input(file, "", "places that extend over " + files::short_number(extent_m) + " m",
                               "at most 100 m");
    }
    if (options.length_unit || extent_m == 0.0) return;
    constexpr double kLeast_m = 1e-3;
    constexpr double kMost_m = 1.0;
    if (extent_m >= kLeast_m && extent_m <= kMost_m) return;
    throw files::bad_input(
        file, "", "places that extend over " + files::short_number(1e3 * extent_m) + " mm",
        "from 1 to 1000 mm: state the unit of the positions by --length-unit m, um, or mm if it is right");
}

void check_depth_size(double greatest_m, const ImportOptions& options, const std::string& file) {
    if (options.depth_unit || greatest_m == 0.0) return;
    constexpr double kLeast_m = 0.05e-3;
    constexpr double kMost_m = 0.1;
    if (greatest_m >= kLeast_m && greatest_m <= kMost_m) return;
    throw files::bad_input(
        file, "", "a greatest depth of " + files::short_number(1e3 * greatest_m) + " mm",
        "from 0.05 to 100 mm: state the unit of the depths by --depth-unit m, um, or mm if it is right");
}

char separator_of(std::string_view first_line) {
    char best = ',';
    std::ptrdiff_t most = 0;
    for (const char c : {',', '\t', ';'}) {
        const auto n = std::count(first_line.begin(), first_line.end(), c);
        if (n > most) {
            most = n;
            best = c;
        }
    }
    return best;
}

}  // namespace palpa::stiffnessmaps
