#include "mechanics/rolling_cost.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numbers>

#include "mechanics/rolling_mesh.h"

namespace palpa::mechanics {
namespace {

constexpr double kNever = std::numeric_limits<double>::infinity();
constexpr double kMostLines = 1e5;  // along one axis; a mesh with more is never affordable

// Sparse Cholesky of N equations of a compact mesh: the factor's entries grow with N^(4/3), the work with N^2.
constexpr double kFactorEntries = 13.0;      // entries of the factor over N^(4/3)
constexpr double kFactorBytes = 2.2 * 8.0;   // per entry, with the solver's work space
constexpr double kFactorWork_s = 1.7e-9;     // time to factor over N^2
constexpr double kEntriesPerSecond = 1.4e9;  // of the factor, in a solve with one right-hand side

RollingCost mesh_cost(const GridLines& lines, double columns, double dense) {
    RollingCost out;
    const auto N = 3.0 * static_cast<double>(lines.x_m.size()) * static_cast<double>(lines.y_m.size()) *
                   static_cast<double>(lines.z_m.size());
    const double entries = kFactorEntries * std::pow(N, 4.0 / 3.0);
    out.unknowns = N;
    out.memory_bytes = kFactorBytes * entries + 1000.0 * N + 8.0 * dense;
    out.time_s = kFactorWork_s * N * N + columns * entries / kEntriesPerSecond;
    return out;
}

// Returns how many values a table holds for each pair of points.
double lists(const RollingModel& model) { return model.friction > 0.0 ? 3.0 : 1.0; }

RollingCost larger(const RollingCost& a, const RollingCost& b) {
    return {std::max(a.unknowns, b.unknowns), std::max(a.memory_bytes, b.memory_bytes), a.time_s + b.time_s};
}

// Returns how many of n sample lines, `spacing` apart, the tool can cover.
double covered(double width_m, double spacing_m, double n) { return std::min(n, width_m / spacing_m + 4.0); }

}  // namespace

RollingCost contact_cost(const RollingModel& model, const RollingMesh& mesh) {
    const std::array<double, 2> half_m = footprint_m(model);
    const double n_x = 2.0 * half_m[0] / mesh.contact_m + 2.0;
    const double n_y = 2.0 * half_m[1] / mesh.contact_m + 2.0;
    const double round = model.shape == IndenterShape::sphere ? 0.25 * std::numbers::pi : 1.0;
    const double patch = round * n_x * n_y;
    if (std::max(n_x, n_y) > kMostLines) return {kNever, kNever, kNever};
    return mesh_cost(contact_lines(model, mesh), 1.0, (1.0 + lists(model)) * patch * patch);
}

RollingCost side_cost(const RollingModel& model, const RollingMesh& mesh) {
    const double n_x = std::round(model.size_m[0] / mesh.surface_m[0]) + 1.0;
    const double n_y = std::round(model.size_m[1] / mesh.surface_m[1]) + 1.0;
    const std::array<double, 2> half_m = footprint_m(model);
    const double w_x = 2.0 * covered(2.0 * half_m[0], mesh.surface_m[0], 0.5 * n_x) + 1.0;
    const double w_y = 2.0 * covered(2.0 * half_m[1], mesh.surface_m[1], 0.5 * n_y) + 1.0;
    const double quarter = 0.25 * n_x * n_y;
    const double under =
        covered(2.0 * half_m[0], mesh.surface_m[0], n_x) * covered(2.0 * half_m[1], mesh.surface_m[1], n_y);
    const double table = n_x * n_y * w_x * w_y + under * under;
    const double dense = lists(model) * (quarter * quarter + table);
    const RollingCost block = mesh_cost(side_lines(model, mesh), 4.0 * quarter, dense);
    return larger(block, mesh_cost(side_layer_lines(model, mesh), 1.0, dense));
}

RollingCost inclusion_cost(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group) {
    const GridLines lines = inclusion_lines(model, mesh, group);
    const double n_x = static_cast<double>(inclusion_samples(model, mesh, group, 0, lines.x_m).size());
    const double n_y = static_cast<double>(inclusion_samples(model, mesh, group, 1, lines.y_m).size());
    const double columns = n_x * n_y;
    // with and without the inclusions: the two factors exist one after the other, the two compliances at once
    RollingCost out = mesh_cost(lines, columns, 4.0 * lists(model) * columns * columns);
    out.time_s *= 2.0;
    return out;
}

}  // namespace palpa::mechanics
