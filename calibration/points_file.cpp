#include <algorithm>
#include <cmath>
#include <map>
#include <set>

#include "calibration/points.h"
#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"

namespace palpa::calibration {
namespace {

constexpr double kN_per_gf = 9.80665e-3;

struct Columns {
    std::size_t level = 0;
    std::optional<std::size_t> force_N, force_gf, time_s, repeat, phase;
    std::vector<std::size_t> where;
    std::vector<std::size_t> session;  // columns that distinguish sessions
    std::optional<std::size_t> pen, tablet, driver, os, date;
};

Columns find_columns(const files::Table& table, const ReadOptions& options) {
    const auto optional = [&](const char* name) {
        return table.has_column(name) ? std::optional(table.column(name)) : std::nullopt;
    };
    Columns columns;
    columns.level =
        table.column(!table.has_column("level") && table.has_column("pressure_norm") ? "pressure_norm" : "level");
    columns.force_N = optional("force_N");
    columns.force_gf = optional("force_gf");
    if (!columns.force_N && !columns.force_gf) table.column("force_N");  // throws, listing the columns
    columns.time_s = optional("time_s");
    columns.repeat = optional("repeat");
    columns.phase = optional("phase");
    for (const RowFilter& filter : options.where) columns.where.push_back(table.column(filter.column));
    for (const char* name : {"pen", "inventory_id", "tablet", "date"}) {
        if (table.has_column(name)) columns.session.push_back(table.column(name));
    }
    columns.pen = optional("pen");
    columns.tablet = optional("tablet");
    columns.driver = optional("driver");
    columns.os = optional("os");
    columns.date = optional("date");
    return columns;
}

double force_of(const files::Table& table, const Columns& columns) {
    const std::size_t column = columns.force_N ? *columns.force_N : *columns.force_gf;
    const double given = table.finite_number(column);
    if (!columns.force_N) return given * kN_per_gf;
    if (columns.force_gf) {
        const double gf = table.finite_number(*columns.force_gf);
        // within 1 % and half a unit of the last digit that scales show
        if (std::abs(gf * kN_per_gf - given) > 0.01 * std::abs(given) + 0.5 * kN_per_gf) {
            table.fail(*columns.force_gf, files::short_number(given / kN_per_gf) + " gf, as force_N in this line says");
        }
    }
    return given;
}

PressPhase phase_of(const files::Table& table, std::size_t column) {
    const auto text = table.field(column);
    if (text == "press" || text == "loading") return PressPhase::press;
    if (text != "release" && text != "unloading") table.fail(column, "press or release");
    return PressPhase::release;
}

// Keeps the field in `name` if all rows so far agree, else "several".
void agree(const files::Table& table, std::optional<std::size_t> column, std::string& name) {
    if (!column) return;
    const auto text = table.field(*column);
    if (name.empty()) name = text;
    if (name != text) name = "several";
}

// Throws InputError for forces below 0, but for what a zeroed sensor shows at rest: 1 % of its highest force, or five times
// its noise.
void check_zero(const CalibrationRows& rows) {
    const double highest_N = *std::max_element(rows.force_N.begin(), rows.force_N.end());
    const double noise = rows.time_s.size() < 40 ? 0.0 : noise_N(rows.force_N);  // told by forces in the order of time
    const double least_N = -std::max({0.01 * highest_N, 5.0 * noise, 0.0});
    for (std::size_t i = 0; i < rows.force_N.size(); ++i) {
        if (rows.force_N[i] >= least_N) continue;
        const bool gf = rows.force_column == "force_gf";
        const auto shown = [&](double force_N) { return files::short_number(gf ? force_N / kN_per_gf : force_N); };
        throw files::bad_input(rows.file, "line " + std::to_string(rows.line[i]) + ", " + rows.force_column,
                               "'" + shown(rows.force_N[i]) + "'",
                               "a force >= 0, or noise down to " + shown(least_N) + " (was the sensor zeroed?)");
    }
}

int index_of(std::map<std::string, int>& names, std::string name) {
    return names.emplace(std::move(name), static_cast<int>(names.size())).first->second;
}

// Numbers the repeats in the order of their numbers where all are numbers, else as they first come.
std::vector<int> numbered(const std::vector<std::string>& repeats) {
    std::map<std::string, int> names;
    std::map<double, int> numbers;
    std::vector<int> out;
    std::vector<double> number(repeats.size());
    for (std::size_t i = 0; i < repeats.size(); ++i) {
        out.push_back(index_of(names, repeats[i]));
        if (files::parse_number(repeats[i], number[i]) && std::isfinite(number[i])) numbers.emplace(number[i], 0);
    }
    if (numbers.size() != names.size()) return out;
    int next = 0;
    for (auto& [value, index] : numbers) index = next++;
    for (std::size_t i = 0; i < out.size(); ++i) out[i] = numbers.at(number[i]);
    return out;
}

}  // namespace

CalibrationRows read_points(const std::filesystem::path& file, const ReadOptions& options) {
    files::Table table = files::read_csv(file);
    const Columns columns = find_columns(table, options);
    CalibrationRows rows;
    rows.file = file.string();
    if (!columns.force_N) rows.force_column = "force_gf";
    std::vector<std::string> repeats;
    std::map<std::string, int> sessions;
    std::vector<int> session;
    while (table.next()) {
        bool wanted = true;
        for (std::size_t i = 0; i < columns.where.size(); ++i)
            wanted = wanted && table.field(columns.where[i]) == options.where[i].value;
        if (!wanted) continue;
        const double level = table.finite_number(columns.level);
        if (level < 0.0) table.fail(columns.level, "a level >= 0");
        rows.level.push_back(level);
        rows.force_N.push_back(force_of(table, columns));
        rows.line.push_back(table.line());
        if (columns.time_s) rows.time_s.push_back(table.finite_number(*columns.time_s));
        if (columns.repeat) repeats.emplace_back(table.field(*columns.repeat));
        if (columns.phase) rows.phase.push_back(phase_of(table, *columns.phase));
        std::string name;
        for (const std::size_t column : columns.session) name += std::string(table.field(column)) + "|";
        session.push_back(index_of(sessions, std::move(name)));
        agree(table, columns.pen, rows.device.pen);
        agree(table, columns.tablet, rows.device.tablet);
        agree(table, columns.driver, rows.device.driver);
        agree(table, columns.os, rows.device.os);
        agree(table, columns.date, rows.device.date);
    }
    rows.repeat = numbered(repeats);
    if (rows.level.empty() && !options.where.empty()) {
        std::string asked;
        for (const RowFilter& filter : options.where)
            asked += (asked.empty() ? "" : ", ") + filter.column + "=" + filter.value;
        throw files::bad_input(rows.file, "--where", "no row with " + asked, "a value that occurs in that column");
    }
    if (sessions.size() > 1) {
        rows.notes.push_back(std::to_string(sessions.size()) +
                             " sessions (pen, tablet, date) are taken together, as repeats: "
                             "choose one with --where, pens differ by half within one model");
        if (rows.repeat.empty()) rows.repeat = session;
    }
    if (rows.level.empty()) throw files::bad_input(rows.file, "", "no rows", "measured points");
    check_zero(rows);
    if (options.for_fit) check_rows(rows, options.any_force);
    return rows;
}

}  // namespace palpa::calibration
