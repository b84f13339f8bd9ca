// The finite element part of rolling.h: one column or one window of columns each.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/error.h"
#include "mechanics/rolling_mesh.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kGrowth = 1.2;      // of cells below a load
constexpr double kWindowGrowth = 1.3;  // of cells away from inclusions
constexpr double kFarOut = 6.0;      // thicknesses of layer around a load: its effect has died away
constexpr double kReferenceGrowth = 1.4;  // of cells away from the tool on the one mesh
constexpr int kMostInPatch = 600;    // contact nodes under the tool
constexpr int kMostSideCells = 60;   // of S over half the block
constexpr double kFadeFrom = 0.65;   // of the reach

double tool_reach_m(const RollingModel& model) {
    const double d = std::min(model.greatest_depth_m, model.radius_m);
    return std::sqrt(d * (2.0 * model.radius_m - d));
}

void check_model(const RollingModel& model) {
    std::vector<Material> materials{model.tissue};
    for (const Inclusion& inclusion : model.inclusions) materials.push_back(inclusion.material);
    check_materials(materials);
    if (!(*std::min_element(model.size_m.begin(), model.size_m.end()) > 0.0) || !(model.radius_m > 0.0)) {
        throw LoadError(text("rolling: block of ", model.size_m[0], " x ", model.size_m[1], " x ", model.size_m[2],
                             " m, sphere of ", model.radius_m, " m; all must be > 0"));
    }
    if (!(model.least_depth_m > 0.0) || model.greatest_depth_m < model.least_depth_m ||
        model.greatest_depth_m >= model.size_m[2]) {
        throw LoadError(text("rolling: depths ", model.least_depth_m, " to ", model.greatest_depth_m,
                             " m; must be > 0 and less than the thickness, ", model.size_m[2], " m"));
    }
    for (std::size_t i = 0; i < model.inclusions.size(); ++i) {
        const Sphere& a = model.inclusions[i].sphere;
        for (std::size_t c = 0; c < 3; ++c) {
            if (a.centre_m[c] >= a.radius_m && a.centre_m[c] + a.radius_m <= model.size_m[c]) continue;
            throw LoadError(text("rolling: inclusion ", i, " reaches out of the block"));
        }
        for (std::size_t j = 0; j < i; ++j) {
            const Sphere& b = model.inclusions[j].sphere;
            const double apart_m = std::hypot(a.centre_m[0] - b.centre_m[0], a.centre_m[1] - b.centre_m[1],
                                              a.centre_m[2] - b.centre_m[2]);
            if (apart_m >= a.radius_m + b.radius_m) continue;
            throw LoadError(text("rolling: inclusions ", j, " and ", i, " overlap: centres ", apart_m, " m apart, radii ",
                                 b.radius_m, " and ", a.radius_m, " m"));
        }
    }
}

Eigen::MatrixXd compliance_of(const Problem& problem, std::vector<int> nodes) {
    SurfaceRequest request;
    request.touch_nodes = std::move(nodes);
    return surface_compliance(problem.mesh, factorise(problem, best_solver()), request).normal_m_per_N;
}

// Nodes of the plane at the far end of an axis.
std::vector<int> end_plane(const Problem& problem, int axis) {
    std::vector<int> nodes;
    const double end_m = problem.mesh.nodes_m.row(axis).maxCoeff();
    for (Index i = 0; i < problem.mesh.nodes_m.cols(); ++i) {
        if (problem.mesh.nodes_m(axis, i) >= end_m) nodes.push_back(static_cast<int>(i));
    }
    return nodes;
}

// The layer under a load at the corner of its quarter, where both planes of symmetry meet.
LayerKernel layer_kernel(const RollingModel& model, const std::array<double, 2>& spacing_m, int n, int uniform,
                         const VectorXd& z_m) {
    const double far_m = kFarOut * model.size_m[2] + uniform * std::max(spacing_m[0], spacing_m[1]);
    const VectorXd x_m = outward_coordinates_m(spacing_m[0], uniform, 1.3, far_m);
    const VectorXd y_m = outward_coordinates_m(spacing_m[1], uniform, 1.3, far_m);
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
    request.touch_nodes = {surface_node(x_m, y_m, z_m, 0, 0)};
    for (int j = 0; j < n; ++j) {
        for (int i = 0; i < n; ++i) {
            if (i + j > 0) request.other_nodes.push_back(surface_node(x_m, y_m, z_m, i, j));
        }
    }
    const Compliance column = surface_compliance(problem.mesh, factored, request);
    LayerKernel kernel{spacing_m, n, {}};
    // a quarter of the load stands on this quarter of the layer
    for (Index i = 0; i < column.normal_m_per_N.rows(); ++i) kernel.value.push_back(0.25 * column.normal_m_per_N(i, 0));
    return kernel;
}

VectorXd side_heights(const RollingModel& model, const RollingMesh& mesh) {
    const double first_m = 0.6 * std::min(mesh.surface_m[0], mesh.surface_m[1]);
    return heights_from_depths(outward_coordinates_m(first_m, 1, kGrowth, model.size_m[2]), model.size_m[2]);
}

// Surface compliance of a quarter of the block between all its surface nodes; mirrored planes either
// symmetric or antisymmetric.
Eigen::MatrixXd quarter_compliance(const RollingModel& model, const VectorXd& x_m, const VectorXd& y_m,
                                   const VectorXd& z_m, const std::array<bool, 2>& antisymmetric) {
    Problem problem = block_problem(x_m, y_m, z_m, model.tissue, {});
    for (int axis = 0; axis < 2; ++axis) {
        const bool anti = antisymmetric[static_cast<std::size_t>(axis)];
        fix(end_plane(problem, axis), axis == 0 ? (anti ? "yz" : "x") : (anti ? "xz" : "y"), 0.0, problem.supports);
    }
    std::vector<int> nodes;
    for (int j = 0; j < y_m.size(); ++j) {
        for (int i = 0; i < x_m.size(); ++i) nodes.push_back(surface_node(x_m, y_m, z_m, i, j));
    }
    return compliance_of(problem, std::move(nodes));
}

// Sample lines needed so that all stencils of two points under one tool are stored.
int reach_in_lines(const std::vector<double>& lines_m, double width_m) {
    std::size_t most = 0;
    for (std::size_t i = 0, end = 0; i < lines_m.size(); ++i) {
        while (end < lines_m.size() && lines_m[end] < lines_m[i] + width_m) ++end;
        most = std::max(most, end - i);
    }
    return std::min(static_cast<int>(most) + 3, static_cast<int>(lines_m.size()) - 1);
}

// Calls f(ix, iy, jx, jy, value) for every pair that the table stores.
template <class F>
void for_each_pair(PairTable& table, F&& f) {
    const int n_x = static_cast<int>(table.x_m.size());
    const int n_y = static_cast<int>(table.y_m.size());
    const int w_x = 2 * table.reach_x + 1;
    const int w_y = 2 * table.reach_y + 1;
    table.value.assign(static_cast<std::size_t>(n_x) * static_cast<std::size_t>(n_y * w_x * w_y), 0.0);
    std::size_t at = 0;
    for (int iy = 0; iy < n_y; ++iy) {
        for (int ix = 0; ix < n_x; ++ix) {
            for (int jy = iy - table.reach_y; jy <= iy + table.reach_y; ++jy) {
                for (int jx = ix - table.reach_x; jx <= ix + table.reach_x; ++jx, ++at) {
                    if (jx >= 0 && jx < n_x && jy >= 0 && jy < n_y) f(ix, iy, jx, jy, table.value[at]);
                }
            }
        }
    }
}

// 1 near the inclusions, 0 from `reach` on; where the window is cut by a side of the block it stays 1.
double fade(double at_m, double low_m, double high_m, double reach_m) {
    const double beyond_m = std::max({0.0, low_m - at_m, at_m - high_m});
    const double s = std::clamp((beyond_m / reach_m - kFadeFrom) / (1.0 - kFadeFrom), 0.0, 1.0);
    return 0.5 * (1.0 + std::cos(std::numbers::pi * s));
}

struct Extent {
    double low_m = 1e300;
    double high_m = -1e300;
};
Extent extent_of(const RollingModel& model, const std::vector<int>& group, std::size_t axis) {
    Extent out;
    for (const int i : group) {
        const Sphere& sphere = model.inclusions[static_cast<std::size_t>(i)].sphere;
        out.low_m = std::min(out.low_m, sphere.centre_m[axis] - sphere.radius_m);
        out.high_m = std::max(out.high_m, sphere.centre_m[axis] + sphere.radius_m);
    }
    return out;
}

// Lines of the mesh over the window, not closer than `least_m`; counted from its middle to both sides, so that a
// mirrored window has mirrored lines.
std::vector<int> sample_lines(const VectorXd& lines_m, double low_m, double high_m, double least_m) {
    int first = 0;
    int last = static_cast<int>(lines_m.size()) - 1;
    while (first + 1 < last && lines_m(first + 1) <= low_m) ++first;
    while (last - 1 > first && lines_m(last - 1) >= high_m) --last;
    Index middle = 0;
    (lines_m.array() - 0.5 * (low_m + high_m)).abs().minCoeff(&middle);
    std::vector<int> out{std::clamp(static_cast<int>(middle), first, last)};
    for (int i = out.front() - 1; i >= first; --i) {
        if (lines_m(out.front()) - lines_m(i) >= least_m || i == first) out.insert(out.begin(), i);
    }
    for (int i = out.back() + 1; i <= last; ++i) {
        if (lines_m(i) - lines_m(out.back()) >= least_m || i == last) out.push_back(i);
    }
    return out;
}

}  // namespace

RollingMesh choose_rolling_mesh(const RollingModel& model, double coarseness) {
    check_model(model);
    RollingMesh mesh;
    const double contact_radius_m = std::sqrt(model.radius_m * std::min(model.least_depth_m, model.radius_m));
    const double least_m = tool_reach_m(model) * std::sqrt(std::numbers::pi / kMostInPatch);
    mesh.contact_m = std::max(contact_radius_m / 4.35 * coarseness, least_m);
    for (std::size_t c = 0; c < 2; ++c) {
        const double half_m = 0.5 * model.size_m[c];
        const double cells = std::ceil(half_m / (model.size_m[2] / 12.0 * coarseness));
        mesh.surface_m[c] = half_m / std::clamp(cells, 4.0, static_cast<double>(kMostSideCells));
    }
    mesh.cells_across = std::max(2.0, 8.0 / coarseness);
    mesh.reach_m = 0.8 * model.size_m[2];
    return mesh;
}

LayerKernel contact_kernel(const RollingModel& model, const RollingMesh& mesh) {
    const double h = mesh.contact_m;
    const int n = static_cast<int>(2.0 * model.radius_m / h) + 2;
    const VectorXd z_m =
        heights_from_depths(outward_coordinates_m(0.75 * h, 1, kGrowth, model.size_m[2]), model.size_m[2]);
    return layer_kernel(model, {h, h}, n, n, z_m);
}

PairTable side_table(const RollingModel& model, const RollingMesh& mesh) {
    int half[2];
    VectorXd lines_m[2];
    for (int c = 0; c < 2; ++c) {
        const double half_m = 0.5 * model.size_m[static_cast<std::size_t>(c)];
        half[c] = static_cast<int>(std::lround(half_m / mesh.surface_m[static_cast<std::size_t>(c)]));
        lines_m[c] = VectorXd::LinSpaced(half[c] + 1, 0.0, half_m);
    }
    const VectorXd z_m = side_heights(model, mesh);
    const LayerKernel plain =
        layer_kernel(model, mesh.surface_m, std::max(half[0], half[1]) + 1, std::max(half[0], half[1]), z_m);

    PairTable table;
    for (int i = 0; i <= 2 * half[0]; ++i) table.x_m.push_back(mesh.surface_m[0] * i);
    for (int j = 0; j <= 2 * half[1]; ++j) table.y_m.push_back(mesh.surface_m[1] * j);
    table.reach_x = std::min(reach_in_lines(table.x_m, 2.0 * model.radius_m), half[0]);
    table.reach_y = std::min(reach_in_lines(table.y_m, 2.0 * model.radius_m), half[1]);
    for_each_pair(table, [&](int ix, int iy, int jx, int jy, double& value) {
        value = -plain.value[static_cast<std::size_t>(std::abs(jy - iy) * plain.n + std::abs(jx - ix))];
    });
    // a load is a quarter of the sum of its four mirrored patterns
    for (const bool anti_x : {false, true}) {
        for (const bool anti_y : {false, true}) {
            const Eigen::MatrixXd C = quarter_compliance(model, lines_m[0], lines_m[1], z_m, {anti_x, anti_y});
            std::size_t at = 0;
            PairTable copy = table;
            for_each_pair(copy, [&](int ix, int iy, int jx, int jy, double& value) {
                const int from = std::min(iy, 2 * half[1] - iy) * (half[0] + 1) + std::min(ix, 2 * half[0] - ix);
                const int to = std::min(jy, 2 * half[1] - jy) * (half[0] + 1) + std::min(jx, 2 * half[0] - jx);
                const bool across_x = (ix > half[0]) != (jx > half[0]);
                const bool across_y = (iy > half[1]) != (jy > half[1]);
                const double sign = (anti_x && across_x) != (anti_y && across_y) ? -1.0 : 1.0;
                value = 0.25 * sign * C(from, to);
            });
            for (double& value : table.value) value += copy.value[at++];
        }
    }
    return table;
}

std::vector<std::vector<int>> inclusion_groups(const RollingModel& model, const RollingMesh& mesh) {
    const int n = static_cast<int>(model.inclusions.size());
    std::vector<int> group_of(static_cast<std::size_t>(n));
    for (int i = 0; i < n; ++i) group_of[static_cast<std::size_t>(i)] = i;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < i; ++j) {
            const Sphere& a = model.inclusions[static_cast<std::size_t>(i)].sphere;
            const Sphere& b = model.inclusions[static_cast<std::size_t>(j)].sphere;
            const double apart_m = std::hypot(a.centre_m[0] - b.centre_m[0], a.centre_m[1] - b.centre_m[1]);
            if (apart_m - a.radius_m - b.radius_m >= mesh.reach_m) continue;
            const int from = group_of[static_cast<std::size_t>(i)];
            const int to = group_of[static_cast<std::size_t>(j)];
            for (int& g : group_of) g = g == std::max(from, to) ? std::min(from, to) : g;
        }
    }
    std::vector<std::vector<int>> groups;
    for (int g = 0; g < n; ++g) {
        std::vector<int> members;
        for (int i = 0; i < n; ++i) {
            if (group_of[static_cast<std::size_t>(i)] == g) members.push_back(i);
        }
        if (!members.empty()) groups.push_back(members);
    }
    return groups;
}

PairTable inclusion_table(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group) {
    std::vector<Inclusion> inside;
    for (const int i : group) inside.push_back(model.inclusions[static_cast<std::size_t>(i)]);
    VectorXd lines_m[2];
    std::vector<int> sampled[2];
    Extent extent[2];
    for (std::size_t c = 0; c < 2; ++c) {
        std::vector<FineZone> zones;
        for (const Inclusion& i : inside) {
            const Sphere& s = i.sphere;
            zones.push_back({s.centre_m[c] - s.radius_m, s.centre_m[c] + s.radius_m, 2.0 * s.radius_m / mesh.cells_across});
        }
        extent[c] = extent_of(model, group, c);
        lines_m[c] = zoned_coordinates_m(model.size_m[c], zones, kWindowGrowth, 0.4 * model.size_m[2]);
        sampled[c] = sample_lines(lines_m[c], extent[c].low_m - mesh.reach_m, extent[c].high_m + mesh.reach_m,
                                  model.size_m[2] / 16.0);
    }
    std::vector<FineZone> deep;
    for (const Inclusion& i : inside) {
        const double middle_m = model.size_m[2] - i.sphere.centre_m[2];
        deep.push_back({middle_m - i.sphere.radius_m, middle_m + i.sphere.radius_m,
                        2.0 * i.sphere.radius_m / mesh.cells_across});
    }
    const VectorXd z_m = heights_from_depths(
        zoned_coordinates_m(model.size_m[2], deep, kWindowGrowth, 0.2 * model.size_m[2]), model.size_m[2]);

    std::vector<int> nodes;
    for (const int j : sampled[1]) {
        for (const int i : sampled[0]) nodes.push_back(surface_node(lines_m[0], lines_m[1], z_m, i, j));
    }
    const Eigen::MatrixXd with = compliance_of(block_problem(lines_m[0], lines_m[1], z_m, model.tissue, inside), nodes);
    const Eigen::MatrixXd without = compliance_of(block_problem(lines_m[0], lines_m[1], z_m, model.tissue, {}), nodes);

    PairTable table;
    std::vector<double> faded[2];
    for (std::size_t c = 0; c < 2; ++c) {
        for (const int i : sampled[c]) {
            (c == 0 ? table.x_m : table.y_m).push_back(lines_m[c](i));
            faded[c].push_back(fade(lines_m[c](i), extent[c].low_m, extent[c].high_m, mesh.reach_m));
        }
    }
    table.reach_x = reach_in_lines(table.x_m, 2.0 * model.radius_m);
    table.reach_y = reach_in_lines(table.y_m, 2.0 * model.radius_m);
    const auto n_x = static_cast<int>(table.x_m.size());
    const auto weight = [&](int ix, int iy) {
        return faded[0][static_cast<std::size_t>(ix)] * faded[1][static_cast<std::size_t>(iy)];
    };
    for_each_pair(table, [&](int ix, int iy, int jx, int jy, double& value) {
        const double change = with(iy * n_x + ix, jy * n_x + jx) - without(iy * n_x + ix, jy * n_x + jx);
        value = weight(ix, iy) * weight(jx, jy) * change;
    });
    return table;
}

std::vector<RollingForce> press_on_one_mesh(const RollingModel& model, double spacing_m, double cells_across,
                                            double x_m, double y_m, std::span<const double> depths_m) {
    check_model(model);
    const double at_m[2] = {x_m, y_m};
    const double reach_m = std::ceil(model.radius_m / spacing_m) * spacing_m;
    constexpr double kNear = 0.5;  // of the thickness: inclusions farther to the side stay coarse
    VectorXd lines_m[2];
    std::vector<FineZone> deep{{0.0, 0.75 * spacing_m, 0.75 * spacing_m}};
    std::vector<FineZone> zones[2] = {{{x_m - reach_m, x_m + reach_m, spacing_m}}, {{y_m - reach_m, y_m + reach_m, spacing_m}}};
    for (const Inclusion& inclusion : model.inclusions) {
        const Sphere& s = inclusion.sphere;
        if (std::hypot(s.centre_m[0] - x_m, s.centre_m[1] - y_m) > s.radius_m + kNear * model.size_m[2]) continue;
        const double cell_m = 2.0 * s.radius_m / cells_across;
        for (std::size_t c = 0; c < 2; ++c) zones[c].push_back({s.centre_m[c] - s.radius_m, s.centre_m[c] + s.radius_m, cell_m});
        const double middle_m = model.size_m[2] - s.centre_m[2];
        deep.push_back({middle_m - s.radius_m, middle_m + s.radius_m, cell_m});
    }
    for (std::size_t c = 0; c < 2; ++c) lines_m[c] = zoned_coordinates_m(model.size_m[c], zones[c], kReferenceGrowth, 0.4 * model.size_m[2]);
    const VectorXd z_m = heights_from_depths(
        zoned_coordinates_m(model.size_m[2], deep, kReferenceGrowth, 0.15 * model.size_m[2]), model.size_m[2]);
    const Problem problem = block_problem(lines_m[0], lines_m[1], z_m, model.tissue, model.inclusions);
    SurfaceRequest request;
    for (int j = 0; j < lines_m[1].size(); ++j) {
        for (int i = 0; i < lines_m[0].size(); ++i) {
            if (std::hypot(lines_m[0](i) - at_m[0], lines_m[1](j) - at_m[1]) < model.radius_m) {
                request.touch_nodes.push_back(surface_node(lines_m[0], lines_m[1], z_m, i, j));
            }
        }
    }
    const Compliance compliance = surface_compliance(problem.mesh, factorise(problem, best_solver()), request);
    ContactWork work = make_contact_work(compliance, compliance.n_touch);
    Contact contact;
    std::vector<RollingForce> out;
    for (const double depth_m : depths_m) {
        const Tool tool{{IndenterShape::sphere, model.radius_m}, {x_m, y_m, depth_m}};
        press_to_depth(compliance, {&tool, 1}, {}, work, contact);
        const ToolForce& f = contact.tool[0];
        out.push_back({f.normal_N, f.tangential_x_N, f.tangential_y_N, contact.energy_J, f.area_m2});
    }
    return out;
}

}  // namespace palpa::mechanics
