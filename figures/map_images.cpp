#include "figures/map_images.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "files/text.h"
#include "stiffnessmaps/stiffness.h"

namespace palpa::figures {
namespace {

constexpr double kNaN = std::numeric_limits<double>::quiet_NaN();

// Returns the borders of a set of cells as line segments, in mm.
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

// Returns the outline of a nodule of the map, in mm: a disc, or a capsule along its angle.
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
    // a dark rim around white letters makes them readable on any colour
    std::string out;
    for (const char* rim : {"-0.09,0", "0.09,0", "0,-0.06", "0,0.06"}) {
        out += "set label " + quoted(text) + " at " + text_of(x_mm) + "," + text_of(y_mm) +
               " center front tc rgb '#000000' offset " + rim + "\n";
    }
    return out + "set label " + quoted(text) + " at " + text_of(x_mm) + "," + text_of(y_mm) +
           " center front tc rgb '#ffffff'\n";
}

// Draws the outlines of placed nodules (dashed) and of found regions (solid if sure, dotted if not).
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

}  // namespace

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

Image depth_image(const stiffnessmaps::Map& map, const stiffnessmaps::Field& field, double force_N) {
    Image im = image_of(map);
    bool all_reached = true;
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        const stiffnessmaps::DepthAnswer answer = stiffnessmaps::depth_at(
            field, stiffnessmaps::place_at(field, {map.x_of(cell % map.n_x), map.y_of(cell / map.n_x)}), force_N);
        const bool measured = field.measured[cell] > 0.0;
        all_reached = all_reached && !(measured && answer.saturated);
        // a depth beyond what was measured is not known
        im.values.push_back(measured && !answer.saturated ? 1e3 * answer.depth_m : kNaN);
    }
    im.title =
        "Depth at " + files::short_number(force_N) + " N" + (all_reached ? "" : " (hatched: not reached or measured)");
    im.unit = "mm";
    im.span = span_of(im.values);
    return im;
}

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

}  // namespace palpa::figures
