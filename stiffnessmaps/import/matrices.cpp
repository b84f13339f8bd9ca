#include "stiffnessmaps/import/matrices.h"

#include <algorithm>
#include <cctype>
#include <cmath>
#include <functional>
#include <limits>
#include <numbers>

#include "files/input_error.h"
#include "files/text.h"
#include "stiffnessmaps/import/arrays.h"
#include "stiffnessmaps/import/choices.h"
#include "stiffnessmaps/import/columns.h"
#include "stiffnessmaps/import/finish.h"
#include "stiffnessmaps/import/robust.h"

namespace palpa::stiffnessmaps {
namespace {

namespace fs = std::filesystem;

// The matrices of one quantity, one layer per depth.
struct Stack {
    std::vector<double> depths_m;  // empty: not yet known
    std::size_t n_y = 0;
    std::size_t n_x = 0;
    std::vector<float> values;  // [layer][y][x]
    std::string first_file;
    std::size_t n_layers() const { return values.size() / (n_x * n_y); }
};

std::string lower(std::string text) {
    for (char& c : text) c = static_cast<char>(std::tolower(static_cast<unsigned char>(c)));
    return text;
}

bool says_tangential(const fs::path& path) {
    const std::string name = lower(path.stem().string());
    return name.find("tangential") != std::string::npos || name.find("shear") != std::string::npos ||
           name.substr(0, 3) == "ft_" || name.find("_ft") != std::string::npos;
}

bool says_along_y(const fs::path& path) {
    return lower(path.stem().string()).find("tangential_y") != std::string::npos;
}

// Returns the last number in the name that "mm" follows, as metres: "normal_3.5mm" -> 3.5e-3.
std::optional<double> depth_in_name(const fs::path& path) {
    const std::string name = path.stem().string();
    for (std::size_t unit = name.rfind("mm"); unit != std::string::npos && unit > 0;
         unit = name.rfind("mm", unit - 1)) {
        std::size_t end = unit;
        while (end > 0 && (name[end - 1] == ' ' || name[end - 1] == '_')) --end;
        std::size_t begin = end;
        while (begin > 0 && (std::isdigit(static_cast<unsigned char>(name[begin - 1])) != 0 || name[begin - 1] == '.'))
            --begin;
        // "2,5mm" and "2p5mm" are no 5 mm
        const bool cut = begin > 1 && (name[begin - 1] == ',' || name[begin - 1] == 'p') &&
                         std::isdigit(static_cast<unsigned char>(name[begin - 2])) != 0;
        if (cut) return std::nullopt;
        double value = 0.0;
        if (begin < end && files::parse_number(std::string_view(name).substr(begin, end - begin), value) && value > 0.0)
            return 1e-3 * value;
    }
    return std::nullopt;
}

// Reorders a three-dimensional array to [depth][y][x].
void put_in_order(files::NpyArray& array, const std::string& axes) {
    if (axes == "dyx") return;
    const std::size_t d = axes.find('d');
    const std::size_t y = axes.find('y');
    const std::size_t x = axes.find('x');
    const std::array<std::size_t, 3> stride{array.shape[1] * array.shape[2], array.shape[2], 1};
    files::NpyArray out;
    out.shape = {array.shape[d], array.shape[y], array.shape[x]};
    out.values.reserve(array.values.size());
    for (std::size_t k = 0; k < out.shape[0]; ++k) {
        for (std::size_t j = 0; j < out.shape[1]; ++j) {
            for (std::size_t i = 0; i < out.shape[2]; ++i)
                out.values.push_back(array.values[k * stride[d] + j * stride[y] + i * stride[x]]);
        }
    }
    array = std::move(out);
}

void check_count(std::size_t n, const std::string& file) {
    if (n > kMostNumbers)
        throw files::bad_input(file, "", "more than 20 million numbers with all files and depths", "less");
}

void append(const fs::path& path, const ImportOptions& options, Stack& stack) {
    files::NpyArray array = read_array(path, options.dataset);
    if (is_image(*array_kind(path)) && !options.scale_stated) {
        throw files::bad_input(
            path.string(), "", "an image of counts without a unit",
            "what one count is: --scale, with --quantity force (N), stiffness (N/mm) or young (kPa)");
    }
    if (array.shape.size() == 3)
        put_in_order(array, options.axes);
    else if (options.axes != ImportOptions{}.axes)
        throw files::bad_input("--axes", "", options.axes + " for " + path.string() + ", which has two dimensions",
                               "an array of three");
    const std::size_t n_y = array.shape[array.shape.size() - 2];
    const std::size_t n_x = array.shape.back();
    if (stack.values.empty()) {
        stack.n_y = n_y;
        stack.n_x = n_x;
        stack.first_file = path.string();
    }
    if (n_y != stack.n_y || n_x != stack.n_x) {
        throw files::bad_input(
            path.string(), "shape", files::shape_text({n_y, n_x}),
            files::shape_text({stack.n_y, stack.n_x}) + " as in " + stack.first_file + " (two grids?)");
    }
    check_count(stack.values.size() + array.values.size(), path.string());
    if (stack.values.empty()) {
        stack.values = std::move(array.values);
    } else {
        stack.values.insert(stack.values.end(), array.values.begin(), array.values.end());
    }
}

std::vector<double> depths_of(const std::vector<fs::path>& files, const Stack& stack, const ImportOptions& options,
                              bool& from_names) {
    const std::size_t n = stack.n_layers();
    from_names = false;
    if (!options.depths_m.empty()) {
        if (options.depths_m.size() == n) return options.depths_m;
        throw files::bad_input(stack.first_file, "", std::to_string(n) + " matrices",
                               std::to_string(options.depths_m.size()) +
                                   ", one for each depth of --depths-mm (another order of axes: --axes)");
    }
    std::vector<double> depths_m;
    for (const fs::path& file : files) {
        if (const auto depth_m = depth_in_name(file)) depths_m.push_back(*depth_m);
    }
    from_names = true;
    if (depths_m.size() == n && files.size() == n) return depths_m;
    throw files::bad_input(stack.first_file, "",
                           std::to_string(n) + " matrices in " + std::to_string(files.size()) +
                               " files, with a depth in " + std::to_string(depths_m.size()) + " of their names",
                           "the depth of each: --depths-mm, or names such as normal_3mm.csv and normal_2.5mm.csv");
}

// Sorts the layers by ascending depth. Throws InputError if two have the same depth.
void sort_layers(Stack& stack) {
    const auto n = static_cast<std::ptrdiff_t>(stack.n_x * stack.n_y);
    // selection sort moves each layer once, in place
    for (std::size_t k = 0; k + 1 < stack.depths_m.size(); ++k) {
        const auto from = stack.depths_m.begin() + static_cast<std::ptrdiff_t>(k);
        const auto least = std::min_element(from, stack.depths_m.end());
        if (least == from) continue;
        std::swap(*from, *least);
        const auto first = stack.values.begin() + static_cast<std::ptrdiff_t>(k) * n;
        std::swap_ranges(first, first + n, stack.values.begin() + (least - stack.depths_m.begin()) * n);
    }
    const auto twice = std::adjacent_find(stack.depths_m.begin(), stack.depths_m.end(), std::greater_equal<>());
    if (twice == stack.depths_m.end()) return;
    throw files::bad_input(stack.first_file, "", "the depth " + files::short_number(1e3 * *twice) + " mm twice",
                           "each once");
}

// Converts the numbers to SI units of the quantity; NaN = not measured. Returns how many numbers were `options.missing`.
std::size_t scale(Stack& stack, const ImportOptions& options) {
    const double factor = options.scale * (options.negate_force ? -1.0 : 1.0) *
                          (options.quantity == Quantity::force && options.force_unit == ForceUnit::mN ? 1e-3 : 1.0);
    std::size_t n_missing = 0;
    for (float& value : stack.values) {
        if (std::isnan(value)) continue;
        // of the file's -999.9 the float is left
        const bool missing = options.missing && value == static_cast<float>(*options.missing);
        if (missing) ++n_missing;
        value = missing ? std::numeric_limits<float>::quiet_NaN()
                        : static_cast<float>(factor * (static_cast<double>(value) - options.offset));
    }
    return n_missing;
}

double greatest(const Stack& stack) {
    std::vector<double> values;
    const std::size_t n = stack.n_x * stack.n_y;
    const std::size_t step = 1 + n / 20000;
    for (std::size_t first = 0; first < stack.values.size(); first += n) {
        for (std::size_t i = first; i < first + n; i += step) {
            if (!std::isnan(stack.values[i])) values.push_back(std::abs(static_cast<double>(stack.values[i])));
        }
    }
    if (values.empty()) throw files::bad_input(stack.first_file, "", "no number: all cells are empty", "forces");
    return quantile(std::move(values), 0.99);
}

// The forces that come of stiffnesses and moduli are checked at the end, as all are.
void check_size(const Stack& stack, const ImportOptions& options) {
    const double most = greatest(stack);
    if (options.scale_stated) return;
    if (options.quantity == Quantity::stiffness && !(most >= 1.0 && most <= 1e6)) {
        throw files::bad_input(stack.first_file, "", "stiffnesses up to " + files::short_number(1e-3 * most) + " N/mm",
                               "from 0.001 to 1000 N/mm: state the unit by --scale, N/mm for one of the file's");
    } else if (options.quantity == Quantity::young && !(most >= 50.0 && most <= 1e7)) {
        throw files::bad_input(stack.first_file, "",
                               "Young's moduli up to " + files::short_number(1e-3 * most) + " kPa",
                               "from 0.05 to 10000 kPa: state the unit by --scale, kPa for one of the file's");
    }
}

// Turns one slice of stiffness or elasticity into forces at each depth.
void forces_from_slice(Stack& stack, const ImportOptions& options, ImportReport& report) {
    if (options.depths_m.empty())
        throw files::bad_input(stack.first_file, "", "a slice without depths",
                               "the depths that the forces are wanted at: --depths-mm");
    if (stack.n_layers() != 1)
        throw files::bad_input(stack.first_file, "", std::to_string(stack.n_layers()) + " slices", "one");
    const std::vector<float> slice = std::move(stack.values);
    stack.values.clear();
    check_count(slice.size() * options.depths_m.size(), stack.first_file);
    stack.values.reserve(slice.size() * options.depths_m.size());
    stack.depths_m = options.depths_m;
    for (const double depth_m : stack.depths_m) {
        const double per_unit =
            options.quantity == Quantity::stiffness ? depth_m : elastic_force_N(1.0, depth_m, options);
        for (const float value : slice)
            stack.values.push_back(static_cast<float>(per_unit * static_cast<double>(value)));
    }
    const bool beyond = options.quantity == Quantity::young && options.indenter == IndenterShape::sphere &&
                        stack.depths_m.back() > 0.5 * options.indenter_radius_m;
    if (beyond)
        report.notes.push_back("depths beyond half the indenter's radius are beyond what Hertz's formula is made for");
    if (options.quantity == Quantity::young && options.indenter == IndenterShape::cylinder)
        report.notes.push_back(
            "the force of a cylinder by pi/4 E* L d, whatever its radius, is a rough estimate: finite elements gave "
            "half of it for a cylinder of 10 mm radius and 20 mm length");
}

std::vector<float> tangential_of(const std::vector<fs::path>& files, const Stack& normal,
                                 const ImportOptions& options) {
    if (files.empty()) return {};
    Stack stack;
    for (const fs::path& file : files) append(file, options, stack);
    if (stack.n_x != normal.n_x || stack.n_y != normal.n_y) {
        throw files::bad_input(stack.first_file, "shape", files::shape_text({stack.n_y, stack.n_x}),
                               files::shape_text({normal.n_y, normal.n_x}) + " as in " + normal.first_file);
    }
    bool from_names = false;
    stack.depths_m = depths_of(files, stack, options, from_names);
    sort_layers(stack);
    if (stack.depths_m != normal.depths_m)
        throw files::bad_input(stack.first_file, "", "other depths than the normal force has", "the same");
    ImportOptions unsigned_options = options;
    unsigned_options.negate_force = false;  // that sign belongs to the normal force
    scale(stack, unsigned_options);
    return std::move(stack.values);
}

// The options for arrays name their units; a stated unit only confirms one.
void refuse_units(const ImportOptions& options) {
    const auto not_mm = [](const std::optional<LengthUnit>& unit) { return unit && *unit != LengthUnit::mm; };
    if (not_mm(options.length_unit))
        throw files::bad_input("--length-unit", "", "another unit than mm for arrays",
                               "mm, as --spacing-mm and --origin-mm have");
    if (not_mm(options.depth_unit))
        throw files::bad_input("--depth-unit", "", "another unit than mm for arrays",
                               "mm, as --depths-mm and the files' names have");
    if (options.force_unit == ForceUnit::mN && options.quantity != Quantity::force)
        throw files::bad_input("--force-unit", "", "mN for stiffnesses or Young's moduli",
                               "N, to confirm the forces that come of them, or another --scale");
}

void note_choices(const ImportOptions& options, bool from_names, const Stack& stack, MapSource& source) {
    const ImportOptions untold;
    add_choice(source, "form", "matrices", "arrays, by their first bytes", "--form", options.form.has_value());
    add_choice(source, "spacing_mm", choice_mm({options.spacing_m[0], options.spacing_m[1]}), "", "--spacing-mm", true);
    add_choice(source, "origin_mm", choice_mm({options.origin_m[0], options.origin_m[1]}),
               "the first number lies at 0, 0 unless told otherwise", "--origin-mm",
               options.origin_m != untold.origin_m);
    add_choice(source, "depths_mm", choice_mm(stack.depths_m), "numbers before mm in the files' names", "--depths-mm",
               !from_names);
    const char* quantity = options.quantity == Quantity::force       ? "force"
                           : options.quantity == Quantity::stiffness ? "stiffness"
                                                                     : "young";
    add_choice(source, "quantity", quantity, "arrays hold forces unless told otherwise", "--quantity",
               options.quantity != Quantity::force);
    const double unit = options.quantity == Quantity::force ? 1.0 : 1e3;
    add_choice(source, "scale", options.scale / unit, "N, N/mm or kPa for one of the file's", "--scale",
               options.scale_stated);
    if (options.missing) add_choice(source, "missing", *options.missing, "", "--missing", true);
    if (options.offset != 0.0) add_choice(source, "offset", options.offset, "", "--offset", true);
    if (options.quantity == Quantity::young) {
        const bool sphere = options.indenter == IndenterShape::sphere;
        add_choice(source, "contact_formula",
                   sphere ? "Hertz, sphere on a half space" : "line contact, cylinder on a half space",
                   "the indenter's shape", "--indenter, --indenter-radius-mm, --cylinder-length-mm, --poisson");
        add_choice(source, "poisson", options.poisson, "soft tissue hardly changes its volume", "--poisson",
                   options.poisson != untold.poisson);
    }
}

}  // namespace

double elastic_force_N(double young_Pa, double depth_m, const ImportOptions& options) {
    const double modulus = young_Pa / (1.0 - options.poisson * options.poisson);
    if (options.indenter == IndenterShape::cylinder)
        return std::numbers::pi / 4.0 * modulus * options.cylinder_length_m * depth_m;
    return 4.0 / 3.0 * modulus * std::sqrt(options.indenter_radius_m) * std::pow(depth_m, 1.5);
}

Map import_matrices(const std::vector<fs::path>& files, const ImportOptions& options, ImportReport& report) {
    report.form = RecordingForm::matrices;
    std::vector<fs::path> normal_files;
    std::vector<fs::path> along_x = options.tangential_x;
    std::vector<fs::path> along_y = options.tangential_y;
    for (const fs::path& file : files) {
        const bool tangential = says_tangential(file) && files.size() > 1;
        (!tangential ? normal_files : says_along_y(file) ? along_y : along_x).push_back(file);
    }
    if (normal_files.empty())
        throw files::bad_input(files.front().string(), "", "tangential forces alone", "normal forces as well");
    if (!(options.spacing_m[0] > 0.0)) {
        throw files::bad_input(normal_files.front().string(), "", "an array without a scale",
                               "the distance between its numbers: --spacing-mm DX,DY");
    }
    refuse_units(options);
    Stack stack;
    for (std::size_t i = 0; i < normal_files.size(); ++i) {
        if (options.progress) options.progress("reading", static_cast<double>(i) / static_cast<double>(files.size()));
        append(normal_files[i], options, stack);
    }
    if (scale(stack, options) == 0 && options.missing)
        report.notes.push_back("warning: no number is " + files::short_number(*options.missing) +
                               ", which --missing names: all are taken as measured");
    check_size(stack, options);
    bool from_names = false;
    if (options.quantity == Quantity::force) {
        stack.depths_m = depths_of(normal_files, stack, options, from_names);
        sort_layers(stack);
    } else {
        forces_from_slice(stack, options, report);
    }
    Map map;
    note_choices(options, from_names, stack, map.source);
    GridPlan plan;
    plan.x = {options.origin_m[0], options.spacing_m[0], stack.n_x};
    plan.y = {options.origin_m[1], options.spacing_m[1], stack.n_y};
    plan.depths_m = stack.depths_m;
    check_grid(plan.x, plan.y, plan.depths_m.size(), stack.first_file);
    start_map(plan, map);
    map.normal_N = std::move(stack.values);
    map.tangential_x_N = tangential_of(along_x, stack, options);
    map.tangential_y_N = tangential_of(along_y, stack, options);
    const bool measured = !map.tangential_x_N.empty() || !map.tangential_y_N.empty();
    map.source.how = options.quantity == Quantity::force ? "matrices of force, one for each depth"
                     : options.quantity == Quantity::stiffness
                         ? "a slice of stiffness; force = stiffness times depth"
                         : "a slice of Young's moduli; force by a contact formula on an even half space";
    report.rows = map.normal_N.size();
    report.points = map.normal_N.size() - missing_count(map);
    finish_map(map, {}, measured, options, stack.first_file, report);
    return map;
}

}  // namespace palpa::stiffnessmaps
