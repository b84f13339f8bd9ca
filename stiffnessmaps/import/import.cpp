#include "stiffnessmaps/import/import.h"

#include <algorithm>
#include <cmath>
#include <functional>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "stiffnessmaps/import/arrays.h"
#include "stiffnessmaps/import/choices.h"
#include "stiffnessmaps/import/columns.h"
#include "stiffnessmaps/import/matrices.h"
#include "stiffnessmaps/import/probing.h"
#include "stiffnessmaps/import/sliding.h"

namespace palpa::stiffnessmaps {
namespace {

namespace fs = std::filesystem;

files::Table open_table(const fs::path& path, ImportReport& report) {
    std::string text = files::read_text(path);
    if (!text.empty() && text.back() != '\n')
        report.notes.push_back(path.string() + ": its last line has no end: is the file whole?");
    const char separator = separator_of(std::string_view(text).substr(0, text.find('\n')));
    return files::Table(std::move(text), path.string(), separator);
}

void note_columns(const Columns& columns, const ImportOptions& options, MapSource& source) {
    std::string used;
    for (std::size_t r = 0; r < kRoles; ++r) {
        const auto role = static_cast<Role>(r);
        if (!columns.has(role)) continue;
        const Column& column = columns[role];
        used += (used.empty() ? "" : ", ") + std::string(name_of(role)) + "=" + column.name +
                (column.unit.empty() ? "" : " in " + column.unit);
    }
    add_choice(source, "columns", used, "usual names, with the units that they name; else mm, N and s",
               "--column, --length-unit, --depth-unit, --force-unit", !options.columns.empty());
}

Map import_tables(const std::vector<fs::path>& files, const ImportOptions& options, ImportReport& report) {
    if (!options.at_depths_m.empty() && options.at_depths_m.size() != files.size()) {
        throw files::bad_input(
            "--at-depth-mm", "",
            std::to_string(options.at_depths_m.size()) + " depths for " + std::to_string(files.size()) + " files",
            "one for each file");
    }
    if (!std::is_sorted(options.depths_m.begin(), options.depths_m.end(), std::less_equal<>())) {
        throw files::bad_input("--depths-mm", "", "depths out of order", "ascending depths");
    }
    Map map;
    MapSource before;  // choices made before the map exists
    Probing probing;
    Sliding sliding;
    const std::string all = files.size() == 1
                                ? files[0].string()
                                : files[0].string() + " and " + std::to_string(files.size() - 1) + " more";
    for (std::size_t i = 0; i < files.size(); ++i) {
        files::Table table = open_table(files[i], report);
        const Columns columns = find_columns(table, options);
        report.form = options.form.value_or(form_of(columns, table));
        if (options.depth_unit && !columns.has(Role::depth) && !columns.has(Role::commanded_depth))
            throw files::bad_input("--depth-unit", "", files[i].string() + ", which has no column of depths",
                                   "one, or --length-unit for heights");
        if (i == 0) {
            add_choice(before, "form", name_of(report.form), "the columns that the file has", "--form",
                       options.form.has_value());
            note_columns(columns, options, before);
        }
        if (report.form == RecordingForm::sliding) {
            read_sliding(table, columns, options, options.at_depths_m.empty() ? 0.0 : options.at_depths_m[i], sliding,
                         report);
        } else if (i == 0) {
            probing = read_probing(table, columns, options, report);
        } else {
            throw files::bad_input(files[i].string(), "", "a second file of probing",
                                   "one table (or --form sliding, --form matrices)");
        }
    }
    map = report.form == RecordingForm::sliding ? map_of_sliding(sliding, options, all, report)
                                                : map_of_probing(probing, options, all, report);
    map.source.choices.insert(map.source.choices.begin(), before.choices.begin(), before.choices.end());
    return map;
}

}  // namespace

Map import_recording(const std::vector<fs::path>& files, const ImportOptions& options, ImportReport& report) {
    if (files.empty()) throw files::bad_input("maps import", "", "no file", "one or more");
    const bool arrays = options.form ? *options.form == RecordingForm::matrices : is_array_file(files.front());
    Map map = arrays ? import_matrices(files, options, report) : import_tables(files, options, report);
    map.nodules_known = false;  // a recording does not say
    map.name = options.name.empty() ? files.front().stem().string() : options.name;
    map.source.from = files.front().filename().string();
    for (std::size_t i = 1; i < files.size(); ++i) map.source.from += ", " + files[i].filename().string();
    map.source.licence = options.licence.empty() ? "that of the recording" : options.licence;
    return map;
}

const char* name_of(RecordingForm form) {
    switch (form) {
        case RecordingForm::probing:
            return "probing";
        case RecordingForm::sliding:
            return "sliding";
        case RecordingForm::matrices:
            return "matrices";
    }
    return "probing";
}

const char* name_of(Gridding gridding) {
    switch (gridding) {
        case Gridding::on_grid:
            return "on-grid";
        case Gridding::plane:
            return "plane";
        case Gridding::inverse_distance:
            return "inverse-distance";
        case Gridding::median:
            return "median";
    }
    return "plane";
}

const char* name_of(TangentialChoice choice) {
    switch (choice) {
        case TangentialChoice::measured:
            return "measured";
        case TangentialChoice::energy:
            return "energy";
        case TangentialChoice::none:
            return "none";
    }
    return "none";
}

}  // namespace palpa::stiffnessmaps
