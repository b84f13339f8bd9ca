#include "stiffnessmaps/import/probing.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <map>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/map_file.h"

namespace palpa {
namespace {

constexpr double kOffCommand_m = 1e-3;

struct Point {
    double x_m = 0.0;
    double y_m = 0.0;
    std::size_t line = 0;
    std::vector<double> depth_m;  // ascending, from the contact on
    std::vector<double> force_N;  // less the force at contact
};

double median(std::vector<double> values) {
    if (values.empty()) return 0.0;
    const auto middle = values.begin() + static_cast<std::ptrdiff_t>(values.size() / 2);
    std::nth_element(values.begin(), middle, values.end());
    return *middle;
}

std::map<long, Point> read_points(const std::filesystem::path& csv, ProbingReport& report,
                                  std::vector<double>& offsets_N) {
    Table table = read_csv(csv);
    const std::size_t point = table.column("point");
    const std::size_t x = table.column("ref_x_mm");
    const std::size_t y = table.column("ref_y_mm");
    const std::size_t commanded = table.column("depth_cmd_mm");
    const std::size_t depth = table.column("depth_mm");
    const std::size_t force = table.column("fn_N");

    std::map<long, Point> points;
    while (table.next()) {
        ++report.rows;
        const double id = table.finite_number(point);
        if (id != std::floor(id) || std::abs(id) > 1e9) table.fail(point, "a whole number");
        const double x_m = 1e-3 * table.finite_number(x);
        const double y_m = 1e-3 * table.finite_number(y);
        auto [it, is_new] = points.try_emplace(static_cast<long>(id));
        Point& p = it->second;
        if (is_new) {
            p.x_m = x_m;
            p.y_m = y_m;
            p.line = table.line();
        } else if (x_m != p.x_m || y_m != p.y_m) {
            table.fail(x, "the position of line " + std::to_string(p.line) + " for the same point");
        }
        const double depth_m = 1e-3 * table.number(depth);
        const double force_N = table.number(force);
        const double commanded_m = 1e-3 * table.number(commanded);
        const bool moved_on = p.depth_m.empty() || depth_m > p.depth_m.back();
        if (!moved_on || std::isnan(force_N) || !(std::abs(depth_m - commanded_m) < kOffCommand_m)) {
            ++report.rejected_rows;
            continue;
        }
        if (p.depth_m.empty()) offsets_N.push_back(force_N);
        p.depth_m.push_back(depth_m);
        p.force_N.push_back(force_N);
    }
    for (auto& [id, p] : points) {
        if (p.depth_m.empty()) continue;
        const double depth_offset_m = p.depth_m.front();
        const double offset_N = p.force_N.front();
        for (double& d : p.depth_m) d -= depth_offset_m;
        for (double& f : p.force_N) f -= offset_N;
    }
    return points;
}

// Coordinates that appear, and the pitch that they are multiples of.
struct Axis {
    double origin_m = 0.0;
    double pitch_m = 1e-3;
    std::size_t n = 1;
};

Axis find_axis(const std::map<long, Point>& points, bool along_y, const std::string& file) {
    std::vector<double> places;
    for (const auto& [id, p] : points) places.push_back(along_y ? p.y_m : p.x_m);
    std::sort(places.begin(), places.end());
    constexpr double kSame_m = 1e-5;
    std::vector<double> steps;
    for (std::size_t i = 1; i < places.size(); ++i) {
        if (places[i] - places[i - 1] > kSame_m) steps.push_back(places[i] - places[i - 1]);
    }
    Axis axis;
    axis.origin_m = places.front();
    if (steps.empty()) return axis;
    const double about_m = median(steps);  // a gap in the grid makes some steps longer, never most
    const double count = std::round((places.back() - places.front()) / about_m);
    constexpr double kMost = 10000.0;
    if (count >= kMost) {
        throw bad_input(file, along_y ? "ref_y_mm" : "ref_x_mm", short_number(1e3 * about_m) + " mm between positions",
                        "a regular grid");
    }
    axis.n = 1 + static_cast<std::size_t>(count);
    axis.pitch_m = (places.back() - places.front()) / count;
    return axis;
}

std::size_t index_on(const Axis& axis, double place_m, std::string_view column, const Point& p,
                     const std::string& file) {
    const double at = (place_m - axis.origin_m) / axis.pitch_m;
    constexpr double kOffGrid = 0.1;  // of the pitch
    if (std::abs(at - std::round(at)) > kOffGrid) {
        throw bad_input(file, "line " + std::to_string(p.line) + ", " + std::string(column),
                        short_number(1e3 * place_m) + " mm",
                        "a position on the regular grid of " + short_number(1e3 * axis.pitch_m) + " mm");
    }
    return static_cast<std::size_t>(std::llround(at));
}

// Force at a depth from a point's own steps; NaN beyond its greatest depth (5 % of a step is let pass).
double force_at(const Point& p, double depth_m, double step_m) {
    const auto& d = p.depth_m;
    if (depth_m > d.back() + 0.05 * step_m) return std::numeric_limits<double>::quiet_NaN();
    std::size_t i = 1;
    while (i + 1 < d.size() && d[i] < depth_m) ++i;
    const double s = (depth_m - d[i - 1]) / (d[i] - d[i - 1]);
    return p.force_N[i - 1] + s * (p.force_N[i] - p.force_N[i - 1]);
}

void measure_residuals(const Map& map, const std::map<long, Point>& points, ProbingReport& report) {
    const Field field = make_field(map, {});
    std::vector<double> residuals;
    for (const auto& [id, p] : points) {
        if (p.depth_m.size() < 2) continue;
        const Place place = place_at(field, {p.x_m, p.y_m});
        for (std::size_t i = 1; i < p.depth_m.size(); ++i) {
            if (p.depth_m[i] > greatest_depth_m(field, place)) continue;
            residuals.push_back(std::abs(normal_force_N(field, place, p.depth_m[i]) - p.force_N[i]));
        }
    }
    if (residuals.empty()) return;
    report.worst_residual_N = *std::max_element(residuals.begin(), residuals.end());
    report.median_residual_N = median(residuals);
}

}  // namespace

Map import_probing(const std::filesystem::path& csv, double indenter_radius_m, ProbingReport& report) {
    const std::string file = csv.string();
    std::vector<double> offsets_N;
    auto points = read_points(csv, report, offsets_N);
    report.points = points.size();
    report.median_offset_N = median(offsets_N);
    std::vector<double> greatest_m;
    std::vector<double> steps;
    for (const auto& [id, p] : points) {
        if (p.depth_m.size() < 2) {
            ++report.rejected_points;
            continue;
        }
        greatest_m.push_back(p.depth_m.back());
        steps.push_back(static_cast<double>(p.depth_m.size() - 1));
    }
    if (greatest_m.empty()) throw bad_input(file, "", "no point with two depths or more", "probing at several depths");

    Map map;
    map.name = csv.stem().string();
    const Axis x = find_axis(points, false, file);
    const Axis y = find_axis(points, true, file);
    map.origin_m[0] = x.origin_m;
    map.origin_m[1] = y.origin_m;
    map.spacing_m[0] = x.pitch_m;
    map.spacing_m[1] = y.pitch_m;
    map.n_x = x.n;
    map.n_y = y.n;
    const auto n_depths = static_cast<std::size_t>(median(steps));
    const double step_m = median(greatest_m) / static_cast<double>(n_depths);
    for (std::size_t k = 1; k <= n_depths; ++k) map.depths_m.push_back(step_m * static_cast<double>(k));

    constexpr std::size_t kMostValues = 20'000'000;
    if (map.n_cells() > kMostValues / map.n_depths()) {
        throw bad_input(file, "", std::to_string(map.n_x) + " x " + std::to_string(map.n_y) + " cells of " +
                                      short_number(1e3 * x.pitch_m) + " x " + short_number(1e3 * y.pitch_m) + " mm",
                        "a grid of at most 20 million forces (is a position far off the others?)");
    }
    std::vector<double> deepest_N;
    for (const auto& [id, p] : points) {
        if (p.depth_m.size() >= 2) deepest_N.push_back(p.force_N.back());
    }
    if (!(median(deepest_N) > 0.0)) {
        throw bad_input(file, "fn_N", short_number(median(deepest_N)) + " N at the greatest depths (median, less the force at contact)",
                        "forces that rise with depth (is the sign the other way round?)");
    }
    map.normal_N.assign(map.n_depths() * map.n_cells(), std::numeric_limits<float>::quiet_NaN());
    std::vector<bool> taken(map.n_cells(), false);
    for (const auto& [id, p] : points) {
        if (p.depth_m.size() < 2) continue;
        const std::size_t cell = index_on(y, p.y_m, "ref_y_mm", p, file) * map.n_x + index_on(x, p.x_m, "ref_x_mm", p, file);
        if (taken[cell]) throw bad_input(file, "line " + std::to_string(p.line), "a second point in one cell", "one");
        taken[cell] = true;
        for (std::size_t k = 0; k < n_depths; ++k) {
            map.normal_N[k * map.n_cells() + cell] = static_cast<float>(force_at(p, map.depths_m[k], step_m));
        }
    }
    report.missing_cells = static_cast<std::size_t>(std::count(taken.begin(), taken.end(), false));
    map.tangential = TangentialKind::none;
    map.indenter = IndenterShape::sphere;
    map.indenter_radius_m = indenter_radius_m;
    map.source.kind = SourceKind::recorded;
    map.source.how = "point-wise probing; grid from the commanded positions; force at contact subtracted point by "
                     "point (median " + short_number(report.median_offset_N) + " N); linear between a point's own depths";
    map.source.from = csv.filename().string();
    map.source.licence = "that of the recording";
    check_map(map, file);
    measure_residuals(map, points, report);
    return map;
}

}  // namespace palpa
