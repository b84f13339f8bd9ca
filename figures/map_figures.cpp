#include "figures/map_figures.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "figures/colour_maps.h"
#include "figures/gnuplot.h"
#include "figures/tic_step.h"
#include "files/input_error.h"
#include "files/quantile.h"
#include "files/text.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa::figures {
namespace {

// Colours by Okabe and Ito, which colour-blind people can tell apart.
constexpr const char* kHead =
    R"gp(set border lw 0.8
set tics out nomirror scale 0.5
set cbtics scale 0.4
set style line 1 lc rgb "#D55E00" lw 2 pt 7 ps 0.8
set style line 2 lc rgb "#0072B2" lw 2 pt 5 ps 0.8
set style line 3 lc rgb "#009E73" lw 2 pt 9 ps 0.9
set style line 4 lc rgb "#CC79A7" lw 2 pt 13 ps 0.9
set style line 5 lc rgb "#E69F00" lw 2 pt 11 ps 0.9
set style line 6 lc rgb "#000000" lw 2 pt 4 ps 0.9
)gp";
constexpr int kLineStyles = 6;
constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

std::string text_of(double value) { return std::isfinite(value) ? files::number_text(value) : "NaN"; }

// Nothing of the text is taken as markup.
std::string quoted(const std::string& text) { return single_quoted(text) + " noenhanced"; }

struct Span {
    double low = 0.0;
    double high = 1.0;
};

Span span_of(const std::vector<double>& values) {
    Span span{INFINITY, -INFINITY};
    for (const double v : values) {
        if (!std::isfinite(v)) continue;
        span.low = std::min(span.low, v);
        span.high = std::max(span.high, v);
    }
    if (!(span.low <= span.high)) return {0.0, 1.0};
    if (span.low == span.high) span.high = span.low + std::max(1e-6, 0.1 * std::abs(span.low));
    return span;
}

// A picture of numbers on a grid; x and y in mm.
struct Image {
    std::string title;
    std::string x_label = "x (mm)";
    std::string y_label = "y (mm)";
    std::string unit;
    double x0 = 0.0, dx = 1.0, y0 = 0.0, dy = 1.0;
    std::size_t n_x = 1, n_y = 1;
    std::vector<double> values;  // [n_y][n_x]
    Span span;
    bool apart = false;  // around 0
    bool bar = true;
    bool small = false;       // of small multiples: numbers at the outer axes only
    bool title_left = false;  // beside a key
    bool down = false;        // y grows downwards, and is not to the scale of x
    std::string over;         // further plot elements, and commands before the plot
    std::string before;
};

struct Box {
    double x0, x1, y0, y1;  // of the drawing area, shares of the figure, y upwards
};

class Script {
  public:
    Script(const std::string& title, double width_px, double height_px)
        : width_px_(width_px),
          height_px_(height_px),
          text_(kHead + ("set label 99 " + quoted(title) + " at screen 0.5, screen " + text_of(1.0 - 16.0 / height_px) +
                         " center font ',13'\n")) {}
    void add(const std::string& text) { text_ += text; }

    std::string block(const std::string& rows) {
        const std::string name = "$d" + std::to_string(++blocks_);
        blocks_text_ += name + " << EOD\n" + rows + "EOD\n";
        return name;
    }

    void image(const Image& im, Box box) {
        // as wide as the picture will be, so that the colour bar stands beside it
        const double aspect = im.dy * static_cast<double>(im.n_y) / (im.dx * static_cast<double>(im.n_x));
        if (!im.down) box.x1 = std::min(box.x1, box.x0 + (box.y1 - box.y0) * height_px_ / aspect / width_px_);
        std::string rows;
        for (std::size_t j = 0; j < im.n_y; ++j) {
            for (std::size_t i = 0; i < im.n_x; ++i) {
                rows += text_of(im.x0 + im.dx * static_cast<double>(i)) + " " +
                        text_of(im.y0 + im.dy * static_cast<double>(j)) + " " + text_of(im.values[j * im.n_x + i]) +
                        "\n";
            }
        }
        const std::string data = block(rows);
        place(box);
        text_ += "set palette " + gnuplot_palette(im.apart ? kApart : kViridis) + "\n";
        text_ += "set cbrange [" + text_of(im.span.low) + ":" + text_of(im.span.high) + "]\n";
        text_ += im.bar ? "set colorbox user origin screen " + text_of(box.x1 + 0.008) + ", screen " + text_of(box.y0) +
                              " size screen 0.012, screen " + text_of(box.y1 - box.y0) + "\nset cblabel " +
                              quoted(im.unit) + " offset 0.5,0\n"
                        : "unset colorbox\n";
        text_ += im.down ? "set size noratio\n" : "set size ratio -1\n";
        const double x1 = im.x0 + im.dx * (static_cast<double>(im.n_x) - 0.5);
        const double y1 = im.y0 + im.dy * (static_cast<double>(im.n_y) - 0.5);
        text_ += "set xrange [" + text_of(im.x0 - 0.5 * im.dx) + ":" + text_of(x1) + "]\n";
        const std::string low = text_of(im.y0 - 0.5 * im.dy);
        text_ += "set yrange [" + (im.down ? text_of(y1) + ":" + low : low + ":" + text_of(y1)) + "]\n";
        text_ +=
            "set xlabel " + quoted(im.x_label) + " offset 0,0.5\nset ylabel " + quoted(im.y_label) + " offset 1,0\n";
        text_ += im.title_left
                     ? "unset title\nset label 98 " + quoted(im.title) + " at graph 0, graph 1 left offset 0,0.7\n"
                     : "set title " + quoted(im.title) + " offset 0,-0.6\n";
        if (im.small && im.y_label.empty()) text_ += "set format y ''\n";
        if (im.small && im.x_label.empty()) text_ += "set format x ''\n";
        text_ += im.before;
        text_ +=
            "set object 1 rectangle from graph 0,0 to graph 1,1 fc rgb '#9a9a9a' fs pattern 4 noborder behind\nset "
            "grid noxtics noytics\n";
        text_ += "set xtics " +
                 text_of(tic_step(im.dx * static_cast<double>(im.n_x),
                                  std::max(4.0, (box.x1 - box.x0) * width_px_ / 70.0))) +
                 "\n";
        text_ +=
            im.down
                ? "set ytics autofreq\n"
                : "set ytics " +
                      text_of(tic_step(im.dy * static_cast<double>(im.n_y), std::max(4.0, (box.x1 - box.x0) * 20.0))) +
                      "\n";
        text_ += "plot " + data + " using 1:2:3 with image notitle" + im.over +
                 "\nunset object 1\nunset label\nset key default\nset xtics autofreq\nset ytics autofreq\nset format x "
                 "'% h'\nset format y '% h'\n";
    }

    void place(const Box& box) {
        text_ += "set lmargin at screen " + text_of(box.x0) + "\nset rmargin at screen " + text_of(box.x1) +
                 "\nset bmargin at screen " + text_of(box.y0) + "\nset tmargin at screen " + text_of(box.y1) + "\n";
    }

    std::string whole() const { return blocks_text_ + "set multiplot\n" + text_ + "unset multiplot\n"; }

  private:
    double width_px_;
    double height_px_;
    std::string text_;
    std::string blocks_text_;
    int blocks_ = 0;
};

Image image_of(const stiffnessmaps::Map& map) {
    Image im;
    im.x0 = 1e3 * map.x_of(0);
    im.dx = 1e3 * map.spacing_m[0];
    im.y0 = 1e3 * map.y_of(0);
    im.dy = 1e3 * map.spacing_m[1];
    im.n_x = map.n_x;
    im.n_y = map.n_y;
    return im;
}

// Borders of a set of cells as line pieces, mm.
std::string outline_rows(const stiffnessmaps::Map& map, const std::vector<std::size_t>& cells) {
    std::vector<bool> in(map.n_cells(), false);
    for (const std::size_t cell : cells) in[cell] = true;
    std::string rows;
    const auto piece = [&](double i0, double j0, double i1, double j1) {
        const auto x = [&](double i) { return text_of(1e3 * (map.origin_m[0] + map.spacing_m[0] * i)); };
        const auto y = [&](double j) { return text_of(1e3 * (map.origin_m[1] + map.spacing_m[1] * j)); };
        rows += x(i0) + " " + y(j0) + "\n" + x(i1) + " " + y(j1) + "\n\n";
    };
    for (const std::size_t cell : cells) {
        const auto i = static_cast<double>(cell % map.n_x);
        const auto j = static_cast<double>(cell / map.n_x);
        const std::size_t column = cell % map.n_x;
        if (column == 0 || !in[cell - 1]) piece(i - 0.5, j - 0.5, i - 0.5, j + 0.5);
        if (column + 1 == map.n_x || !in[cell + 1]) piece(i + 0.5, j - 0.5, i + 0.5, j + 0.5);
        if (cell < map.n_x || !in[cell - map.n_x]) piece(i - 0.5, j - 0.5, i + 0.5, j - 0.5);
        if (cell + map.n_x >= map.n_cells() || !in[cell + map.n_x]) piece(i - 0.5, j + 0.5, i + 0.5, j + 0.5);
    }
    return rows;
}

// A placed or kept nodule as it stands in the map: a disc, or a capsule along its angle.
std::string nodule_rows(const stiffnessmaps::Nodule& nodule) {
    const double radius_m = 0.5 * nodule.diameter_m.value_or(4e-3);
    const double half_m = std::max(0.0, 0.5 * nodule.length_m.value_or(0.0) - radius_m);
    const double turn = nodule.angle_deg.value_or(0.0) * std::numbers::pi / 180.0;
    std::string rows;
    for (int k = 0; k <= 72; ++k) {
        const double a = 2.0 * std::numbers::pi * k / 72.0;
        const double along = radius_m * std::cos(a) + (std::cos(a) >= 0.0 ? half_m : -half_m);
        const double across = radius_m * std::sin(a);
        rows += text_of(1e3 * (nodule.x_m + along * std::cos(turn) - across * std::sin(turn))) + " " +
                text_of(1e3 * (nodule.y_m + along * std::sin(turn) + across * std::cos(turn))) + "\n";
    }
    return rows + "\n";
}

std::string label(const std::string& text, double x_mm, double y_mm) {
    // a dark rim under a white letter, so that it can be read on any colour
    std::string out;
    for (const char* rim : {"-0.09,0", "0.09,0", "0,-0.06", "0,0.06"}) {
        out += "set label " + quoted(text) + " at " + text_of(x_mm) + "," + text_of(y_mm) +
               " center front tc rgb '#000000' offset " + rim + "\n";
    }
    return out + "set label " + quoted(text) + " at " + text_of(x_mm) + "," + text_of(y_mm) +
           " center front tc rgb '#ffffff'\n";
}

// Nodules of the map: placed ones dashed. Found regions: solid if sure, dotted if not.
void outline(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection, Script& script, Image& im) {
    std::string placed, sure, unsure;
    for (const stiffnessmaps::Nodule& nodule : map.nodules) {
        if (nodule.placed) placed += nodule_rows(nodule);
        if (nodule.placed) im.before += label(nodule.id, 1e3 * nodule.x_m, 1e3 * nodule.y_m);
    }
    for (const stiffnessmaps::StiffRegion& region : detection.regions) {
        (region.sure ? sure : unsure) += outline_rows(map, region.cells);
        const double up_m = 0.5 * region.width_m + 0.03 * map.spacing_m[1] * static_cast<double>(map.n_y);
        const bool fits = region.y_m + up_m < map.y_of(map.n_y - 1);
        im.before +=
            label(region.id + (region.sure ? "" : "?"), 1e3 * region.x_m, 1e3 * (region.y_m + (fits ? up_m : -up_m)));
    }
    const auto line = [&](const std::string& rows, const char* look, const char* title) {
        if (rows.empty()) return;
        const std::string data = script.block(rows);
        im.over += ", " + data + " using 1:2 with lines lc rgb '#000000' lw 3.4 notitle";
        im.over += ", " + data + " using 1:2 with lines lc rgb '#ffffff' " + look + " title '" + title + "'";
    };
    line(placed, "lw 1.6 dt 2", "placed");
    line(sure, "lw 1.8", "found");
    line(unsure, "lw 1.6 dt 3", "found, unsure");
    im.before += "set key at graph 1,1.01 right bottom horizontal samplen 2 opaque fc rgb '#808080' tc rgb '#ffffff'\n";
    im.title_left = true;
}

Image stiffness_image(const stiffnessmaps::Map& map) {
    Image im = image_of(map);
    im.title = "Stiffness";
    im.unit = "N/mm";
    for (const double k : stiffnessmaps::stiffness_N_per_m(map)) im.values.push_back(1e-3 * k);
    im.span = span_of(im.values);
    return im;
}

Image nodules_image(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection, Script& script) {
    Image im = stiffness_image(map);
    im.title = "Stiffness";
    outline(map, detection, script, im);
    return im;
}

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

Image depth_image(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field, double force_N) {
    Image im = image_of(map);
    im.title = "Depth at " + files::short_number(force_N) + " N";
    im.unit = "mm";
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        const stiffnessmaps::DepthAnswer answer = stiffnessmaps::depth_at(
            field, stiffnessmaps::place_at(field, {map.x_of(cell % map.n_x), map.y_of(cell / map.n_x)}), force_N);
        // deeper than was measured: not known
        im.values.push_back(field.measured[cell] > 0.0 && !answer.saturated ? 1e3 * answer.depth_m : kNaN);
    }
    im.span = span_of(im.values);
    return im;
}

// Along x through a row of cells, down to the deepest matrix.
Image section_image(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field, std::size_t row) {
    Image im = image_of(map);
    constexpr std::size_t kSteps = 60;
    im.title = "Normal force along x at y = " + files::short_number(1e3 * map.y_of(row)) + " mm";
    im.y_label = "depth (mm)";
    im.unit = "N";
    im.down = true;
    im.n_y = kSteps;
    im.dy = 1e3 * map.depths_m.back() / kSteps;
    im.y0 = 0.5 * im.dy;
    for (std::size_t k = 0; k < kSteps; ++k) {
        for (std::size_t i = 0; i < map.n_x; ++i) {
            const stiffnessmaps::Place place = stiffnessmaps::place_at(field, {map.x_of(i), map.y_of(row)});
            const double depth_m = 1e-3 * (im.y0 + im.dy * static_cast<double>(k));
            const bool known = place.measured && depth_m <= stiffnessmaps::greatest_depth_m(field, place);
            im.values.push_back(known ? stiffnessmaps::normal_force_N(field, place, depth_m) : kNaN);
        }
    }
    im.span = span_of(im.values);
    return im;
}

std::size_t stiffest_cell(const stiffnessmaps::Map& map) {
    const std::vector<double> k = stiffnessmaps::stiffness_N_per_m(map);
    std::size_t best = 0;
    for (std::size_t cell = 0; cell < k.size(); ++cell) {
        if (std::isfinite(k[cell]) && !(k[best] >= k[cell])) best = cell;
    }
    return best;
}

// Where curves are drawn if nobody says where.
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

// Of small multiples.
std::size_t columns_of(const stiffnessmaps::Map& map) { return map.n_depths() <= 6 ? map.n_depths() : 5; }

std::size_t matrix_rows(const stiffnessmaps::Map& map) {
    return kinds_of(map).size() * ((map.n_depths() + columns_of(map) - 1) / columns_of(map));
}

// Small multiples in the strip from y0 to y1 of the figure; one scale for each kind of force.
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

int clamped(double px) { return static_cast<int>(std::clamp(px, 300.0, 4000.0)); }

}  // namespace

void plot_map(const stiffnessmaps::Map& map, const stiffnessmaps::Detection& detection, const PlotOptions& options,
              const std::filesystem::path& file) {
    check_figure(file);
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
