#include "stiffnessmaps/import/finish.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "files/input_error.h"
#include "files/text.h"
#include "stiffnessmaps/field.h"
#include "stiffnessmaps/grid.h"
#include "stiffnessmaps/import/choices.h"
#include "stiffnessmaps/import/columns.h"
#include "stiffnessmaps/import/robust.h"
#include "stiffnessmaps/map_file.h"
#include "stiffnessmaps/noise.h"

namespace palpa::stiffnessmaps {
namespace {

// Returns the force at the deepest measured layer of every `step`-th cell.
std::vector<double> deepest_forces(const Map& map, std::size_t step) {
    std::vector<double> out;
    for (std::size_t cell = 0; cell < map.n_cells(); cell += step) {
        for (std::size_t k = map.n_depths(); k-- > 0;) {
            const float force = map.normal_N[k * map.n_cells() + cell];
            if (std::isnan(force)) continue;
            out.push_back(static_cast<double>(force));
            break;
        }
    }
    return out;
}

void refuse_no_forces(const Map& map, const std::string& file) {
    std::vector<double> deepest_N = deepest_forces(map, 1 + map.n_cells() / 1'000'000);
    if (deepest_N.empty()) deepest_N = deepest_forces(map, 1);
    if (deepest_N.empty()) {
        throw files::bad_input(file, "",
                               "no force that was measured: all " + std::to_string(map.n_cells()) + " cells are empty",
                               "forces at the map's depths (is the pitch too fine, are the depths too great?)");
    }
    const double typical_N = median(std::move(deepest_N));
    if (typical_N > 0.0) return;
    throw files::bad_input(
        file, "", files::short_number(typical_N) + " N at the greatest depths (median)",
        "forces that rise with depth (is the sign the other way round? with --negate-force, or without)");
}

// Below what was measured, filled forces would stay what they are above: nothing would resist.
void refuse_empty_layers(const Map& map, const RecordedPoints& recorded, const std::string& file) {
    for (std::size_t k = 0; k < map.n_depths(); ++k) {
        const auto layer = map.normal_N.begin() + static_cast<std::ptrdiff_t>(k * map.n_cells());
        if (std::any_of(layer, layer + static_cast<std::ptrdiff_t>(map.n_cells()),
                        [](float force_N) { return std::isfinite(force_N); }))
            continue;
        const auto [least, most] = std::minmax_element(recorded.depth_m.begin(), recorded.depth_m.end());
        const std::string reached = recorded.depth_m.empty()
                                        ? std::string()
                                        : ", from " + files::short_number(1e3 * static_cast<double>(*least)) + " to " +
                                              files::short_number(1e3 * static_cast<double>(*most)) + " mm";
        throw files::bad_input(file, "", "no force " + files::short_number(1e3 * map.depths_m[k]) + " mm deep",
                               "depths that the recording reaches" + reached + " (--depths-mm)");
    }
}

// The sizes that the map has in the end: no unit, scale or formula may have made them what soft tissue is not.
void check_sizes(const Map& map, const ImportOptions& options, const std::string& file) {
    std::vector<double> forces_N;
    const std::size_t step = 1 + map.normal_N.size() / 1'000'000;
    for (std::size_t i = 0; i < map.normal_N.size(); i += step) {
        if (!std::isnan(map.normal_N[i])) forces_N.push_back(std::abs(static_cast<double>(map.normal_N[i])));
    }
    constexpr double kNearlyAll = 0.99;  // so that a single wild number does not suggest another unit
    check_force_size(quantile(std::move(forces_N), kNearlyAll), Columns{}, options, file);
    const double x_m = map.spacing_m[0] * static_cast<double>(map.n_x - 1);
    const double y_m = map.spacing_m[1] * static_cast<double>(map.n_y - 1);
    check_length_size(std::max(x_m, y_m), options, file);
    check_depth_size(map.depths_m.back(), options, file);
}

// Closes the gaps between a cell's measured layers linearly along the cell's own curve.
void close_inner_gaps(const Map& map, std::vector<float>& out) {
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        double from_m = 0.0;
        double from_N = 0.0;
        std::size_t next = 0;
        for (std::size_t k = 0; k < map.n_depths(); ++k) {
            const float force = map.normal_N[k * map.n_cells() + cell];
            if (std::isnan(force)) continue;
            for (; next < k; ++next) {
                const double s = (map.depths_m[next] - from_m) / (map.depths_m[k] - from_m);
                out[next * map.n_cells() + cell] =
                    static_cast<float>(from_N + s * (static_cast<double>(force) - from_N));
            }
            next = k + 1;
            from_m = map.depths_m[k];
            from_N = static_cast<double>(force);
        }
    }
}

// Fills in the tangential force from the slope of the energy at every cell and depth that was measured.
void derive_tangential(Map& map) {
    FieldOptions options;
    options.sigma_m = std::max(map.spacing_m[0], map.spacing_m[1]);
    const Field field = make_field(map, options);
    map.tangential_x_N.assign(map.normal_N.size(), kMissing);
    map.tangential_y_N.assign(map.normal_N.size(), kMissing);
    for (std::size_t k = 0; k < map.n_depths(); ++k) {
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            const std::size_t at = k * map.n_cells() + cell;
            if (std::isnan(map.normal_N[at])) continue;
            const Place place = place_at(field, {map.x_of(cell % map.n_x), map.y_of(cell / map.n_x)});
            const Eigen::Vector2d slope = energy_gradient_N(field, place, map.depths_m[k]);
            map.tangential_x_N[at] = static_cast<float>(slope.x());
            map.tangential_y_N[at] = static_cast<float>(slope.y());
        }
    }
    map.tangential = TangentialKind::energy;
}

void choose_tangential(Map& map, bool measured, const ImportOptions& options, const std::string& file) {
    const TangentialChoice choice =
        options.tangential.value_or(measured ? TangentialChoice::measured : TangentialChoice::none);
    if (choice == TangentialChoice::measured && !measured) {
        throw files::bad_input(file, "", "no force that resists motion along +x or +y",
                               "a recording of a sliding tool, or matrices of it; else --tangential energy or none");
    }
    if (choice != TangentialChoice::measured) {
        map.tangential_x_N.clear();
        map.tangential_y_N.clear();
    }
    map.tangential = choice == TangentialChoice::measured ? TangentialKind::recorded : TangentialKind::none;
    if (choice == TangentialChoice::energy) derive_tangential(map);
    add_choice(map.source, "tangential", name_of(choice),
               measured ? "the recording has the force that resists motion along + the axes"
                        : "nothing slid: what resists motion is derived from the normal force at look-up",
               "--tangential", options.tangential.has_value());
}

}  // namespace

void start_map(const GridPlan& plan, Map& map) {
    map.origin_m[0] = plan.x.origin_m;
    map.origin_m[1] = plan.y.origin_m;
    map.spacing_m[0] = plan.x.pitch_m;
    map.spacing_m[1] = plan.y.pitch_m;
    map.n_x = plan.x.n;
    map.n_y = plan.y.n;
    map.depths_m = plan.depths_m;
}

void check_enough_samples(const GridPlan& plan, std::size_t n_samples, const std::string& file) {
    constexpr double kSpare = 10'000.0;
    const double cells = static_cast<double>(plan.x.n) * static_cast<double>(plan.y.n);
    if (cells <= static_cast<double>(n_samples) + kSpare) return;
    throw files::bad_input(
        file, "",
        files::short_number(cells) + " cells of " + files::short_number(1e3 * plan.x.pitch_m) + " mm for " +
            std::to_string(n_samples) + " samples",
        "fewer cells than samples: a greater --pitch-mm, or is a place far off the others (--region-mm)?");
}

std::vector<float> filled_forces(const Map& map) {
    std::vector<float> out = map.normal_N;
    if (missing_count(map) == 0) return out;
    close_inner_gaps(map, out);
    const GridShape shape{map.n_x, map.n_y, map.spacing_m[0], map.spacing_m[1]};
    std::vector<double> step(map.n_cells());
    for (std::size_t k = 0; k < map.n_depths(); ++k) {
        const auto above = [&](std::size_t cell) {
            return k == 0 ? 0.0 : static_cast<double>(out[(k - 1) * map.n_cells() + cell]);
        };
        bool any = false;
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            step[cell] = static_cast<double>(out[k * map.n_cells() + cell]) - above(cell);
            any = any || !std::isnan(step[cell]);
        }
        if (any) fill_missing(step, shape);
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            float& force = out[k * map.n_cells() + cell];
            if (std::isnan(force)) force = static_cast<float>(above(cell) + (any ? step[cell] : 0.0));
        }
    }
    return out;
}

namespace {

void note_worst(double off_N, const RecordedPoints& recorded, std::size_t i, ImportResidual& out) {
    if (off_N <= out.worst_N) return;
    out.worst_N = off_N;
    out.worst_x_m = recorded.x_m[i];
    out.worst_y_m = recorded.y_m[i];
    out.worst_depth_m = static_cast<double>(recorded.depth_m[i]);
}

}  // namespace

ImportResidual residual_of(const Map& map, const RecordedPoints& recorded) {
    const Field field = make_field(map, {});
    ImportResidual out;
    out.greatest_N = force_range(map).highest_N;
    std::vector<double> residuals;
    residuals.reserve(recorded.x_m.size());
    for (std::size_t i = 0; i < recorded.x_m.size(); ++i) {
        const Place place = place_at(field, {recorded.x_m[i], recorded.y_m[i]});
        const double depth_m = static_cast<double>(recorded.depth_m[i]);
        constexpr double kHair_m = 1e-9;
        if (!place.inside || !place.measured || depth_m > greatest_depth_m(field, place) + kHair_m) continue;
        const double off_N = std::abs(normal_force_N(field, place, depth_m) - static_cast<double>(recorded.force_N[i]));
        residuals.push_back(off_N);
        note_worst(off_N, recorded, i, out);
    }
    out.n = residuals.size();
    out.median_N = median(std::move(residuals));
    return out;
}

namespace {

// Returns a force of the map at a place, linear from 0 at the surface and between the depths; NaN if one of the numbers
// that it needs is missing.
double force_between(const Map& map, const std::vector<float>& forces, const Place& place, double depth_m) {
    const auto above = std::lower_bound(map.depths_m.begin(), map.depths_m.end(), depth_m);
    if (above == map.depths_m.end()) return std::numeric_limits<double>::quiet_NaN();
    const auto k = static_cast<std::size_t>(above - map.depths_m.begin());
    const double from_m = k > 0 ? map.depths_m[k - 1] : 0.0;
    const double s = (depth_m - from_m) / (map.depths_m[k] - from_m);
    double sum = 0.0;
    for (int c = 0; c < 4; ++c) {
        if (place.weight[c] == 0.0) continue;
        const auto at = [&](std::size_t layer) {
            return static_cast<double>(forces[layer * map.n_cells() + place.cell[c]]);
        };
        const double shallower_N = k > 0 ? at(k - 1) : 0.0;
        sum += place.weight[c] * (shallower_N + s * (at(k) - shallower_N));
    }
    return sum;
}

double greatest_size_N(const std::vector<float>& forces) {
    double out = 0.0;
    for (const float force_N : forces) {
        if (!std::isnan(force_N)) out = std::max(out, std::abs(static_cast<double>(force_N)));
    }
    return out;
}

}  // namespace

std::optional<ImportResidual> tangential_residual_of(const Map& map, const RecordedPoints& recorded) {
    const Field field = make_field(map, {});
    ImportResidual out;
    std::vector<double> residuals;
    for (const int along : {0, 1}) {
        const std::vector<float>& forces = along == 0 ? map.tangential_x_N : map.tangential_y_N;
        if (forces.empty() || recorded.tangential_N[along].empty()) continue;
        out.greatest_N = std::max(out.greatest_N, greatest_size_N(forces));
        for (std::size_t i = 0; i < recorded.x_m.size(); ++i) {
            const Place place = place_at(field, {recorded.x_m[i], recorded.y_m[i]});
            const double depth_m = static_cast<double>(recorded.depth_m[i]);
            const double off_N = std::abs(force_between(map, forces, place, depth_m) -
                                          static_cast<double>(recorded.tangential_N[along][i]));
            if (!place.inside || std::isnan(off_N)) continue;
            residuals.push_back(off_N);
            note_worst(off_N, recorded, i, out);
        }
    }
    if (residuals.empty()) return std::nullopt;
    out.n = residuals.size();
    out.median_N = median(std::move(residuals));
    return out;
}

ImportResidual residual_of_numbers(const Map& map) {
    ImportResidual out;
    out.greatest_N = force_range(map).highest_N;
    // of a part of the cells, which suffices for the median
    std::vector<double> residuals;
    const std::size_t step = 1 + map.normal_N.size() / 2'000'000;
    std::vector<double> forces;
    std::vector<std::size_t> layer;
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        forces.assign(1, 0.0);  // no force at the surface, as in look-up
        layer.assign(1, 0);
        for (std::size_t k = 0; k < map.n_depths(); ++k) {
            const float force = map.normal_N[k * map.n_cells() + cell];
            if (std::isnan(force)) continue;
            forces.push_back(static_cast<double>(force));
            layer.push_back(k);
        }
        make_isotonic(forces);
        for (std::size_t i = 1; i < forces.size(); ++i) {
            const double raw = static_cast<double>(map.normal_N[layer[i] * map.n_cells() + cell]);
            const double off_N = std::abs(std::max(forces[i], 0.0) - raw);
            if (out.n++ % step == 0) residuals.push_back(off_N);
            if (off_N <= out.worst_N) continue;
            out.worst_N = off_N;
            out.worst_x_m = map.x_of(cell % map.n_x);
            out.worst_y_m = map.y_of(cell / map.n_x);
            out.worst_depth_m = map.depths_m[layer[i]];
        }
    }
    out.median_N = median(std::move(residuals));
    return out;
}

void finish_map(Map& map, const RecordedPoints& recorded, bool measured_tangential, const ImportOptions& options,
                const std::string& file, ImportReport& report) {
    refuse_no_forces(map, file);
    refuse_empty_layers(map, recorded, file);
    check_sizes(map, options, file);
    map.indenter = options.indenter;
    map.indenter_radius_m = options.indenter_radius_m;
    map.source.kind = SourceKind::recorded;
    if (options.progress) options.progress("checking", 0.0);
    choose_tangential(map, measured_tangential, options, file);
    std::size_t falling = 0, measured = 0;
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        float first_N = std::numeric_limits<float>::quiet_NaN(), last_N = first_N;
        for (std::size_t k = 0; k < map.n_depths(); ++k) {
            const float force_N = map.normal_N[k * map.n_cells() + cell];
            if (std::isnan(force_N)) continue;
            if (std::isnan(first_N)) first_N = force_N;
            last_N = force_N;
        }
        measured += !std::isnan(first_N);
        falling += last_N < first_N;
    }
    report.missing_cells += map.n_cells() - measured;
    if (2 * falling > measured)
        report.notes.push_back(file + ": the force is less at the greatest depth than at the least in " +
                               std::to_string(falling) + " of " + std::to_string(measured) +
                               " cells, and look-up makes such forces constant: are the depths in the right order?");
    if (options.fill) map.filled_normal_N = filled_forces(map);
    add_choice(map.source, "filled", options.fill ? "neighbours" : "none",
               "gaps stay gaps in normal_N.npy; filled_normal_N.npy beside it has none", "--no-fill");
    if (knows_noise(map)) {
        map.noise_N = estimated_noise_N(map);
        add_choice(map.source, "noise_N", *map.noise_N, "second differences along x and y", "");
    } else {
        add_choice(map.source, "noise_N", "not known", "too few neighbours for second differences along x and y", "");
    }
    add_choice(map.source, "over_depth", "isotonic at look-up", "the raw forces are kept in the map", "");
    add_choice(map.source, "indenter_radius_mm", choice_mm(options.indenter_radius_m), "recordings do not say",
               "--indenter-radius-mm");
    check_map(map, file);
    report.residual = recorded.x_m.empty() ? residual_of_numbers(map) : residual_of(map, recorded);
    if (map.tangential == TangentialKind::recorded) report.tangential = tangential_residual_of(map, recorded);
}

}  // namespace palpa::stiffnessmaps
