#include "devices/press_file.h"

#include <algorithm>
#include <cassert>
#include <cmath>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"

namespace palpa::devices {
namespace {

constexpr double kPress_mm = 1e-3;
constexpr double kLongest_s = 86'400.0;
constexpr const char* kPressColumns = "columns t_s, x_mm, y_mm and one of depth_mm, force_N";

void check_columns(const files::Table& table) {
    for (const std::string& name : table.columns()) {
        const bool known = name == "t_s" || name == "x_mm" || name == "y_mm" || name == "depth_mm" || name == "force_N";
        if (!known) throw files::bad_input(table.file(), "line 1", files::shown(name), kPressColumns);
    }
    const bool depth = table.has_column("depth_mm");
    const bool force = table.has_column("force_N");
    if (depth && force) throw files::bad_input(table.file(), "line 1", "both depth_mm and force_N", kPressColumns);
    if (!depth && !force) throw files::bad_input(table.file(), "line 1", "neither depth_mm nor force_N", kPressColumns);
}

std::vector<PressRow> rows_of(files::Table& table) {
    check_columns(table);
    const std::size_t t = table.column("t_s"), x = table.column("x_mm"), y = table.column("y_mm");
    const bool depth = table.has_column("depth_mm");
    const std::size_t pressed = table.column(depth ? "depth_mm" : "force_N");
    std::vector<PressRow> rows;
    while (table.next()) {
        PressRow row;
        row.t_s = table.finite_number(t);
        if (std::abs(row.t_s) > kLongest_s)
            table.fail(t, "a time within " + files::short_number(kLongest_s) + " s, a day");
        if (!rows.empty() && row.t_s <= rows.back().t_s)
            table.fail(t, "a time after that of the row above, " + files::number_text(rows.back().t_s));
        row.x_m = kPress_mm * table.finite_number(x);
        row.y_m = kPress_mm * table.finite_number(y);
        (depth ? row.depth_m : row.force_N) = (depth ? kPress_mm : 1.0) * table.finite_number(pressed);
        rows.push_back(row);
    }
    if (rows.empty()) throw files::bad_input(table.file(), "", "no rows", "at least one row under the header");
    return rows;
}

}  // namespace

std::vector<PressRow> read_press(const std::filesystem::path& tsv) {
    files::Table table = files::read_tsv(tsv);
    return rows_of(table);
}

std::vector<PressRow> parse_press(std::string text, const std::string& file_name) {
    files::Table table(std::move(text), file_name, '\t');
    return rows_of(table);
}

void write_press(const std::vector<PressRow>& rows, const std::filesystem::path& tsv) {
    const bool depth = rows.empty() || std::isfinite(rows.front().depth_m);
    std::string text = std::string("t_s\tx_mm\ty_mm\t") + (depth ? "depth_mm" : "force_N") + "\n";
    for (const PressRow& row : rows) {
        for (const double value : {row.t_s, row.x_m / kPress_mm, row.y_m / kPress_mm}) {
            files::append_number(value, text);
            text.push_back('\t');
        }
        files::append_number(depth ? row.depth_m / kPress_mm : row.force_N, text);
        text.push_back('\n');
    }
    files::write_text_whole(tsv, text);
}

PressRow press_at(const std::vector<PressRow>& rows, double t_s, std::size_t& at) noexcept {
    assert(!rows.empty());
    if (at >= rows.size() || t_s < rows[at].t_s) at = 0;
    while (at + 1 < rows.size() && rows[at + 1].t_s <= t_s) ++at;
    PressRow row = rows[at];
    row.t_s = t_s;
    if (at + 1 == rows.size() || t_s <= rows[at].t_s) return row;
    const PressRow& next = rows[at + 1];
    const double share = (t_s - rows[at].t_s) / (next.t_s - rows[at].t_s);
    row.x_m += share * (next.x_m - row.x_m);
    row.y_m += share * (next.y_m - row.y_m);
    row.depth_m += share * (next.depth_m - row.depth_m);
    row.force_N += share * (next.force_N - row.force_N);
    return row;
}

}  // namespace palpa::devices
