// palpa maps import

#include <CLI/CLI.hpp>
#include <algorithm>
#include <cmath>
#include <cstdio>
#include <memory>

#include "app/commands/command_line.h"
#include "app/commands/map_info.h"
#include "app/commands/option_checks.h"
#include "files/input_error.h"
#include "files/progress_line.h"
#include "files/regular_file.h"
#include "files/text.h"
#include "stiffnessmaps/import/choices.h"
#include "stiffnessmaps/import/import.h"
#include "stiffnessmaps/map_file.h"

namespace palpa::app {
namespace {

struct ImportArguments {
    std::vector<std::string> files;
    std::string output;
    std::string form, grid, contact, tangential, tilt, quantity, indenter, length_unit, depth_unit, force_unit, axes;
    std::string depths, at_depths, spacing, origin, region;  // lists of mm
    std::vector<std::string> columns, tangential_x, tangential_y;
    std::optional<double> pitch_mm, radius_mm, contact_force_N, surface_z_mm, surface_node_mm, outliers, scale, missing;
    std::optional<int> layers;
    double indenter_radius_mm = 3.0;
    double cylinder_length_mm = 20.0;
    double poisson = 0.5;
    double offset = 0.0;
    bool negate_force = false;
    bool no_fill = false;
    std::string name, licence, dataset;
    bool explain = false;
    bool json = false;
};

// Reads "2,3.5,5" (mm) as metres: `count` numbers, any number of them if it is 0.
std::vector<double> lengths_m(const std::string& text, const char* option, std::size_t count) {
    std::vector<double> out;
    std::string_view rest = text;
    while (!text.empty()) {
        const auto end = rest.find(',');
        double value = 0.0;
        if (!files::parse_number(rest.substr(0, end), value) || !(std::abs(value) <= 1e6)) {
            throw files::bad_input(option, "", files::shown(text),
                                   "numbers of mm, at most 1e6 each, with commas between them");
        }
        out.push_back(1e-3 * value);
        if (end == std::string_view::npos) break;
        rest.remove_prefix(end + 1);
    }
    if (count > 0 && !out.empty() && out.size() != count) {
        throw files::bad_input(option, "", std::to_string(out.size()) + " numbers", std::to_string(count));
    }
    return out;
}

std::vector<double> depths_m(const std::string& text, const char* option, bool ascending) {
    std::vector<double> out = lengths_m(text, option, 0);
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (!(out[i] > 0.0)) throw files::bad_input(option, "", files::short_number(1e3 * out[i]), "depths > 0");
        if (ascending && i > 0 && !(out[i] > out[i - 1])) {
            throw files::bad_input(
                option, "", files::short_number(1e3 * out[i]) + " after " + files::short_number(1e3 * out[i - 1]),
                "ascending depths");
        }
    }
    return out;
}

// Returns the index of `text` in `names`, or nothing for an empty text or "auto". CLI11 has checked the other texts.
template <class Enum>
std::optional<Enum> choice(const std::string& text, std::initializer_list<const char*> names) {
    int i = 0;
    for (const char* name : names) {
        if (text == name) return static_cast<Enum>(i);
        ++i;
    }
    return std::nullopt;
}

std::optional<double> metres(const std::optional<double>& mm) {
    return mm ? std::optional<double>(1e-3 * *mm) : std::nullopt;
}

void set_array_options(const ImportArguments& a, stiffnessmaps::ImportOptions& options) {
    const std::vector<double> spacing = a.spacing.find(',') == std::string::npos
                                            ? lengths_m(a.spacing, "--spacing-mm", 1)
                                            : lengths_m(a.spacing, "--spacing-mm", 2);
    if (!spacing.empty()) options.spacing_m = {spacing.front(), spacing.back()};
    if (!spacing.empty() && !(spacing.front() > 0.0 && spacing.back() > 0.0))
        throw files::bad_input("--spacing-mm", "", files::shown(a.spacing), "distances > 0");
    const std::vector<double> origin = lengths_m(a.origin, "--origin-mm", 2);
    if (!origin.empty()) options.origin_m = {origin[0], origin[1]};
    options.quantity = choice<stiffnessmaps::Quantity>(a.quantity, {"force", "stiffness", "young"})
                           .value_or(stiffnessmaps::Quantity::force);
    options.scale_stated = a.scale.has_value();
    options.scale =
        a.scale.value_or(1.0) * (options.quantity == stiffnessmaps::Quantity::force ? 1.0 : 1e3);  // N/mm and kPa
    options.offset = a.offset;
    options.missing = a.missing;
    options.poisson = a.poisson;
    if (!a.axes.empty()) options.axes = a.axes;
    options.dataset = a.dataset;
    options.tangential_x.assign(a.tangential_x.begin(), a.tangential_x.end());
    options.tangential_y.assign(a.tangential_y.begin(), a.tangential_y.end());
}

stiffnessmaps::ImportOptions options_of(const ImportArguments& a) {
    stiffnessmaps::ImportOptions options;
    options.form = choice<stiffnessmaps::RecordingForm>(a.form, {"probing", "sliding", "matrices"});
    options.name = a.name;
    options.licence = a.licence;
    options.indenter = choice<stiffnessmaps::IndenterShape>(a.indenter, {"sphere", "cylinder"})
                           .value_or(stiffnessmaps::IndenterShape::sphere);
    options.indenter_radius_m = 1e-3 * a.indenter_radius_mm;
    options.cylinder_length_m = 1e-3 * a.cylinder_length_mm;
    for (const std::string& column : a.columns) {
        const auto equals = column.find('=');
        if (equals == std::string::npos)
            throw files::bad_input("--column", "", files::shown(column), "ROLE=NAME, such as x=pos_x_mm");
        if (!options.columns.emplace(column.substr(0, equals), column.substr(equals + 1)).second) {
            throw files::bad_input("--column", "", files::shown(column.substr(0, equals)) + " twice", "it once");
        }
    }
    options.length_unit = choice<stiffnessmaps::LengthUnit>(a.length_unit, {"mm", "m", "um"});
    options.depth_unit = choice<stiffnessmaps::LengthUnit>(a.depth_unit, {"mm", "m", "um"});
    options.force_unit = choice<stiffnessmaps::ForceUnit>(a.force_unit, {"N", "mN"});
    options.negate_force = a.negate_force;
    const std::vector<double> region = lengths_m(a.region, "--region-mm", 4);
    if (!region.empty()) options.region_m = {region[0], region[1], region[2], region[3]};
    options.remove_tilt = a.tilt != "keep";
    options.outliers = a.outliers;
    options.gridding = choice<stiffnessmaps::Gridding>(a.grid, {"on-grid", "plane", "inverse-distance", "median"});
    options.pitch_m = metres(a.pitch_mm);
    options.radius_m = metres(a.radius_mm);
    options.at_depths_m = depths_m(a.at_depths, "--at-depth-mm", false);
    options.layers = a.layers;
    options.fill = !a.no_fill;
    options.tangential = choice<stiffnessmaps::TangentialChoice>(a.tangential, {"measured", "energy", "none"});
    options.contact = choice<stiffnessmaps::ContactStart>(a.contact, {"first-row", "threshold", "given"});
    options.contact_force_N = a.contact_force_N;
    options.surface_z_m = metres(a.surface_z_mm);
    options.surface_node_m = metres(a.surface_node_mm);
    set_array_options(a, options);
    return options;
}

std::string value_text(const stiffnessmaps::SourceChoice& choice) {
    if (const auto* text = std::get_if<std::string>(&choice.value)) return *text;
    if (const auto* number = std::get_if<double>(&choice.value)) return files::short_number(*number);
    std::string out;
    for (const double value : std::get<std::vector<double>>(choice.value))
        out += (out.empty() ? "" : ", ") + files::short_number(value);
    return out;
}

void print_choices(const stiffnessmaps::Map& map) {
    std::printf("what was chosen, why, and what chooses otherwise:\n");
    for (const stiffnessmaps::SourceChoice& choice : map.source.choices) {
        std::printf("  %-22s %s\n%25s%s%s%s\n", choice.key.c_str(), value_text(choice).c_str(), "", choice.how.c_str(),
                    choice.option.empty() ? "" : "; ", choice.option.c_str());
    }
}

files::Json tangential_json(const std::optional<stiffnessmaps::ImportResidual>& residual) {
    if (!residual) return nullptr;
    return {{"points", residual->n},
            {"median_N", residual->median_N},
            {"worst_N", residual->worst_N},
            {"greatest_force_N", residual->greatest_N},
            {"median_share", residual->median_share()},
            {"worst_share", residual->worst_share()},
            {"worst_at_mm", {1e3 * residual->worst_x_m, 1e3 * residual->worst_y_m, 1e3 * residual->worst_depth_m}}};
}

files::Json import_json(const stiffnessmaps::ImportReport& report) {
    const stiffnessmaps::ImportResidual& residual = report.residual;
    return {
        {"form", name_of(report.form)},
        {"rows", report.rows},
        {"points", report.points},
        {"rejected_rows", report.rejected_rows},
        {"outliers", report.outliers},
        {"rejected_points", report.rejected_points},
        {"missing_cells", report.missing_cells},
        {"median_offset_N", report.median_offset_N},
        {"residual_points", residual.n},
        {"median_residual_N", residual.median_N},
        {"worst_residual_N", residual.worst_N},
        {"greatest_force_N", residual.greatest_N},
        {"median_residual_share", residual.median_share()},
        {"worst_residual_share", residual.worst_share()},
        {"worst_residual_at_mm", {1e3 * residual.worst_x_m, 1e3 * residual.worst_y_m, 1e3 * residual.worst_depth_m}},
        {"tangential_residual", tangential_json(report.tangential)},
        {"notes", report.notes}};
}

// Micrometres are not lost where a map is small.
std::string shown_mm(double value_m) {
    char text[32];
    std::snprintf(text, sizeof text, 1e3 * value_m < 0.1 ? "%.2g" : "%.2f", 1e3 * value_m);
    return text;
}

void print_report(const std::string& name, const stiffnessmaps::Map& map, const stiffnessmaps::ImportReport& report) {
    const stiffnessmaps::ImportResidual& residual = report.residual;
    const char* unit = report.form == stiffnessmaps::RecordingForm::probing   ? "points"
                       : report.form == stiffnessmaps::RecordingForm::sliding ? "samples"
                                                                              : "numbers";
    std::printf("%s: %zu %s become %zu x %zu cells of %s x %s mm, %zu depths to %s mm\n", name.c_str(), report.points,
                unit, map.n_x, map.n_y, shown_mm(map.spacing_m[0]).c_str(), shown_mm(map.spacing_m[1]).c_str(),
                map.n_depths(), shown_mm(map.depths_m.back()).c_str());
    std::printf("  %zu cells missing; %zu of %zu rows and %zu points rejected (%zu outliers)", report.missing_cells,
                report.rejected_rows, report.rows, report.rejected_points, report.outliers);
    if (report.form == stiffnessmaps::RecordingForm::probing)
        std::printf("; %.3g N at contact, or in the air before it, subtracted (median)", report.median_offset_N);
    std::printf(
        "\n  map against recording: %.2g N median, %.2g N worst, of %.3g N (%.2g %%, %.2g %%); noise %s\n",
        residual.median_N, residual.worst_N, residual.greatest_N, 100.0 * residual.median_share(),
        100.0 * residual.worst_share(),
        map.noise_N ? ("about " + files::short_number(*map.noise_N) + " N").c_str() : "not known (too few neighbours)");
    if (!report.tangential) return;
    const stiffnessmaps::ImportResidual& tangential = *report.tangential;
    std::printf("  tangential force against recording: %.2g N median, %.2g N worst, of %.3g N (%.2g %%, %.2g %%)\n",
                tangential.median_N, tangential.worst_N, tangential.greatest_N, 100.0 * tangential.median_share(),
                100.0 * tangential.worst_share());
}

constexpr const char* kTableOptions = "Tables";
constexpr const char* kSlidingOptions = "Tables of sliding";
constexpr const char* kArrayOptions = "Arrays";

// An option that changes nothing for this form of recording was meant for another one.
void check_used(const CLI::App& command, stiffnessmaps::RecordingForm form) {
    const bool arrays = form == stiffnessmaps::RecordingForm::matrices;
    for (const CLI::Option* option : command.get_options()) {
        const std::string& group = option->get_group();
        const bool used = group == kArrayOptions     ? arrays
                          : group == kTableOptions   ? !arrays
                          : group == kSlidingOptions ? form == stiffnessmaps::RecordingForm::sliding
                                                     : true;
        if (option->count() == 0 || used) continue;
        throw files::bad_input(option->get_name(), "", std::string("a recording of the form ") + name_of(form),
                               group == kArrayOptions   ? "arrays, for which this option is"
                               : group == kTableOptions ? "a table, for which this option is"
                                                        : "a table of sliding, for which this option is");
    }
}

// What the recording, or another option, decides leaves no room for an option that says otherwise.
void check_chosen(const CLI::App& command, const stiffnessmaps::Map& map) {
    for (const char* option : {"--layers", "--pitch-mm", "--radius-mm", "--contact", "--contact-force-N",
                               "--surface-z-mm", "--surface-node-mm", "--at-depth-mm"}) {
        if (command.count(option) == 0) continue;
        const auto by_it = [&](const stiffnessmaps::SourceChoice& choice) {
            return choice.option.find(option) != std::string::npos && choice.how == stiffnessmaps::kAsAskedFor;
        };
        if (std::any_of(map.source.choices.begin(), map.source.choices.end(), by_it)) continue;
        throw files::bad_input(option, "", "a recording, or other options, that leave nothing for this one to choose",
                               "another combination (--explain without it shows what was chosen, and why)");
    }
}

void import_map(const CLI::App& command, const ImportArguments& a) {
    stiffnessmaps::ImportOptions options = options_of(a);
    options.depths_m = depths_m(a.depths, "--depths-mm", false);
    if (a.output.empty() && !a.explain)
        throw files::bad_input("maps import", "", "no output",
                               "-o NAME.map (or --explain, to see what would be chosen)");
    if (!a.output.empty()) files::check_new(a.output);
    for (const char* name : {"--poisson", "--cylinder-length-mm"})
        refuse_unused(command, name, options.quantity == stiffnessmaps::Quantity::young, "--quantity young");
    stiffnessmaps::ImportReport report;
    std::optional<files::ProgressLine> line(std::in_place);
    options.progress = [&line](const char* what, double done) { line->show(what, done > 0.0 ? done : std::nan("")); };
    const stiffnessmaps::Map map = stiffnessmaps::import_recording({a.files.begin(), a.files.end()}, options, report);
    line.reset();
    check_used(command, report.form);
    check_chosen(command, map);
    if (!a.output.empty()) stiffnessmaps::write_map(map, a.output);
    for (const std::string& note : report.notes) std::fprintf(stderr, "palpa: %s\n", note.c_str());
    if (a.json) {
        files::Json json = map_info(map, stiffnessmaps::make_field(map, {}));
        json["import"] = import_json(report);
        std::fputs(files::json_text(json).c_str(), stdout);
        return;
    }
    print_report(a.output.empty() ? map.name : a.output, map, report);
    if (a.explain) print_choices(map);
}

void add_table_options(CLI::App& command, ImportArguments& a) {
    const auto number = [&](const char* name, std::optional<double>& value, const char* help, double lowest,
                            double highest) {
        command.add_option(name, value, help)->check(CLI::Range(lowest, highest))->group(kTableOptions);
    };
    const auto text = [&](const char* name, std::string& value, const char* help) {
        return command.add_option(name, value, help)->group(kTableOptions);
    };
    command
        .add_option("--column", a.columns,
                    "ROLE=NAME, as often as needed; roles: t, point, x, y, z, depth, depth_cmd, fn, fx, fy, "
                    "fz, n_x, n_y, n_z")
        ->allow_extra_args(false)
        ->group(kTableOptions);
    text("--region-mm", a.region, "X0,X1,Y0,Y1: import only the places in this region");
    text("--tilt", a.tilt, "tilt of the surface: remove (default) or keep")->check(one_of({"remove", "keep"}));
    number("--outliers", a.outliers,
           "leave out forces that are off by more than this many robust standard deviations (default 20; 0: keep all)",
           0.0, 1e6);
    text("--grid", a.grid, "method that brings the places onto the grid: on-grid, plane, inverse-distance or median")
        ->check(one_of({"on-grid", "plane", "inverse-distance", "median"}));
    number("--pitch-mm", a.pitch_mm, "pitch of the map where the places do not lie on a grid", 0.01, 1000.0);
    number("--radius-mm", a.radius_mm, "radius around a cell from which it then takes samples", 0.01, 1000.0);
    command.add_option("--layers", a.layers, "number of depths of the map")
        ->check(CLI::Range(1, 200))
        ->group(kTableOptions);
    text("--contact", a.contact, "start of contact: first-row, threshold, or given (depths count from the surface)")
        ->check(one_of({"first-row", "threshold", "given"}));
    number("--contact-force-N", a.contact_force_N, "force, less that in the air, above which a place touches for sure",
           0.0, 100.0);
    const auto sliding = [](CLI::Option* option) { option->group(kSlidingOptions); };
    sliding(
        command
            .add_option("--surface-z-mm", a.surface_z_mm, "height of a flat surface, used instead of an estimated one")
            ->check(CLI::Range(-1e5, 1e5)));
    sliding(command.add_option("--surface-node-mm", a.surface_node_mm, "spacing of the nodes of the estimated surface")
                ->check(CLI::Range(0.1, 1000.0)));
    sliding(command.add_option("--at-depth-mm", a.at_depths, "sliding at constant depth: the depth of each file"));
}

void add_array_options(CLI::App& command, ImportArguments& a) {
    const auto text = [&](const char* name, std::string& value, const char* help) {
        return command.add_option(name, value, help)->group(kArrayOptions);
    };
    text("--spacing-mm", a.spacing, "DX,DY: distance between neighbouring numbers");
    text("--origin-mm", a.origin, "X,Y: place of the first number (default 0,0)");
    text("--quantity", a.quantity, "quantity of the numbers: force (N, default), stiffness (N/mm) or young (kPa)")
        ->check(one_of({"force", "stiffness", "young"}));
    command.add_option("--scale", a.scale, "value in N, N/mm or kPa of one unit of the file; required for images")
        ->group(kArrayOptions);
    command.add_option("--offset", a.offset, "number that is subtracted from the file's numbers before scaling")
        ->group(kArrayOptions);
    command.add_option("--missing", a.missing, "number that stands for not measured")->group(kArrayOptions);
    text("--axes", a.axes, "order of three-dimensional arrays (default dyx: depth, y, x)")
        ->check(one_of({"dyx", "dxy", "ydx", "yxd", "xdy", "xyd"}));
    text("--dataset", a.dataset, "name of the array in a MATLAB or HDF5 file that holds several");
    command
        .add_option("--tangential-x", a.tangential_x,
                    "files of the force that opposes motion along +x (default: by their names)")
        ->group(kArrayOptions);
    command
        .add_option("--tangential-y", a.tangential_y,
                    "files of the force that opposes motion along +y (default: by their names)")
        ->group(kArrayOptions);
    command.add_option("--poisson", a.poisson, "Poisson's ratio of the tissue, for Young's moduli (default 0.5)")
        ->check(CLI::Range(0.0, 0.5))
        ->group(kArrayOptions);
    command
        .add_option("--cylinder-length-mm", a.cylinder_length_mm,
                    "length of the cylinder, for Young's moduli (default 20)")
        ->check(CLI::Range(0.1, 1e4))
        ->group(kArrayOptions);
}

}  // namespace

void add_maps_import(CLI::App& maps) {
    auto a = std::make_shared<ImportArguments>();
    CLI::App* command = maps.add_subcommand(
        "import", "Turn a recording into a map: probing, sliding, matrices of force, slices of stiffness");
    command
        ->add_option("FILE", a->files,
                     "a table with a header line (probing, sliding), or arrays: .npy, text, MATLAB, HDF5, PNG, TIFF")
        ->required();
    command->add_option("-o,--output", a->output, "new map folder NAME.map");
    command
        ->add_option("--form", a->form,
                     "form of the recording: probing, sliding or matrices (default: recognised from the file)")
        ->check(one_of({"probing", "sliding", "matrices"}));
    command->add_option("--depths-mm", a->depths,
                        "D1,D2,...: the map's depths; for matrices, the depth of each matrix in the files' order");
    command
        ->add_option("--tangential", a->tangential,
                     "tangential force: measured, energy (derived from the normal force) or none")
        ->check(one_of({"measured", "energy", "none"}));
    command->add_flag("--no-fill", a->no_fill, "do not write filled_normal_N.npy beside the raw forces");
    command->add_option("--indenter", a->indenter, "shape of the tool's tip: sphere (default) or cylinder")
        ->check(one_of({"sphere", "cylinder"}));
    command
        ->add_option("--indenter-radius-mm", a->indenter_radius_mm,
                     "radius of the tool's tip (default 3, an assumption, since recordings do not state it)")
        ->check(CLI::Range(1e-3, 1e3));
    command->add_option("--name", a->name, "name of the map (default: the file's name)");
    command
        ->add_option(
            "--force-unit", a->force_unit,
            "unit of forces: N or mN (default: from the column's name, else N); also takes forces outside 0.01 "
            "to 200 N")
        ->check(one_of({"N", "mN"}));
    command
        ->add_option("--length-unit", a->length_unit,
                     "unit of x, y, z: mm, m or um (default: from the column's name, else mm); also takes places that "
                     "cover less than 1 mm or more than 1 m (arrays: mm)")
        ->check(one_of({"mm", "m", "um"}));
    command
        ->add_option(
            "--depth-unit", a->depth_unit,
            "unit of depths: mm, m or um (default: from the column's name, else mm); also takes depths outside 0.05 to "
            "100 mm (arrays: mm)")
        ->check(one_of({"mm", "m", "um"}));
    command->add_flag("--negate-force", a->negate_force, "reverse the sign of the forces");
    command->add_option("--licence", a->licence, "licence of the recording, stored in the map's source");
    add_table_options(*command, *a);
    add_array_options(*command, *a);
    command->add_flag("--explain", a->explain, "also print each choice, its reason and the option that overrides it");
    command->add_flag("--json", a->json,
                      "print one JSON object: the keys of `maps info`, and `import` with the import's figures");
    command->callback([a, command] { import_map(*command, *a); });
}

}  // namespace palpa::app
