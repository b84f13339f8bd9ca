// One mesh of the whole block, graded around the tool: what rolling.h is measured against.

#include <algorithm>
#include <cmath>

#include "mechanics/rolling_mesh.h"

namespace palpa::mechanics {
namespace {

using Eigen::VectorXd;

constexpr double kReferenceGrowth = 1.4;  // of cells away from the tool

}  // namespace

std::vector<RollingForce> press_on_one_mesh(const RollingModel& model, double spacing_m, double cells_across,
                                            double x_m, double y_m, std::span<const double> depths_m) {
    check_model(model);
    const double at_m[2] = {x_m, y_m};
    const std::array<double, 2> half_m = footprint_m(model);
    std::array<double, 2> reach_m{};
    for (std::size_t c = 0; c < 2; ++c) reach_m[c] = std::ceil(half_m[c] / spacing_m - 1e-9) * spacing_m;
    // a cylinder ends in the middle between two nodes, as on the lattice
    if (model.shape == IndenterShape::cylinder) reach_m[1] = half_m[1] + 0.5 * spacing_m;
    constexpr double kNear = 0.5;  // of the thickness; inclusions farther to the side stay coarse
    VectorXd lines_m[2];
    std::vector<FineZone> deep{{0.0, 0.75 * spacing_m, 0.75 * spacing_m}};
    std::vector<FineZone> zones[2] = {{{x_m - reach_m[0], x_m + reach_m[0], spacing_m}},
                                      {{y_m - reach_m[1], y_m + reach_m[1], spacing_m}}};
    for (const Inclusion& inclusion : model.inclusions) {
        const Sphere& s = inclusion.sphere;
        if (std::hypot(s.centre_m[0] - x_m, s.centre_m[1] - y_m) > s.radius_m + kNear * model.size_m[2]) continue;
        const double cell_m = 2.0 * s.radius_m / cells_across;
        for (std::size_t c = 0; c < 2; ++c)
            zones[c].push_back({s.centre_m[c] - s.radius_m, s.centre_m[c] + s.radius_m, cell_m});
        const double middle_m = model.size_m[2] - s.centre_m[2];
        deep.push_back({middle_m - s.radius_m, middle_m + s.radius_m, cell_m});
    }
    for (std::size_t c = 0; c < 2; ++c)
        lines_m[c] = zoned_coordinates_m(model.size_m[c], zones[c], kReferenceGrowth, 0.4 * model.size_m[2]);
    const VectorXd z_m = heights_from_depths(
        zoned_coordinates_m(model.size_m[2], deep, kReferenceGrowth, 0.15 * model.size_m[2]), model.size_m[2]);
    const Problem problem = block_problem(lines_m[0], lines_m[1], z_m, model.tissue, model.inclusions);
    SurfaceRequest request;
    for (int j = 0; j < lines_m[1].size(); ++j) {
        for (int i = 0; i < lines_m[0].size(); ++i) {
            const double dx = lines_m[0](i) - at_m[0];
            const double dy = lines_m[1](j) - at_m[1];
            const bool under = model.shape == IndenterShape::sphere
                                   ? std::hypot(dx, dy) < model.radius_m
                                   : std::abs(dx) < half_m[0] && std::abs(dy) < half_m[1];
            if (under) {
                request.touch_nodes.push_back(surface_node(lines_m[0], lines_m[1], z_m, i, j));
            }
        }
    }
    request.sideways = model.friction > 0.0;
    const Compliance compliance = surface_compliance(problem.mesh, factorise(problem, best_solver()), request);
    RollingWork work;
    std::vector<RollingForce> out;
    for (const double depth_m : depths_m) {
        const Tool tool{indenter_of(model), {x_m, y_m, depth_m}};
        out.push_back(force_at(model, compliance, tool, work));
    }
    return out;
}

}  // namespace palpa::mechanics
