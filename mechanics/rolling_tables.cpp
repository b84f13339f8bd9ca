// The finite element part of rolling.h: each table is one column of a surface compliance, or a window of columns.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/rolling_mesh.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kFadeFrom = 0.65;  // of the reach

// What pressing at one surface point does at another. Each has a list in a table and a matrix in a compliance; along_x
// and along_y exist only with friction.
enum class Response { normal, along_x, along_y };

std::vector<Response> responses(const RollingModel& model) {
    if (model.friction > 0.0) return {Response::normal, Response::along_x, Response::along_y};
    return {Response::normal};
}

template <class Table>
auto& list_of(Table& table, Response response) {
    if (response == Response::normal) return table.value;
    return response == Response::along_x ? table.along_x : table.along_y;
}

const Eigen::MatrixXd& matrix_of(const Compliance& compliance, Response response) {
    if (response == Response::normal) return compliance.normal_m_per_N;
    return response == Response::along_x ? compliance.along_x_m_per_N : compliance.along_y_m_per_N;
}

// Returns the sign of a response after mirroring: sideways motion along a mirrored axis changes its sign.
double mirrored(Response response, bool along_x, bool along_y) {
    return (response == Response::along_x && along_x) || (response == Response::along_y && along_y) ? -1.0 : 1.0;
}

Compliance compliance_of(const RollingModel& model, const Problem& problem, std::vector<int> nodes) {
    SurfaceRequest request;
    request.touch_nodes = std::move(nodes);
    request.sideways = model.friction > 0.0;
    return surface_compliance(problem.mesh, factorise(problem, best_solver()), request);
}

// Returns the nodes of the plane at the far end of an axis.
std::vector<int> end_plane(const Problem& problem, int axis) {
    std::vector<int> nodes;
    const double end_m = problem.mesh.nodes_m.row(axis).maxCoeff();
    for (Index i = 0; i < problem.mesh.nodes_m.cols(); ++i) {
        if (problem.mesh.nodes_m(axis, i) >= end_m) nodes.push_back(static_cast<int>(i));
    }
    return nodes;
}

// Computes the kernel of the layer on a quarter of it; the load is at the corner, where both planes of symmetry meet.
// n: numbers of offsets along x and y.
LayerKernel layer_kernel(const RollingModel& model, const std::array<double, 2>& spacing_m, const std::array<int, 2>& n,
                         const GridLines& lines) {
    const auto& [x_m, y_m, z_m] = lines;
    Problem problem = block_problem(x_m, y_m, z_m, model.tissue, {});
    for (int axis = 0; axis < 2; ++axis) {
        std::vector<int> plane;
        for (Index i = 0; i < problem.mesh.nodes_m.cols(); ++i) {
            if (problem.mesh.nodes_m(axis, i) <= 0.0) plane.push_back(static_cast<int>(i));
        }
        fix(plane, axis == 0 ? "x" : "y", 0.0, problem.supports);
    }
    const Factored factored = factorise(problem, best_solver());
    SurfaceRequest request;
    request.sideways = model.friction > 0.0;
    request.touch_nodes = {surface_node(x_m, y_m, z_m, 0, 0)};
    for (int j = 0; j < n[1]; ++j) {
        for (int i = 0; i < n[0]; ++i) {
            if (i + j > 0) request.other_nodes.push_back(surface_node(x_m, y_m, z_m, i, j));
        }
    }
    const Compliance column = surface_compliance(problem.mesh, factored, request);
    LayerKernel kernel{spacing_m, n[0], n[1], {}, {}, {}};
    // one newton on the whole layer is a quarter of a newton on this quarter
    for (const Response response : responses(model)) {
        const Eigen::MatrixXd& moved = matrix_of(column, response);
        for (Index i = 0; i < moved.rows(); ++i) list_of(kernel, response).push_back(0.25 * moved(i, 0));
    }
    return kernel;
}

// Returns the surface compliance of a quarter of the block between all its surface nodes; each of the two mirror planes
// is symmetric or antisymmetric.
Compliance quarter_compliance(const RollingModel& model, const VectorXd& x_m, const VectorXd& y_m, const VectorXd& z_m,
                              const std::array<bool, 2>& antisymmetric) {
    Problem problem = block_problem(x_m, y_m, z_m, model.tissue, {});
    for (int axis = 0; axis < 2; ++axis) {
        const bool anti = antisymmetric[static_cast<std::size_t>(axis)];
        fix(end_plane(problem, axis), axis == 0 ? (anti ? "yz" : "x") : (anti ? "xz" : "y"), 0.0, problem.supports);
    }
    std::vector<int> nodes;
    for (int j = 0; j < y_m.size(); ++j) {
        for (int i = 0; i < x_m.size(); ++i) nodes.push_back(surface_node(x_m, y_m, z_m, i, j));
    }
    return compliance_of(model, problem, std::move(nodes));
}

// Returns how many sample lines the reach of a table must be, so that it holds all stencils of two points under one
// tool.
int reach_in_lines(const std::vector<double>& lines_m, double width_m) {
    std::size_t most = 0;
    for (std::size_t i = 0, end = 0; i < lines_m.size(); ++i) {
        while (end < lines_m.size() && lines_m[end] < lines_m[i] + width_m) ++end;
        most = std::max(most, end - i);
    }
    return std::min(static_cast<int>(most) + 3, static_cast<int>(lines_m.size()) - 1);
}

// Sizes `values` as a list of the table and calls f(ix, iy, jx, jy, value) for every pair that the table stores.
template <class F>
void for_each_pair(const PairTable& table, std::vector<double>& values, F&& f) {
    const int n_x = static_cast<int>(table.x_m.size());
    const int n_y = static_cast<int>(table.y_m.size());
    const int w_x = 2 * table.reach_x + 1;
    const int w_y = 2 * table.reach_y + 1;
    values.assign(static_cast<std::size_t>(n_x) * static_cast<std::size_t>(n_y * w_x * w_y), 0.0);
    std::size_t at = 0;
    for (int iy = 0; iy < n_y; ++iy) {
        for (int ix = 0; ix < n_x; ++ix) {
            for (int jy = iy - table.reach_y; jy <= iy + table.reach_y; ++jy) {
                for (int jx = ix - table.reach_x; jx <= ix + table.reach_x; ++jx, ++at) {
                    if (jx >= 0 && jx < n_x && jy >= 0 && jy < n_y) f(ix, iy, jx, jy, values[at]);
                }
            }
        }
    }
}

// Returns 1 over the inclusions (low_m to high_m) and up to kFadeFrom of the distance `reach_m` from them; from there
// on it falls smoothly to 0 at reach_m.
double fade(double at_m, double low_m, double high_m, double reach_m) {
    const double beyond_m = std::max({0.0, low_m - at_m, at_m - high_m});
    const double s = std::clamp((beyond_m / reach_m - kFadeFrom) / (1.0 - kFadeFrom), 0.0, 1.0);
    return 0.5 * (1.0 + std::cos(std::numbers::pi * s));
}

}  // namespace

LayerKernel contact_kernel(const RollingModel& model, const RollingMesh& mesh) {
    const double h = mesh.contact_m;
    return layer_kernel(model, {h, h}, contact_offsets(model, mesh), contact_lines(model, mesh));
}

PairTable side_table(const RollingModel& model, const RollingMesh& mesh) {
    const GridLines lines = side_lines(model, mesh);
    const int half[2] = {static_cast<int>(lines.x_m.size()) - 1, static_cast<int>(lines.y_m.size()) - 1};
    const int most = std::max(half[0], half[1]);
    const LayerKernel plain = layer_kernel(model, mesh.surface_m, {most + 1, most + 1}, side_layer_lines(model, mesh));

    PairTable table;
    for (int i = 0; i <= 2 * half[0]; ++i) table.x_m.push_back(mesh.surface_m[0] * i);
    for (int j = 0; j <= 2 * half[1]; ++j) table.y_m.push_back(mesh.surface_m[1] * j);
    const std::array<double, 2> footprint = footprint_m(model);
    table.reach_x = std::min(reach_in_lines(table.x_m, 2.0 * footprint[0]), half[0]);
    table.reach_y = std::min(reach_in_lines(table.y_m, 2.0 * footprint[1]), half[1]);
    for (const Response response : responses(model)) {
        const std::vector<double>& layer = list_of(plain, response);
        for_each_pair(table, list_of(table, response), [&](int ix, int iy, int jx, int jy, double& value) {
            const auto offset = static_cast<std::size_t>(std::abs(jy - iy) * plain.n_x + std::abs(jx - ix));
            value = -mirrored(response, ix < jx, iy < jy) * layer[offset];
        });
    }
    // a load is a quarter of the sum of its four patterns, symmetric or antisymmetric in each mirror plane
    std::vector<double> pattern;
    for (const bool anti_x : {false, true}) {
        for (const bool anti_y : {false, true}) {
            const Compliance quarter = quarter_compliance(model, lines.x_m, lines.y_m, lines.z_m, {anti_x, anti_y});
            for (const Response response : responses(model)) {
                const Eigen::MatrixXd& C = matrix_of(quarter, response);
                for_each_pair(table, pattern, [&](int ix, int iy, int jx, int jy, double& value) {
                    const int from = std::min(iy, 2 * half[1] - iy) * (half[0] + 1) + std::min(ix, 2 * half[0] - ix);
                    const int to = std::min(jy, 2 * half[1] - jy) * (half[0] + 1) + std::min(jx, 2 * half[0] - jx);
                    const bool across_x = (ix > half[0]) != (jx > half[0]);
                    const bool across_y = (iy > half[1]) != (jy > half[1]);
                    const double sign = (anti_x && across_x) != (anti_y && across_y) ? -1.0 : 1.0;
                    value = 0.25 * sign * mirrored(response, ix > half[0], iy > half[1]) * C(from, to);
                });
                std::size_t at = 0;
                for (double& value : list_of(table, response)) value += pattern[at++];
            }
        }
    }
    return table;
}

PairTable inclusion_table(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group) {
    std::vector<Inclusion> inside;
    for (const int i : group) inside.push_back(model.inclusions[static_cast<std::size_t>(i)]);
    const GridLines lines = inclusion_lines(model, mesh, group);
    const VectorXd* lines_m[2] = {&lines.x_m, &lines.y_m};
    std::vector<int> sampled[2];
    Extent extent[2];
    for (std::size_t c = 0; c < 2; ++c) {
        extent[c] = extent_of(model, group, c);
        sampled[c] = inclusion_samples(model, mesh, group, c, *lines_m[c]);
    }

    std::vector<int> nodes;
    for (const int j : sampled[1]) {
        for (const int i : sampled[0]) nodes.push_back(surface_node(lines.x_m, lines.y_m, lines.z_m, i, j));
    }
    const auto solved = [&](std::span<const Inclusion> inclusions) {
        return compliance_of(model, block_problem(lines.x_m, lines.y_m, lines.z_m, model.tissue, inclusions), nodes);
    };
    const Compliance with = solved(inside);
    const Compliance without = solved({});

    PairTable table;
    std::vector<double> faded[2];
    for (std::size_t c = 0; c < 2; ++c) {
        for (const int i : sampled[c]) {
            (c == 0 ? table.x_m : table.y_m).push_back((*lines_m[c])(i));
            faded[c].push_back(fade((*lines_m[c])(i), extent[c].low_m, extent[c].high_m, mesh.reach_m));
        }
    }
    const std::array<double, 2> footprint = footprint_m(model);
    table.reach_x = reach_in_lines(table.x_m, 2.0 * footprint[0]);
    table.reach_y = reach_in_lines(table.y_m, 2.0 * footprint[1]);
    const auto n_x = static_cast<int>(table.x_m.size());
    const auto weight = [&](int ix, int iy) {
        return faded[0][static_cast<std::size_t>(ix)] * faded[1][static_cast<std::size_t>(iy)];
    };
    for (const Response response : responses(model)) {
        const Eigen::MatrixXd& to = matrix_of(with, response);
        const Eigen::MatrixXd& from = matrix_of(without, response);
        for_each_pair(table, list_of(table, response), [&](int ix, int iy, int jx, int jy, double& value) {
            const double change = to(iy * n_x + ix, jy * n_x + jx) - from(iy * n_x + ix, jy * n_x + jx);
            value = weight(ix, iy) * weight(jx, jy) * change;
        });
    }
    return table;
}

}  // namespace palpa::mechanics
