#include "stiffnessmaps/field.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "stiffnessmaps/grid.h"

namespace palpa::stiffnessmaps {
namespace {

GridShape shape_of(const Map& map) { return {map.n_x, map.n_y, map.spacing_m[0], map.spacing_m[1]}; }

// Completes one cell's forces over depth: isotonic, >= 0, gaps interpolated, extrapolated beyond the last measurement
// with its last slope. Counts the forces that isotonic regression changed. Returns the layer of the last measurement, 0
// if there is none.
std::size_t fill_column(const std::vector<double>& depths_m, std::vector<double>& column, std::size_t& changed) {
    std::vector<std::size_t> layer{0};
    std::vector<double> force{0.0};
    for (std::size_t k = 1; k < column.size(); ++k) {
        if (std::isnan(column[k])) continue;
        layer.push_back(k);
        force.push_back(column[k]);
    }
    if (layer.size() == 1) return 0;
    const std::vector<double> raw = force;
    make_isotonic(force);
    for (double& f : force) f = std::max(f, 0.0);
    force.front() = 0.0;
    for (std::size_t i = 1; i < force.size(); ++i) changed += force[i] != raw[i];

    for (std::size_t k = 1, i = 0; k < column.size(); ++k) {
        while (i + 2 < layer.size() && layer[i + 1] < k) ++i;
        const double from_m = depths_m[layer[i]];
        const double to_m = depths_m[layer[i + 1]];
        const double s = (depths_m[k] - from_m) / (to_m - from_m);
        column[k] = layer[i + 1] == k ? force[i + 1] : force[i] + s * (force[i + 1] - force[i]);
    }
    column[0] = 0.0;
    return layer.back();
}

void fill_normal(const Map& map, Field& field) {
    const std::size_t n_layers = field.n_layers();
    field.normal_N.assign(map.n_cells() * n_layers, kMissing);
    field.greatest_m.assign(map.n_cells(), kMissing);
    field.measured.assign(map.n_cells(), 0.0);
    std::vector<double> column(n_layers);
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        column[0] = 0.0;
        for (std::size_t k = 1; k < n_layers; ++k) {
            column[k] = static_cast<double>(map.normal_N[(k - 1) * map.n_cells() + cell]);
        }
        const std::size_t last = fill_column(field.depths_m, column, field.isotonic_changed);
        if (last == 0) continue;
        std::copy(column.begin(), column.end(), field.normal_N.begin() + static_cast<std::ptrdiff_t>(cell * n_layers));
        field.greatest_m[cell] = field.depths_m[last];
        field.measured[cell] = 1.0;
    }
    // cells without any measurement are filled from their neighbours, so that look-ups stay continuous, and stay
    // flagged
    std::vector<double> layer(map.n_cells());
    for (std::size_t k = 0; k < n_layers; ++k) {
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) layer[cell] = field.normal_N[cell * n_layers + k];
        fill_missing(layer, shape_of(map));
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) field.normal_N[cell * n_layers + k] = layer[cell];
    }
    fill_missing(field.greatest_m, shape_of(map));
    field.complete = std::all_of(field.measured.begin(), field.measured.end(), [](double m) { return m > 0.0; }) &&
                     std::all_of(field.greatest_m.begin(), field.greatest_m.end(),
                                 [&](double m) { return m == field.depths_m.back(); });
}

void fill_slopes(const Map& map, Field& field) {
    const GridShape shape = shape_of(map);
    const std::size_t n_layers = field.n_layers();
    field.slopes.assign(map.n_cells() * n_layers, Field::Slope{});
    std::vector<double> layer(map.n_cells());
    for (std::size_t k = 1; k < n_layers; ++k) {
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) layer[cell] = field.normal_N[cell * n_layers + k];
        const Gradient slope = gradient(smooth(layer, shape, field.options.sigma_m), shape);
        const double half_m = 0.5 * (field.depths_m[k] - field.depths_m[k - 1]);
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            const Field::Slope& above = field.slopes[cell * n_layers + k - 1];
            Field::Slope& here = field.slopes[cell * n_layers + k];
            here.force_x = slope.x[cell];
            here.force_y = slope.y[cell];
            here.energy_x = above.energy_x + half_m * (above.force_x + here.force_x);
            here.energy_y = above.energy_y + half_m * (above.force_y + here.force_y);
        }
    }
}

std::vector<double> recorded_layer(const Map& map, const std::vector<float>& forces, std::size_t k, double sigma_m) {
    std::vector<double> layer(map.n_cells(), 0.0);
    if (forces.empty()) return layer;
    for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
        layer[cell] = static_cast<double>(forces[(k - 1) * map.n_cells() + cell]);
    }
    layer = smooth(layer, shape_of(map), sigma_m);
    fill_missing(layer, shape_of(map));
    for (double& value : layer) {
        if (std::isnan(value)) value = 0.0;  // a layer without any measurement
    }
    return layer;
}

void fill_rest(const Map& map, Field& field) {
    const bool as_recorded = field.options.force == TangentialForce::recorded;
    field.has_rest = as_recorded ? map.tangential != TangentialKind::none : map.tangential == TangentialKind::recorded;
    if (!field.has_rest) return;
    for (std::size_t k = 1; k < field.n_layers(); ++k) {
        const auto along_x = recorded_layer(map, map.tangential_x_N, k, field.options.sigma_m);
        const auto along_y = recorded_layer(map, map.tangential_y_N, k, field.options.sigma_m);
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            Field::Slope& here = field.slopes[cell * field.n_layers() + k];
            const double rho =
                map.tangential_x_N.empty() ? along_y[cell] - here.energy_y : along_x[cell] - here.energy_x;
            here.rest_x = as_recorded ? along_x[cell] : std::max(0.0, rho);
            here.rest_y = as_recorded ? along_y[cell] : 0.0;
        }
    }
}

// Returns the last layer that is not deeper than `depth_m`: depths_m[layer] <= depth < depths_m[layer + 1] (clamped to
// the last pair of layers).
std::size_t layer_above(const Field& field, double depth_m) {
    std::size_t layer = 0;
    while (layer + 2 < field.n_layers() && field.depths_m[layer + 1] <= depth_m) ++layer;
    return layer;
}

double layer_force_N(const Field& field, const Place& place, std::size_t layer) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 4; ++c)
        sum += place.weight[c] * field.normal_N[place.cell[c] * field.n_layers() + layer];
    return sum;
}

}  // namespace

Field make_field(const Map& map, const FieldOptions& options) {
    Field field;
    field.options = options;
    for (int i = 0; i < 2; ++i) {
        field.origin_m[i] = map.origin_m[i];
        field.cells_per_m[i] = 1.0 / map.spacing_m[i];
    }
    field.n_x = map.n_x;
    field.n_y = map.n_y;
    field.depths_m.push_back(0.0);
    field.depths_m.insert(field.depths_m.end(), map.depths_m.begin(), map.depths_m.end());
    fill_normal(map, field);
    fill_slopes(map, field);
    fill_rest(map, field);
    return field;
}

Place place_at(const Field& field, const Eigen::Vector2d& p_m) {
    Place place;
    const auto split = [&](int axis, std::size_t n, std::size_t& low, double& s) {
        double at = (p_m[axis] - field.origin_m[axis]) * field.cells_per_m[axis];
        const double last = static_cast<double>(n - 1);
        constexpr double kHalfCell = 0.5 + 1e-9;  // a cell covers half a pitch around its point
        if (!(at >= -kHalfCell && at <= last + kHalfCell)) place.inside = false;
        at = at > 0.0 ? std::min(at, last) : 0.0;  // NaN becomes 0
        low = std::min(static_cast<std::size_t>(at), n > 1 ? n - 2 : 0);
        s = at - static_cast<double>(low);
    };
    std::size_t i = 0;
    std::size_t j = 0;
    double s = 0.0;
    double t = 0.0;
    split(0, field.n_x, i, s);
    split(1, field.n_y, j, t);
    const std::size_t right = field.n_x > 1 ? 1 : 0;
    const std::size_t up = field.n_y > 1 ? field.n_x : 0;
    const std::size_t cell = j * field.n_x + i;
    place.cell[0] = cell;
    place.cell[1] = cell + right;
    place.cell[2] = cell + up;
    place.cell[3] = cell + up + right;
    place.weight[0] = (1.0 - s) * (1.0 - t);
    place.weight[1] = s * (1.0 - t);
    place.weight[2] = (1.0 - s) * t;
    place.weight[3] = s * t;
    if (field.complete) return place;
    double measured = 0.0;
    for (std::size_t c = 0; c < 4; ++c) measured += place.weight[c] * field.measured[place.cell[c]];
    place.measured = measured >= 0.5;
    return place;
}

double greatest_depth_m(const Field& field, const Place& place) {
    if (field.complete) return field.depths_m.back();
    double sum = 0.0;
    for (std::size_t c = 0; c < 4; ++c) sum += place.weight[c] * field.greatest_m[place.cell[c]];
    return sum;
}

double normal_force_N(const Field& field, const Place& place, double depth_m) {
    const double depth = std::clamp(depth_m, 0.0, greatest_depth_m(field, place));
    const std::size_t k = layer_above(field, depth);
    const double s = (depth - field.depths_m[k]) / (field.depths_m[k + 1] - field.depths_m[k]);
    const double from_N = layer_force_N(field, place, k);
    return from_N + s * (layer_force_N(field, place, k + 1) - from_N);
}

DepthAnswer depth_at(const Field& field, const Place& place, double force_N) {
    DepthAnswer answer;
    if (!(force_N > 0.0)) return answer;
    const double greatest_m = greatest_depth_m(field, place);
    double above_N = 0.0;
    for (std::size_t k = 0; k + 1 < field.n_layers(); ++k) {
        const double below_N = layer_force_N(field, place, k + 1);
        if (force_N <= below_N) {
            const double s = (force_N - above_N) / (below_N - above_N);
            answer.depth_m = field.depths_m[k] + s * (field.depths_m[k + 1] - field.depths_m[k]);
            answer.saturated = answer.depth_m > greatest_m * (1.0 + 1e-12);
            answer.depth_m = std::min(answer.depth_m, greatest_m);
            return answer;
        }
        above_N = below_N;
    }
    answer.depth_m = greatest_m;
    answer.saturated = true;
    return answer;
}

namespace {

// A depth between two layers, with the weights of both.
struct LayerSpot {
    std::size_t layer = 0;
    double energy_above = 0.0;  // weight of the upper layer's force in the energy, m: z - z^2/(2 D)
    double energy_below = 0.0;  // weight of the lower layer's force, m: z^2/(2 D)
    double s = 0.0;             // weight of the lower layer in linear interpolation
};

LayerSpot spot_at(const Field& field, double depth_m) {
    const double depth = std::clamp(depth_m, 0.0, field.depths_m.back());
    LayerSpot spot;
    spot.layer = layer_above(field, depth);
    const double z = depth - field.depths_m[spot.layer];
    spot.s = z / (field.depths_m[spot.layer + 1] - field.depths_m[spot.layer]);
    spot.energy_below = 0.5 * z * spot.s;
    spot.energy_above = z - spot.energy_below;
    return spot;
}

// Returns u . G at one place, N.
double uphill_N(const Field& field, const Place& place, const Eigen::Vector2d& u, const LayerSpot& spot) {
    double sum = 0.0;
    for (std::size_t c = 0; c < 4; ++c) {
        const Field::Slope* at = &field.slopes[place.cell[c] * field.n_layers() + spot.layer];
        const double x = at[0].energy_x + at[0].force_x * spot.energy_above + at[1].force_x * spot.energy_below;
        const double y = at[0].energy_y + at[0].force_y * spot.energy_above + at[1].force_y * spot.energy_below;
        sum += place.weight[c] * (u.x() * x + u.y() * y);
    }
    return sum;
}

Eigen::Vector2d rest_N(const Field& field, const Place& place, const LayerSpot& spot) {
    Eigen::Vector2d sum = Eigen::Vector2d::Zero();
    for (std::size_t c = 0; c < 4; ++c) {
        const Field::Slope* at = &field.slopes[place.cell[c] * field.n_layers() + spot.layer];
        sum.x() += place.weight[c] * (at[0].rest_x + spot.s * (at[1].rest_x - at[0].rest_x));
        sum.y() += place.weight[c] * (at[0].rest_y + spot.s * (at[1].rest_y - at[0].rest_y));
    }
    return sum;
}

double force_along_N(const Field& field, const Place& place, const Eigen::Vector2d& u, const LayerSpot& spot) {
    if (field.options.force == TangentialForce::recorded) return u.dot(rest_N(field, place, spot));
    const double conservative_N = std::max(0.0, uphill_N(field, place, u, spot));
    return field.has_rest ? conservative_N + rest_N(field, place, spot).x() : conservative_N;
}

}  // namespace

Eigen::Vector2d energy_gradient_N(const Field& field, const Place& place, double depth_m) {
    const LayerSpot spot = spot_at(field, depth_m);
    return {uphill_N(field, place, {1.0, 0.0}, spot), uphill_N(field, place, {0.0, 1.0}, spot)};
}

double tangential_force_N(const Field& field, const Place& place, const Eigen::Vector2d& u, double depth_m) {
    return force_along_N(field, place, u, spot_at(field, depth_m));
}

double tangential_rise_N(const Field& field, const Place& here, const Place& before, const Eigen::Vector2d& u,
                         double depth_m) {
    const LayerSpot spot = spot_at(field, depth_m);
    return force_along_N(field, here, u, spot) - force_along_N(field, before, u, spot);
}

TangentialAgreement tangential_agreement(const Map& map, const Field& field) {
    TangentialAgreement out;
    if (map.tangential_x_N.empty()) return out;
    double n = 0.0, sx = 0.0, sy = 0.0, sxx = 0.0, syy = 0.0, sxy = 0.0;
    for (std::size_t k = 0; k < map.n_depths(); ++k) {
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            const double y = static_cast<double>(map.tangential_x_N[k * map.n_cells() + cell]);
            if (std::isnan(y) || field.measured[cell] == 0.0) continue;
            const double x = field.slopes[cell * field.n_layers() + k + 1].energy_x;
            n += 1.0;
            sx += x, sy += y, sxx += x * x, syy += y * y, sxy += x * y;
        }
    }
    const double vx = n * sxx - sx * sx;
    const double vy = n * syy - sy * sy;
    const double cov = n * sxy - sx * sy;
    out.n = static_cast<std::size_t>(n);
    if (vx > 0.0 && vy > 0.0) {
        out.correlation = cov / std::sqrt(vx * vy);
        out.slope = cov / vx;
    }
    return out;
}

}  // namespace palpa::stiffnessmaps
