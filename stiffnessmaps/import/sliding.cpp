#include "stiffnessmaps/import/sliding.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <limits>
#include <set>

#include "files/input_error.h"
#include "files/text.h"
#include "stiffnessmaps/import/choices.h"
#include "stiffnessmaps/import/columns.h"
#include "stiffnessmaps/import/robust.h"
#include "stiffnessmaps/import/sliding_tangential.h"

namespace palpa::stiffnessmaps {
namespace {

constexpr double kLeastPitch_m = 0.5e-3;

struct Bounds2 {
    double low[2] = {std::numeric_limits<double>::infinity(), std::numeric_limits<double>::infinity()};
    double high[2] = {-low[0], -low[1]};
};

Bounds2 bounds_of(const SurfaceSamples& s) {
    Bounds2 b;
    for (std::size_t i = 0; i < s.size(); ++i) {
        b.low[0] = std::min(b.low[0], s.x_m[i]);
        b.high[0] = std::max(b.high[0], s.x_m[i]);
        b.low[1] = std::min(b.low[1], s.y_m[i]);
        b.high[1] = std::max(b.high[1], s.y_m[i]);
    }
    return b;
}

double length_of_path(const SurfaceSamples& s) {
    double length_m = 0.0;
    for (std::size_t i = 1; i < s.size(); ++i) length_m += std::hypot(s.x_m[i] - s.x_m[i - 1], s.y_m[i] - s.y_m[i - 1]);
    return length_m;
}

// Returns the area of the 2 mm squares that the tool passed.
double covered_area(const SurfaceSamples& s, const Bounds2& b) {
    constexpr double kSquare_m = 2e-3;
    std::vector<std::uint64_t> squares;
    std::uint64_t last = ~std::uint64_t{0};
    for (std::size_t i = 0; i < s.size(); ++i) {
        const auto u = static_cast<std::uint64_t>((s.x_m[i] - b.low[0]) / kSquare_m);
        const auto v = static_cast<std::uint64_t>((s.y_m[i] - b.low[1]) / kSquare_m);
        const std::uint64_t square = (u << 32) | v;
        if (square != last) squares.push_back(square);
        last = square;
    }
    std::sort(squares.begin(), squares.end());
    squares.erase(std::unique(squares.begin(), squares.end()), squares.end());
    return kSquare_m * kSquare_m * static_cast<double>(squares.size());
}

// Returns a pitch that gives two passes per cell and some four samples per cell and layer (of 8), in steps of half a
// millimetre.
double default_pitch_m(const SurfaceSamples& s, const Bounds2& bounds) {
    constexpr double kSamplesInCell = 32.0;
    const double area = covered_area(s, bounds);
    const double passes_m = 2.0 * area / std::max(length_of_path(s), 1e-9);
    const double samples_m = std::sqrt(kSamplesInCell * area / static_cast<double>(s.size()));
    return std::max(kLeastPitch_m, std::round(std::max(passes_m, samples_m) / kLeastPitch_m) * kLeastPitch_m);
}

void check_sizes(const Sliding& sliding, const Columns& columns, const ImportOptions& options,
                 const std::string& file) {
    const SurfaceSamples& s = sliding.samples;
    std::vector<double> forces_N;
    const std::size_t step = 1 + s.size() / 20000;
    for (std::size_t i = 0; i < s.size(); i += step) {
        double sum = 0.0;
        for (const auto& component : s.force_N)
            sum += static_cast<double>(component[i]) * static_cast<double>(component[i]);
        forces_N.push_back(sliding.normal_N.empty() ? std::sqrt(sum)
                                                    : std::abs(static_cast<double>(sliding.normal_N[i])));
    }
    check_force_size(quantile(std::move(forces_N), 0.99), columns, options, file);
    const Bounds2 b = bounds_of(s);
    check_length_size(std::max(b.high[0] - b.low[0], b.high[1] - b.low[1]), options, file);
}

}  // namespace

void read_sliding(files::Table& table, const Columns& columns, const ImportOptions& options, double at_depth_m,
                  Sliding& sliding, ImportReport& report) {
    need(columns, table, {Role::time, Role::x, Role::y});
    const bool has_depth = columns.has(Role::depth) || at_depth_m > 0.0;
    if (!has_depth) need(columns, table, {Role::z});
    const bool has_normal = columns.has(Role::normal_force) && has_depth;
    if (!has_normal) need(columns, table, {Role::force_z});
    const bool has_lateral = columns.has(Role::force_x) && columns.has(Role::force_y);
    if (!has_depth && !has_lateral) need(columns, table, {Role::force_x, Role::force_y});
    SurfaceSamples& s = sliding.samples;
    if (s.size() > 0 && (has_depth == sliding.depth_m.empty() || has_normal == sliding.normal_N.empty())) {
        throw files::bad_input(table.file(), "line 1", "other columns than in the file before it",
                               "the same in all files");
    }
    const double sign = options.negate_force ? -1.0 : 1.0;
    const auto force = [&](Role role) {
        return columns.has(role) ? static_cast<float>(sign * value_of(table, columns, role)) : 0.0f;
    };
    std::size_t used = 0;
    double last_s = -std::numeric_limits<double>::infinity();
    while (table.next()) {
        ++report.rows;
        if ((report.rows & 0xffff) == 0 && options.progress) options.progress("reading", table.done());
        const double t_s = value_of(table, columns, Role::time);
        if (t_s < last_s) {
            table.fail(columns[Role::time].index, "a time that is not before the last row's, " +
                                                      files::number_text(last_s) + " s (two recordings in one file?)");
        }
        const double x_m = value_of(table, columns, Role::x);
        const double y_m = value_of(table, columns, Role::y);
        const double z_m = columns.has(Role::z) ? value_of(table, columns, Role::z) : 0.0;
        const double depth_m = at_depth_m > 0.0           ? at_depth_m
                               : columns.has(Role::depth) ? value_of(table, columns, Role::depth)
                                                          : 0.0;
        const float f[4] = {force(Role::force_x), force(Role::force_y), force(Role::force_z),
                            force(Role::normal_force)};
        const double sum = t_s + x_m + y_m + z_m + depth_m + static_cast<double>(f[0] + f[1] + f[2] + f[3]);
        if (!std::isfinite(sum)) {
            ++report.rejected_rows;
            continue;
        }
        last_s = t_s;
        if (!inside_region(options.region_m, x_m, y_m)) continue;
        ++used;
        sliding.time_s.push_back(t_s);
        s.x_m.push_back(x_m);
        s.y_m.push_back(y_m);
        s.z_m.push_back(z_m);
        for (std::size_t a = 0; a < 3; ++a) s.force_N[a].push_back(f[a]);
        if (has_depth) sliding.depth_m.push_back(static_cast<float>(depth_m));
        if (has_normal) sliding.normal_N.push_back(f[3]);
    }
    if (used < 16) {
        throw files::bad_input(table.file(), "",
                               std::to_string(used) + " rows with numbers" + (options.region_m ? " in the region" : ""),
                               "a recording of at least 16");
    }
    check_sizes(sliding, columns, options, table.file());
}

namespace {

void take_surface(Sliding& sliding, const ImportOptions& options, double pitch_m, const std::string& file,
                  Surface& surface, MapSource& source) {
    if (!sliding.depth_m.empty()) {
        add_choice(source, "surface", "recorded", "the recording has depths", "--at-depth-mm",
                   !options.at_depths_m.empty());
        return;
    }
    if (options.surface_z_m) {
        surface.n_x = surface.n_y = 1;
        surface.height_m = {*options.surface_z_m};
        add_choice(source, "surface_z_mm", choice_mm(*options.surface_z_m), "", "--surface-z-mm", true);
        return;
    }
    if (options.progress) options.progress("estimating the surface", 0.0);
    surface = fit_surface(sliding.samples, options.surface_node_m.value_or(pitch_m), file);
    add_choice(source, "surface", "estimated",
               "height and compliance of the tissue fitted to where the tool was at which force",
               "--surface-z-mm, --at-depth-mm");
    add_choice(source, "surface_node_mm", choice_mm(surface.node_m),
               "the map's pitch, or as fine as 4000 nodes and 8 samples a node allow", "--surface-node-mm",
               options.surface_node_m.has_value());
    add_choice(source, "surface_deviation_mm", choice_mm(surface.deviation_m), "of the samples' heights from that fit",
               "");
    add_choice(source, "surface_exponent", surface.exponent,
               "depth as force to this power: 1 or 2/3, or another from 1 to 0.5 that left 4 % less", "");
    add_choice(
        source, "surface_tilt_deg", std::round(1e3 * surface.tilt_deg) / 1e3,
        options.remove_tilt ? "depth and force are along the surface's normal" : "kept: depth and force are along z",
        "--tilt", !options.remove_tilt);
}

// Returns the depths that the recording kept to: groups of depths with gaps between them. Empty if it kept to none.
std::vector<double> kept_depths(const std::vector<double>& depth_m) {
    std::vector<double> some;
    const std::size_t step = 1 + depth_m.size() / 50000;
    for (std::size_t i = 0; i < depth_m.size(); i += step) {
        if (depth_m[i] > 0.0) some.push_back(depth_m[i]);
    }
    std::sort(some.begin(), some.end());
    constexpr double kGap_m = 0.2e-3;
    std::vector<double> out;
    for (std::size_t i = 0; i < some.size();) {
        std::size_t end = i + 1;
        while (end < some.size() && some[end] - some[end - 1] < kGap_m) ++end;
        const bool narrow = some[end - 1] - some[i] < 0.4e-3;
        const bool rare = (end - i) * 100 < some.size();  // between one depth and the next
        if (!rare && !narrow) return {};
        if (!rare) out.push_back(some[(i + end) / 2]);
        i = end;
    }
    return out.size() <= 30 ? out : std::vector<double>{};
}

std::vector<double> choose_depths(const Samples& samples, const ImportOptions& options, MapSource& source) {
    if (!options.depths_m.empty()) {
        add_choice(source, "depths_mm", choice_mm(options.depths_m), "", "--depths-mm", true);
        return options.depths_m;
    }
    std::vector<double> depths_m;
    if (!options.layers) {
        const std::set<double> stated(options.at_depths_m.begin(), options.at_depths_m.end());
        depths_m = stated.empty() ? kept_depths(samples.depth_m) : std::vector<double>(stated.begin(), stated.end());
    }
    if (!depths_m.empty()) {
        add_choice(source, "depths_mm", choice_mm(depths_m), "the depths that the tool kept to",
                   "--depths-mm, --layers", !options.at_depths_m.empty());
        return depths_m;
    }
    constexpr int kLayers = 8;
    const int n = options.layers.value_or(kLayers);
    constexpr double kNearlyAll = 0.9;
    const double greatest_m = quantile(samples.depth_m, kNearlyAll);
    const double least_m = quantile(samples.depth_m, 1.0 - kNearlyAll);
    constexpr double kHardlyAny = 0.02;  // a layer of fewer samples is empty nearly everywhere
    const bool shallow = quantile(samples.depth_m, kHardlyAny) <= greatest_m / n;
    for (int k = 1; k <= n; ++k) {
        depths_m.push_back(shallow || n == 1 ? greatest_m * k / n
                                             : least_m + (greatest_m - least_m) * (k - 1) / (n - 1));
    }
    add_choice(source, "layers", static_cast<double>(n), "enough for a curve", "--layers", options.layers.has_value());
    add_choice(source, "depths_mm", choice_mm(depths_m),
               shallow ? "equal steps to the depth that 90 % of the samples do not exceed"
                       : "the recording hardly reaches the first of equal steps from the surface: equal steps between "
                         "the depths that 10 and 90 % of "
                         "the samples do not exceed",
               "--depths-mm");
    return depths_m;
}

constexpr double kOutliers = 20.0;

Samples indentations(const Sliding& sliding, const Surface& surface, const ImportOptions& options) {
    const SurfaceSamples& s = sliding.samples;
    Samples out;
    out.x_m = s.x_m;
    out.y_m = s.y_m;
    out.depth_m.resize(s.size());
    out.force_N.resize(s.size());
    for (std::size_t i = 0; i < s.size(); ++i) {
        Indentation in;
        if (!sliding.depth_m.empty()) {
            in.depth_m = static_cast<double>(sliding.depth_m[i]);
            in.force_N = static_cast<double>(sliding.normal_N.empty() ? s.force_N[2][i] : sliding.normal_N[i]);
        } else if (options.remove_tilt) {
            in = indentation_of(surface, s, i);
        } else {
            in.depth_m = surface_at(surface, s.x_m[i], s.y_m[i]).height_m - s.z_m[i];
            in.force_N = static_cast<double>(s.force_N[2][i]);
        }
        out.depth_m[i] = in.depth_m;
        out.force_N[i] = in.force_N;
    }
    return out;
}

std::vector<bool> outliers(const std::vector<double>& force_N, double deviations) {
    if (deviations <= 0.0) return std::vector<bool>(force_N.size(), false);
    std::vector<double> differences;
    const std::size_t part = 1000;  // some stretches suffice to estimate the noise
    const std::size_t step = part * (1 + force_N.size() / 100'000);
    for (std::size_t i = 0; i < force_N.size(); i += step) {
        const auto from = force_N.begin() + static_cast<std::ptrdiff_t>(i);
        add_fourth_differences({from, from + static_cast<std::ptrdiff_t>(std::min(part, force_N.size() - i))},
                               differences);
    }
    const double least_N = 1e-3 * quantile(force_N, 0.95);  // a sensor that counts in steps may show no noise
    return lone_outliers(force_N, deviations * std::max(noise_of_fourth_differences(std::move(differences)), least_N));
}

// Keeps, in place, only samples below the surface that are no outliers.
void drop_out_of_contact(const std::vector<bool>& outlier, Samples& samples) {
    std::size_t n = 0;
    for (std::size_t i = 0; i < samples.size(); ++i) {
        if (outlier[i] || !(samples.depth_m[i] > 0.0)) continue;
        samples.x_m[n] = samples.x_m[i];
        samples.y_m[n] = samples.y_m[i];
        samples.depth_m[n] = samples.depth_m[i];
        samples.force_N[n] = samples.force_N[i];
        for (auto* tangential : {&samples.tangential_x_N, &samples.tangential_y_N}) {
            if (!tangential->empty()) (*tangential)[n] = (*tangential)[i];
        }
        ++n;
    }
    for (auto* values : {&samples.x_m, &samples.y_m, &samples.depth_m, &samples.force_N}) values->resize(n);
    for (auto* tangential : {&samples.tangential_x_N, &samples.tangential_y_N}) {
        if (!tangential->empty()) tangential->resize(n);
    }
}

}  // namespace

Map map_of_sliding(Sliding& sliding, const ImportOptions& options, const std::string& file, ImportReport& report) {
    Map map;
    MapSource& source = map.source;
    const SurfaceSamples& s = sliding.samples;
    const Bounds2 bounds = bounds_of(s);
    if (!options.gridding && group_count(s.x_m, s.y_m, 10e-3) > 1) {
        throw files::bad_input(file, "", "groups of samples more than 10 mm from each other: two grids in one file?",
                               "one; choose by --region-mm X0,X1,Y0,Y1, or take all as one by --grid plane");
    }
    const double pitch_m = options.pitch_m.value_or(default_pitch_m(s, bounds));

    Surface surface;
    take_surface(sliding, options, pitch_m, file, surface, source);
    Samples pressed = indentations(sliding, surface, options);
    if (!sliding.depth_m.empty()) check_depth_size(quantile(pressed.depth_m, 0.95), options, file);
    const double deviations = options.outliers.value_or(kOutliers);
    const std::vector<bool> outlier = outliers(pressed.force_N, deviations);
    report.outliers = static_cast<std::size_t>(std::count(outlier.begin(), outlier.end(), true));
    report.rejected_rows += report.outliers;
    add_choice(source, "outliers_deviations", deviations,
               "a single force that far outside the range of the two beside it; " + std::to_string(report.outliers) +
                   " left out",
               "--outliers", options.outliers.has_value());
    const bool measured_tangential = take_tangential(sliding, surface, options, pressed, report);
    drop_out_of_contact(outlier, pressed);
    report.points = pressed.size();
    if (pressed.size() < 16) {
        throw files::bad_input(file, "", std::to_string(pressed.size()) + " samples below the surface",
                               "a tool that presses into the tissue");
    }

    GridPlan plan;
    plan.x = covering_axis(bounds.low[0], bounds.high[0], pitch_m);
    plan.y = covering_axis(bounds.low[1], bounds.high[1], pitch_m);
    plan.method = options.gridding.value_or(Gridding::plane);
    plan.radius_m = options.radius_m.value_or(pitch_m);
    plan.least = 3;
    if (plan.method == Gridding::on_grid)
        throw files::bad_input("--grid", "", "on-grid for a sliding tool", "plane, inverse-distance or median");
    add_choice(source, "grid", name_of(plan.method), "samples of a sliding tool lie on no grid", "--grid",
               options.gridding.has_value());
    add_choice(source, "pitch_mm", choice_mm(pitch_m),
               "two passes a cell and some four samples a cell and layer, by the area covered", "--pitch-mm",
               options.pitch_m.has_value());
    add_choice(source, "radius_mm", choice_mm(plan.radius_m), "the pitch", "--radius-mm", options.radius_m.has_value());
    plan.depths_m = choose_depths(pressed, options, source);
    check_grid(plan.x, plan.y, plan.depths_m.size(), file);
    check_enough_samples(plan, pressed.size(), file);
    start_map(plan, map);
    if (options.progress) options.progress("gridding", 0.0);
    Gridded gridded = grid_samples(pressed, plan);
    map.normal_N = std::move(gridded.normal_N);
    map.tangential_x_N = std::move(gridded.tangential_x_N);
    map.tangential_y_N = std::move(gridded.tangential_y_N);
    source.how = std::string("sliding tool; surface ") +
                 (surface.height_m.empty() ? "recorded"
                  : options.surface_z_m    ? "stated"
                                           : "estimated") +
                 "; samples brought onto a grid by " + name_of(plan.method);

    RecordedPoints recorded;
    recorded.reserve(pressed.size());
    for (std::size_t i = 0; i < pressed.size(); ++i)
        recorded.add(pressed.x_m[i], pressed.y_m[i], pressed.depth_m[i], pressed.force_N[i]);
    recorded.tangential_N[0] = std::move(pressed.tangential_x_N);
    recorded.tangential_N[1] = std::move(pressed.tangential_y_N);
    pressed = {};
    finish_map(map, recorded, measured_tangential, options, file, report);
    return map;
}

}  // namespace palpa::stiffnessmaps
