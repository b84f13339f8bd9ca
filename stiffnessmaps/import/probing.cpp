#include "stiffnessmaps/import/probing.h"

#include <Eigen/Dense>
#include <algorithm>
#include <cmath>
#include <limits>
#include <malloc.h>
#include <numbers>
#include <unordered_map>

#include "files/input_error.h"
#include "files/table.h"
#include "files/text.h"
#include "stiffnessmaps/grid.h"
#include "stiffnessmaps/import/choices.h"
#include "stiffnessmaps/import/columns.h"
#include "stiffnessmaps/import/finish.h"
#include "stiffnessmaps/import/gridding.h"
#include "stiffnessmaps/import/probing_curve.h"
#include "stiffnessmaps/import/robust.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr double kOffCommand_m = 1e-3;
constexpr double kSamePlace_m = 0.2e-3;

// Finds the place that a row belongs to, or adds it.
class Places {
  public:
    explicit Places(std::vector<ProbedPoint>& points) : points_(points) {}

    ProbedPoint& of_number(const files::Table& table, std::size_t column, std::size_t line, double x_m, double y_m,
                           std::size_t x_column) {
        const double id = table.finite_number(column);
        if (id != std::floor(id) || std::abs(id) > 1e9) table.fail(column, "a whole number");
        const auto [it, is_new] = by_number_.try_emplace(static_cast<std::int64_t>(id), points_.size());
        if (is_new) return add(x_m, y_m, line);
        ProbedPoint& point = points_[it->second];
        if (x_m != point.x_m || y_m != point.y_m) {
            table.fail(x_column, "the position of line " + std::to_string(point.line) + " for the same point");
        }
        return point;
    }

    ProbedPoint& near(double x_m, double y_m, std::size_t line) {
        const auto same = [&](const ProbedPoint& p) { return std::hypot(p.x_m - x_m, p.y_m - y_m) <= kSamePlace_m; };
        if (!points_.empty() && same(points_.back())) return points_.back();
        for (std::int64_t b = -1; b <= 1; ++b) {
            for (std::int64_t a = -1; a <= 1; ++a) {
                const auto [from, to] = by_square_.equal_range(square(x_m, a, y_m, b));
                for (auto it = from; it != to; ++it) {
                    if (same(points_[it->second])) return points_[it->second];
                }
            }
        }
        by_square_.emplace(square(x_m, 0, y_m, 0), points_.size());
        return add(x_m, y_m, line);
    }

  private:
    static std::int64_t square(double x_m, std::int64_t a, double y_m, std::int64_t b) {
        constexpr double kFar = 1e9;
        const auto i = static_cast<std::int64_t>(std::clamp(std::floor(x_m / kSamePlace_m), -kFar, kFar)) + a;
        const auto j = static_cast<std::int64_t>(std::clamp(std::floor(y_m / kSamePlace_m), -kFar, kFar)) + b;
        return i * 4'000'000'007 + j;
    }
    ProbedPoint& add(double x_m, double y_m, std::size_t line) {
        if (!points_.empty()) {  // that place is usually complete by now
            points_.back().depth_m.shrink_to_fit();
            points_.back().force_N.shrink_to_fit();
        }
        points_.emplace_back();
        points_.back().x_m = x_m;
        points_.back().y_m = y_m;
        points_.back().line = line;
        return points_.back();
    }
    std::vector<ProbedPoint>& points_;
    std::unordered_map<std::int64_t, std::size_t> by_number_;
    std::unordered_multimap<std::int64_t, std::size_t> by_square_;
};

// Returns the force along the surface's normal: as recorded, by the recorded normal, or along z.
double normal_force(const files::Table& table, const Columns& columns) {
    if (columns.has(Role::normal_force)) return value_of(table, columns, Role::normal_force);
    if (!columns.has(Role::normal_z)) return value_of(table, columns, Role::force_z);
    return value_of(table, columns, Role::force_x) * value_of(table, columns, Role::normal_x) +
           value_of(table, columns, Role::force_y) * value_of(table, columns, Role::normal_y) +
           value_of(table, columns, Role::force_z) * value_of(table, columns, Role::normal_z);
}

// Follows how a place is released, and how far the tool then comes back towards the greatest depth.
void follow_release(double depth_m, ProbedPoint& p) {
    if (p.depth_m.empty()) return;
    const double greatest_m = p.depth_m.back();
    p.lifted_to_m = std::min(p.lifted_to_m, depth_m);
    p.risen_m = std::max(p.risen_m, std::min(depth_m, greatest_m) - p.lifted_to_m);
    if (depth_m > greatest_m) p.lifted_to_m = depth_m;
}

void note_pressed_again(const std::vector<ProbedPoint>& points, ImportReport& report) {
    const auto again = [](const ProbedPoint& p) {  // noise does not come back by half the press
        return !p.depth_m.empty() && p.risen_m > 0.5 * (p.depth_m.back() - p.depth_m.front());
    };
    const auto first = std::find_if(points.begin(), points.end(), again);
    if (first == points.end()) return;
    report.notes.push_back(std::to_string(std::count_if(first, points.end(), again)) + " of " +
                           std::to_string(points.size()) +
                           " points were pressed more than once (the first of them begins at line " +
                           std::to_string(first->line) + "): the first press counts, and of later ones what is deeper");
}

void need_columns(const Columns& columns, const files::Table& table) {
    need(columns, table, {Role::x, Role::y});
    if (!columns.has(Role::depth) && !columns.has(Role::z)) need(columns, table, {Role::depth});
    if (columns.has(Role::normal_force)) return;
    if (!columns.has(Role::force_z)) need(columns, table, {Role::normal_force});
    if (columns.has(Role::normal_z))
        need(columns, table, {Role::normal_x, Role::normal_y, Role::force_x, Role::force_y});
}

}  // namespace

Probing read_probing(files::Table& table, const Columns& columns, const ImportOptions& options, ImportReport& report) {
    need_columns(columns, table);
    Probing probing;
    probing.depth_from_z = !columns.has(Role::depth);
    const bool lateral = probing.depth_from_z && options.remove_tilt && !columns.has(Role::normal_force) &&
                         columns.has(Role::force_x) && columns.has(Role::force_y);
    const double sign = options.negate_force ? -1.0 : 1.0;
    Places places(probing.points);
    std::size_t not_numbers = 0;
    constexpr double kFar_m = std::numeric_limits<double>::infinity();
    std::array<double, 4> extent_m{kFar_m, -kFar_m, kFar_m, -kFar_m};
    std::vector<double> all_depths_m;  // of a part of the rows, to see whether the unit is plausible
    std::vector<double> all_forces_N;
    while (table.next()) {
        ++report.rows;
        if ((report.rows & 0xffff) == 0 && options.progress) options.progress("reading", table.done());
        const double x_m = value_of(table, columns, Role::x);
        const double y_m = value_of(table, columns, Role::y);
        if (std::isnan(x_m) || std::isnan(y_m)) {
            ++not_numbers;
            continue;
        }
        if (!inside_region(options.region_m, x_m, y_m)) continue;
        extent_m = {std::min(extent_m[0], x_m), std::max(extent_m[1], x_m), std::min(extent_m[2], y_m),
                    std::max(extent_m[3], y_m)};
        ProbedPoint& p = columns.has(Role::point) ? places.of_number(table, columns[Role::point].index, table.line(),
                                                                     x_m, y_m, columns[Role::x].index)
                                                  : places.near(x_m, y_m, table.line());
        const double depth_m =
            probing.depth_from_z ? -value_of(table, columns, Role::z) : value_of(table, columns, Role::depth);
        const double force_N = sign * normal_force(table, columns);
        if (std::isnan(depth_m) || std::isnan(force_N)) {
            ++not_numbers;
            continue;
        }
        if (all_depths_m.size() < 1000 || report.rows % 64 == 0) {
            all_depths_m.push_back(std::abs(depth_m));
            all_forces_N.push_back(std::abs(force_N));
        }
        const double off_m =
            columns.has(Role::commanded_depth) ? depth_m - value_of(table, columns, Role::commanded_depth) : 0.0;
        follow_release(depth_m, p);
        const bool moved_on = p.depth_m.empty() || depth_m > p.depth_m.back();
        if (!moved_on || !(std::abs(off_m) < kOffCommand_m)) {
            ++report.rejected_rows;
            continue;
        }
        p.depth_m.push_back(depth_m);
        p.force_N.push_back(force_N);
        if (!lateral) continue;
        p.lateral_N[0].push_back(sign * value_of(table, columns, Role::force_x));
        p.lateral_N[1].push_back(sign * value_of(table, columns, Role::force_y));
    }
    // Of a press and its release about half the rows go; where many more do, they are hardly in the order of pressing.
    if (10 * report.rejected_rows > 6 * report.rows) {
        report.notes.push_back(
            std::to_string(report.rejected_rows) + " of " + std::to_string(report.rows) +
            " rows are no deeper than an earlier row of their point, or far from the commanded depth, "
            "and were left out: are the rows in the order in which the points were pressed?");
    } else {
        note_pressed_again(probing.points, report);
    }
    report.rejected_rows += not_numbers;
    if (probing.points.empty() || not_numbers == report.rows) {
        throw files::bad_input(table.file(), "",
                               report.rows == 0   ? "no rows"
                               : options.region_m ? "no row with numbers in the region"
                                                  : "no row with numbers",
                               "probing at several depths");
    }
    constexpr double kNearlyAll = 0.99;  // so that a single wild row does not suggest another unit
    if (!probing.depth_from_z) check_depth_size(quantile(all_depths_m, kNearlyAll), options, table.file());
    check_force_size(quantile(all_forces_N, kNearlyAll), columns, options, table.file());
    check_length_size(std::max(extent_m[1] - extent_m[0], extent_m[3] - extent_m[2]), options, table.file());
    return probing;
}

namespace {

struct GridChoice {
    GridPlan plan;
    bool on_grid = true;
};

std::string at_line(const ProbedPoint& p) { return "line " + std::to_string(p.line); }

void refuse_off_grid(const Probing& probing, const GridAxis& axis, bool along_y, const std::string& file) {
    for (const ProbedPoint& p : probing.points) {
        const double place_m = along_y ? p.y_m : p.x_m;
        if (index_on(axis, place_m)) continue;
        throw files::bad_input(file, at_line(p) + (along_y ? ", y" : ", x"), files::short_number(1e3 * place_m) + " mm",
                               "a position on the regular grid of " + files::short_number(1e3 * axis.pitch_m) +
                                   " mm that the other points lie on (scattered points: --grid plane)");
    }
}

// Chooses the grid that the places lie on, or one for scattered places. Throws InputError if they form two grids.
GridChoice choose_grid(const Probing& probing, const ImportOptions& options, const std::string& file) {
    std::vector<double> x_m;
    std::vector<double> y_m;
    for (const ProbedPoint& p : probing.points) {
        x_m.push_back(p.x_m);
        y_m.push_back(p.y_m);
    }
    const double near_m = neighbour_distance_m(x_m, y_m);
    if (const std::size_t groups = group_count(x_m, y_m, 3.0 * near_m); groups > 1 && !options.gridding) {
        throw files::bad_input(
            file, "", std::to_string(groups) + " groups of points far from each other: two grids in one file?",
            "one; choose by --region-mm X0,X1,Y0,Y1, or take all as one by --grid plane (or on-grid)");
    }
    GridChoice choice;
    constexpr double kSame_m = 1e-5, kJitter = 0.2;  // of measured places, up to a tenth to each side
    const double same_m = std::max(kSame_m, kJitter * near_m);
    const auto x = fit_axis(x_m, same_m);
    const auto y = fit_axis(y_m, same_m);
    const std::size_t n = probing.points.size();
    const bool sparse =
        !x || !y ||
        static_cast<double>(x->axis.n) * static_cast<double>(y->axis.n) > 20.0 * static_cast<double>(n) + 100.0;
    const bool scattered = sparse || 2 * (x->off + y->off) > n;
    const bool asked_on_grid = options.gridding == Gridding::on_grid;
    choice.on_grid = asked_on_grid || (!options.gridding && !options.pitch_m && !scattered);
    if (choice.on_grid) {
        if (!x || !y)
            throw files::bad_input(file, "", "positions all over the place",
                                   "a regular grid (scattered points: --grid plane)");
        refuse_off_grid(probing, x->axis, false, file);
        refuse_off_grid(probing, y->axis, true, file);
        choice.plan.x = x->axis;
        choice.plan.y = y->axis;
        choice.plan.method = Gridding::on_grid;
        return choice;
    }
    const double pitch_m = options.pitch_m.value_or(std::max(near_m, 1e-6));
    const auto [x_low, x_high] = std::minmax_element(x_m.begin(), x_m.end());
    const auto [y_low, y_high] = std::minmax_element(y_m.begin(), y_m.end());
    choice.plan.x = covering_axis(*x_low, *x_high, pitch_m);
    choice.plan.y = covering_axis(*y_low, *y_high, pitch_m);
    choice.plan.method = options.gridding.value_or(Gridding::plane);
    choice.plan.radius_m = options.radius_m.value_or(std::max(1.5 * near_m, pitch_m));
    return choice;
}

void fill_on_grid(const Probing& probing, const GridPlan& plan, Map& map, const std::string& file) {
    map.normal_N.assign(map.n_depths() * map.n_cells(), kMissing);
    std::vector<std::size_t> line(map.n_cells(), 0);
    for (const ProbedPoint& p : probing.points) {
        const std::size_t cell = *index_on(plan.y, p.y_m) * map.n_x + *index_on(plan.x, p.x_m);
        if (line[cell] != 0) {
            throw files::bad_input(
                file, at_line(p),
                "a second point in the cell of line " + std::to_string(line[cell]) + ": two grids in one file?",
                "one point in one cell (to take all together: --grid plane, median or inverse-distance)");
        }
        line[cell] = p.line;
        for (std::size_t k = 0; k < map.n_depths(); ++k) {
            map.normal_N[k * map.n_cells() + cell] =
                static_cast<float>(force_at(p, map.depths_m[k], map.depths_m.front()));
        }
    }
}

void fill_scattered(const Probing& probing, const GridPlan& plan, Map& map, const std::string& file) {
    Samples samples;
    for (const ProbedPoint& p : probing.points) {
        for (const double depth_m : map.depths_m) {
            const double force_N = force_at(p, depth_m, map.depths_m.front());
            if (std::isnan(force_N)) continue;
            samples.x_m.push_back(p.x_m);
            samples.y_m.push_back(p.y_m);
            samples.depth_m.push_back(depth_m);
            samples.force_N.push_back(force_N);
        }
    }
    check_enough_samples(plan, samples.size(), file);
    map.normal_N = grid_samples(samples, plan).normal_N;
}

void note_grid(const GridPlan& plan, bool on_grid, const ImportOptions& options, MapSource& source) {
    add_choice(source, "grid", on_grid ? "on-grid" : name_of(plan.method),
               on_grid           ? "the points lie on a regular grid"
               : options.pitch_m ? "a pitch was asked for"
                                 : "the points lie on no regular grid",
               "--grid", options.gridding.has_value());
    const std::vector<double> pitch_mm = choice_mm({plan.x.pitch_m, plan.y.pitch_m});
    if (on_grid) {
        add_choice(source, "pitch_mm", pitch_mm, "step between the places", "--pitch-mm");
        return;
    }
    add_choice(source, "pitch_mm", pitch_mm, "median distance to the nearest point", "--pitch-mm",
               options.pitch_m.has_value());
    add_choice(source, "radius_mm", choice_mm(plan.radius_m), "1.5 times the distance to the nearest point",
               "--radius-mm", options.radius_m.has_value());
}

// The depths that all points have, if their steps differ: equal ones would lie between them. Empty if there are none such.
std::vector<double> unequal_depths_of_all(const Probing& probing) {
    constexpr double kSame_m = 1e-9, kStepDiffers_m = 1e-6;
    constexpr std::size_t kMostLayers = 100;
    std::vector<double> depths_m = probing.points.front().depth_m;
    for (const ProbedPoint& p : probing.points) {
        const auto same = [](double a, double b) { return std::abs(a - b) < kSame_m; };
        if (!std::equal(depths_m.begin(), depths_m.end(), p.depth_m.begin(), p.depth_m.end(), same)) return {};
    }
    std::erase_if(depths_m, [](double depth_m) { return depth_m <= kSame_m; });
    if (depths_m.empty() || depths_m.size() > kMostLayers) return {};
    const double step_m = depths_m.back() / static_cast<double>(depths_m.size());
    for (std::size_t k = 0; k < depths_m.size(); ++k) {
        if (std::abs(depths_m[k] - step_m * static_cast<double>(k + 1)) > kStepDiffers_m) return depths_m;
    }
    return {};
}

std::vector<double> choose_depths(const Probing& probing, const ImportOptions& options, MapSource& source) {
    if (!options.depths_m.empty()) {
        add_choice(source, "depths_mm", choice_mm(options.depths_m), "", "--depths-mm", true);
        return options.depths_m;
    }
    if (const std::vector<double> shared_m = unequal_depths_of_all(probing); !shared_m.empty() && !options.layers) {
        add_choice(source, "depths_mm", choice_mm(shared_m), "the depths of all points", "--depths-mm");
        return shared_m;
    }
    std::vector<double> greatest_m;
    std::vector<double> steps;
    for (const ProbedPoint& p : probing.points) {
        greatest_m.push_back(p.depth_m.back());
        steps.push_back(static_cast<double>(p.depth_m.size() - 1));
    }
    constexpr double kMostLayers = 100.0;
    const std::size_t n = options.layers ? static_cast<std::size_t>(*options.layers)
                                         : static_cast<std::size_t>(std::min(median(steps), kMostLayers));
    const double step_m = median(greatest_m) / static_cast<double>(n);
    std::vector<double> depths_m;
    for (std::size_t k = 1; k <= n; ++k) depths_m.push_back(step_m * static_cast<double>(k));
    add_choice(source, "layers", static_cast<double>(n), "the points' median number of steps", "--layers",
               options.layers.has_value());
    add_choice(source, "depths_mm", choice_mm(depths_m), "equal steps to the points' median greatest depth",
               "--depths-mm");
    return depths_m;
}

}  // namespace

Map map_of_probing(Probing& probing, const ImportOptions& options, const std::string& file, ImportReport& report) {
    Map map;
    MapSource& source = map.source;
    report.points = probing.points.size();
    const std::size_t before = probing.points.size();
    std::erase_if(probing.points, [](const ProbedPoint& p) { return p.depth_m.size() < 2; });
    if (probing.points.empty()) {
        throw files::bad_input(file, "", "no point with two depths or more",
                               "probing at several depths (if the tip presses towards +z: --column depth=NAME)");
    }
    clean_curves(probing, options, file, source, report);
    report.rejected_points = before - probing.points.size();
    if (probing.points.empty())
        throw files::bad_input(
            file, "", "no point with two depths in contact",
            "forces that rise with depth (is the sign the other way round? with --negate-force, or without)");

    const GridChoice grid = choose_grid(probing, options, file);
    note_grid(grid.plan, grid.on_grid, options, source);
    GridPlan plan = grid.plan;
    plan.depths_m = choose_depths(probing, options, source);
    check_grid(plan.x, plan.y, plan.depths_m.size(), file);
    start_map(plan, map);
    if (grid.on_grid) {
        fill_on_grid(probing, plan, map, file);
    } else {
        fill_scattered(probing, plan, map, file);
    }
    source.how = "point-wise probing; ";
    source.how += grid.on_grid ? "on the grid of its places"
                               : "scattered places brought onto a grid by " + std::string(name_of(plan.method));
    source.how += "; force at contact, or in the air before it, subtracted point by point (median " +
                  files::short_number(report.median_offset_N) + " N); linear between a point's own depths";

    RecordedPoints recorded;
    std::size_t n_recorded = 0;
    for (const ProbedPoint& p : probing.points) n_recorded += p.depth_m.size() - 1;
    recorded.reserve(n_recorded);
    for (const ProbedPoint& p : probing.points) {
        for (std::size_t i = 1; i < p.depth_m.size(); ++i) recorded.add(p.x_m, p.y_m, p.depth_m[i], p.force_N[i]);
    }
    probing = {};  // most of the memory, in small pieces that the allocator would keep
    ::malloc_trim(0);
    finish_map(map, recorded, false, options, file, report);
    return map;
}

}  // namespace palpa::stiffnessmaps
