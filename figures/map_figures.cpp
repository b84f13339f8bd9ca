#include "figures/map_figures.h"

#include <algorithm>
#include <cmath>

#include "figures/gnuplot.h"
#include "figures/map_images.h"
#include "files/input_error.h"
#include "files/quantile.h"
#include "files/text.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa::figures {
namespace {

constexpr int kLineStyles = 6;

double slice_force_N(const stiffnessmaps::Map& map, const PlotOptions& options) {
    if (options.force_N) return *options.force_N;
    std::vector<double> deepest;
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        for (std::size_t k = map.n_depths(); k-- > 0;) {
            const auto force_N = static_cast<double>(map.normal_N[k * map.n_cells() + cell]);
            if (std::isnan(force_N)) continue;
            deepest.push_back(force_N);
            break;
        }
    }
    return std::max(1e-3, std::round(50.0 * files::upper_median(deepest)) / 100.0);
}

std::size_t stiffest_cell(const stiffnessmaps::Map& map) {
    const std::vector<double> k = stiffnessmaps::stiffness_N_per_m(map);
    std::size_t best = 0;
    for (std::size_t cell = 0; cell < k.size(); ++cell) {
        if (std::isfinite(k[cell]) && !(k[best] >= k[cell])) best = cell;
    }
    return best;
}

// Returns the places of the curves: those asked for, or up to three regions (without any, the stiffest cell) and a cell
// of median stiffness.
std::vector<Eigen::Vector2d> curve_places(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection,
                                          const PlotOptions& options) {
    if (!options.at_m.empty()) return options.at_m;
    std::vector<Eigen::Vector2d> out;
    for (const stiffnessmaps::StiffRegion& region : detection.regions) {
        if (out.size() < 3) out.emplace_back(region.peak_x_m, region.peak_y_m);
    }
    const auto place_of = [&](std::size_t cell) {
        return Eigen::Vector2d(map.x_of(cell % map.n_x), map.y_of(cell / map.n_x));
    };
    if (out.empty()) out.push_back(place_of(stiffest_cell(map)));
    const std::vector<double> k = stiffnessmaps::stiffness_N_per_m(map);
    const double middle = files::upper_median(k);
    std::size_t best = 0;
    double off = INFINITY;
    for (std::size_t cell = 0; cell < k.size(); ++cell) {
        if (!(std::abs(k[cell] - middle) < off)) continue;
        off = std::abs(k[cell] - middle);
        best = cell;
    }
    out.push_back(place_of(best));
    return out;
}

void curves(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field,
            const std::vector<Eigen::Vector2d>& places, const Box& box, Script& script) {
    std::string plot;
    int style = 0;
    for (const Eigen::Vector2d& p_m : places) {
        const stiffnessmaps::Place place = stiffnessmaps::place_at(field, p_m);
        std::string rows;
        for (const double depth_m : field.depths_m) {
            if (depth_m > greatest_depth_m(field, place) * (1.0 + 1e-9)) break;
            rows += text_of(1e3 * depth_m) + " " + text_of(stiffnessmaps::normal_force_N(field, place, depth_m)) + "\n";
        }
        const std::string name = "(" + files::short_number(1e3 * p_m.x()) + ", " + files::short_number(1e3 * p_m.y()) +
                                 ") mm" + (place.measured ? "" : ", not measured");
        plot += (plot.empty() ? "plot " : ", ") + script.block(rows) + " using 1:2 with linespoints ls " +
                std::to_string(style++ % kLineStyles + 1) + " title " + quoted(name);
    }
    script.place(box);
    script.add("set size noratio\nset xrange [0:" + text_of(1e3 * map.depths_m.back()) +
               "]\nset yrange [*:*]\nset key top left Left reverse samplen 2\n"
               "set xlabel 'depth (mm)' offset 0,0.5\nset ylabel 'normal force (N)' offset 1,0\nset title 'Force over "
               "depth' offset 0,-0.6\n"
               "set grid xtics ytics lc rgb '#BBBBBB' dt 3\nunset colorbox\n" +
               plot + "\n");
}

struct Kind {
    const char* name;
    const std::vector<float>& forces;
};

std::vector<Kind> kinds_of(const stiffnessmaps::Map& map) {
    std::vector<Kind> kinds{{"Normal force", map.normal_N}};
    if (!map.tangential_x_N.empty()) kinds.push_back({"Tangential force against +x", map.tangential_x_N});
    if (!map.tangential_y_N.empty()) kinds.push_back({"Tangential force against +y", map.tangential_y_N});
    return kinds;
}

// Columns and rows of the small multiples.
std::size_t columns_of(const stiffnessmaps::Map& map) { return map.n_depths() <= 6 ? map.n_depths() : 5; }

std::size_t matrix_rows(const stiffnessmaps::Map& map) {
    return kinds_of(map).size() * ((map.n_depths() + columns_of(map) - 1) / columns_of(map));
}

// Draws small multiples in the strip from y0 to y1 of the figure; each kind of force has one scale.
void matrices(const stiffnessmaps::Map& map, double y0, double y1, double height_px, Script& script) {
    const std::size_t columns = columns_of(map);
    const std::size_t rows_of_kind = (map.n_depths() + columns - 1) / columns;
    const auto kinds = kinds_of(map);
    const double cell_h = (y1 - y0) / static_cast<double>(kinds.size() * rows_of_kind);
    const double left = 0.06;
    const double cell_w = (0.91 - left) / static_cast<double>(columns);
    for (std::size_t which = 0; which < kinds.size(); ++which) {
        std::vector<double> all(kinds[which].forces.begin(), kinds[which].forces.end());
        Span span = span_of(all);
        if (which > 0) span.low = -(span.high = std::max({std::abs(span.low), std::abs(span.high), 1e-9}));  // signed
        for (std::size_t k = 0; k < map.n_depths(); ++k) {
            const std::size_t row = which * rows_of_kind + k / columns;
            const std::size_t column = k % columns;
            Image im = image_of(map);
            im.values.assign(all.begin() + static_cast<std::ptrdiff_t>(k * map.n_cells()),
                             all.begin() + static_cast<std::ptrdiff_t>((k + 1) * map.n_cells()));
            im.span = span;
            im.apart = which > 0;
            im.unit = "N";
            im.title = (k == 0 ? std::string(kinds[which].name) + ", " : "") +
                       files::short_number(1e3 * map.depths_m[k]) + " mm";
            im.bar = column + 1 == columns || k + 1 == map.n_depths();
            im.small = true;
            if (column > 0) im.y_label = "";
            const bool last = k + columns >= map.n_depths() && which + 1 == kinds.size();
            if (!last) im.x_label = "";
            const double top = y1 - cell_h * static_cast<double>(row);
            const double x = left + cell_w * static_cast<double>(column);
            script.image(im, {x, x + 0.86 * cell_w, top - cell_h + 52.0 / height_px, top - 26.0 / height_px});
        }
    }
}

double aspect_of(const stiffnessmaps::Map& map) {  // height / width
    return map.spacing_m[1] * static_cast<double>(map.n_y) / (map.spacing_m[0] * static_cast<double>(map.n_x));
}

// gnuplot draws no image of fewer.
void check_cells(const stiffnessmaps::Map& map, const char* instead) {
    constexpr std::size_t kLeast = 4;
    if (map.n_cells() >= kLeast) return;
    throw files::bad_input(map.name, "", std::to_string(map.n_x) + " x " + std::to_string(map.n_y) + " places",
                           "at least 4 for a picture" + std::string(instead));
}

int clamped(double px) { return static_cast<int>(std::clamp(px, 300.0, 4000.0)); }

}  // namespace

void plot_map(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection, const PlotOptions& options,
              const std::filesystem::path& file) {
    check_figure(file);
    if (options.what != PlotWhat::curves) check_cells(map, "; the curves of fewer can be drawn");
    const stiffnessmaps::Field field = stiffnessmaps::make_field(map, {});
    for (const Eigen::Vector2d& p_m : options.at_m) {
        if (stiffnessmaps::place_at(field, p_m).inside) continue;
        throw files::bad_input(
            map.name, "--at", files::short_number(1e3 * p_m.x()) + "," + files::short_number(1e3 * p_m.y()),
            "a place on the map: x " + files::short_number(1e3 * map.x_of(0)) + " to " +
                files::short_number(1e3 * map.x_of(map.n_x - 1)) + ", y " + files::short_number(1e3 * map.y_of(0)) +
                " to " + files::short_number(1e3 * map.y_of(map.n_y - 1)) + " mm");
    }
    const double aspect = std::clamp(aspect_of(map), 0.25, 3.0);
    const std::size_t row = stiffest_cell(map) / map.n_x;
    const double force_N = slice_force_N(map, options);
    const int single_width = 900;
    const int single_height = clamped(0.76 * single_width * aspect + 125.0);
    const auto single = [&](const Image& im, Script& script) {
        const int width = single_width;
        const int height = single_height;
        script.image(im, {0.09, 0.85, 60.0 / height, 1.0 - 65.0 / height});
        draw_figure(script.whole(), file, width, height);
    };
    switch (options.what) {
        case PlotWhat::stiffness: {
            Script script(map.name, single_width, single_height);
            return single(stiffness_image(map), script);
        }
        case PlotWhat::nodules: {
            Script script(map.name, single_width, single_height);
            return single(nodules_image(map, detection, script), script);
        }
        case PlotWhat::curves: {
            Script script(map.name, 900, 600);
            curves(map, field, curve_places(map, detection, options), {0.1, 0.97, 0.12, 0.88}, script);
            return draw_figure(script.whole(), file, 900, 600);
        }
        case PlotWhat::slice: {
            const int width = 900;
            const double picture = std::min(900.0, 0.74 * width * aspect);
            const int height = clamped(picture + 440.0);
            Script script(map.name, width, height);
            script.image(depth_image(map, field, force_N),
                         {0.09, 0.85, 1.0 - (65.0 + picture) / height, 1.0 - 65.0 / height});
            script.image(section_image(map, field, row), {0.09, 0.85, 60.0 / height, 270.0 / height});
            return draw_figure(script.whole(), file, width, height);
        }
        case PlotWhat::matrices: {
            const int width = 1400;
            const auto columns = static_cast<double>(columns_of(map));
            const double cell = std::min(320.0, 0.85 * width / columns * 0.86 * aspect) + 78.0;
            const int height = clamped(cell * static_cast<double>(matrix_rows(map)) + 50.0);
            Script script(map.name, width, height);
            matrices(map, 0.0, 1.0 - 40.0 / height, height, script);
            return draw_figure(script.whole(), file, width, height);
        }
        case PlotWhat::all: {
            const int width = 1400;
            const double picture = std::min(640.0, 0.37 * width * aspect);
            const auto columns = static_cast<double>(columns_of(map));
            const double cell = std::min(320.0, 0.85 * width / columns * 0.86 * aspect) + 78.0;
            const double small = cell * static_cast<double>(matrix_rows(map));
            const double height = std::floor(65.0 + picture + 100.0 + 310.0 + small);
            const double top = 1.0 - 65.0 / height;
            const double first = top - picture / height;
            Script script(map.name, width, height);
            script.image(nodules_image(map, detection, script), {0.06, 0.43, first, top});
            script.image(depth_image(map, field, force_N), {0.55, 0.92, first, top});
            const double second = first - 100.0 / height;
            script.image(section_image(map, field, row), {0.06, 0.43, second - 260.0 / height, second});
            curves(map, field, curve_places(map, detection, options), {0.57, 0.94, second - 260.0 / height, second},
                   script);
            matrices(map, 0.0, second - 310.0 / height, height, script);
            return draw_figure(script.whole(), file, width, static_cast<int>(height));
        }
    }
}

void plot_difference(const stiffnessmaps::MapDifference& d, const std::filesystem::path& file) {
    check_figure(file);
    check_cells(d.a, "");
    const std::size_t k = d.a.n_depths() - 1;
    const std::size_t cells = d.a.n_cells();
    const std::string depth = " at " + files::short_number(1e3 * d.a.depths_m[k]) + " mm";
    Image a = image_of(d.a);
    a.unit = "N";
    Image b = a;
    Image apart = a;
    for (std::size_t cell = 0; cell < cells; ++cell) {
        a.values.push_back(static_cast<double>(d.a.normal_N[k * cells + cell]));
        b.values.push_back(static_cast<double>(d.b.normal_N[k * cells + cell]));
        apart.values.push_back(b.values.back() - a.values.back());
    }
    std::vector<double> both = a.values;
    both.insert(both.end(), b.values.begin(), b.values.end());
    a.span = b.span = span_of(both);
    const Span span = span_of(apart.values);
    const double most = std::max({std::abs(span.low), std::abs(span.high), 1e-9});
    apart.span = {-most, most};
    apart.apart = true;
    a.title = "A: " + d.a.name + depth;
    b.title = "B: " + d.b.name + depth;
    apart.title = "B - A" + depth;
    b.y_label = apart.y_label = "";
    const int width = 1500;
    const int height = clamped(0.23 * width * std::clamp(aspect_of(d.a), 0.25, 3.0) + 150.0);
    const double low = 60.0 / height;
    const double high = 1.0 - 80.0 / height;
    Script script("Normal force of two maps, and their difference", width, height);
    script.image(a, {0.05, 0.28, low, high});
    script.image(b, {0.385, 0.615, low, high});
    script.image(apart, {0.71, 0.94, low, high});
    draw_figure(script.whole(), file, width, height);
}

}  // namespace palpa::figures
