// The coordinates of the mesh lines that the tables of rolling.h are computed on.

#include <algorithm>
#include <cmath>

#include "mechanics/rolling_mesh.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::VectorXd;

constexpr double kGrowth = 1.2;        // of cells below a load
constexpr double kWindowGrowth = 1.3;  // of cells away from inclusions
constexpr double kFarOut = 6.0;        // thicknesses of layer around a load, beyond which it has no effect

// Returns the lines of a quarter of the layer with the load at its corner. uniform: numbers of cells of the given
// spacing along x and y, next to the load.
GridLines layer_lines(const RollingModel& model, const std::array<double, 2>& spacing_m,
                      const std::array<int, 2>& uniform, VectorXd z_m) {
    const double far_m =
        kFarOut * model.size_m[2] + std::max(uniform[0], uniform[1]) * std::max(spacing_m[0], spacing_m[1]);
    return {outward_coordinates_m(spacing_m[0], uniform[0], kWindowGrowth, far_m),
            outward_coordinates_m(spacing_m[1], uniform[1], kWindowGrowth, far_m), std::move(z_m)};
}

// Returns lines along one axis that are fine over every inclusion of the group. centre_m(sphere): the sphere's centre
// along the axis.
template <class Centre>
VectorXd group_lines_m(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group,
                       double length_m, double most_m, Centre&& centre_m) {
    std::vector<FineZone> zones;
    for (const int i : group) {
        const Sphere& s = model.inclusions[static_cast<std::size_t>(i)].sphere;
        const double middle_m = centre_m(s);
        zones.push_back({middle_m - s.radius_m, middle_m + s.radius_m, 2.0 * s.radius_m / mesh.cells_across});
    }
    return zoned_coordinates_m(length_m, zones, kWindowGrowth, most_m);
}

// Returns which lines of the mesh are sample lines over the window, not closer than `least_m`. They are chosen from the
// middle to both sides, so that a mirrored window has mirrored lines.
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

Extent extent_of(const RollingModel& model, const std::vector<int>& group, std::size_t axis) {
    Extent out;
    for (const int i : group) {
        const Sphere& sphere = model.inclusions[static_cast<std::size_t>(i)].sphere;
        out.low_m = std::min(out.low_m, sphere.centre_m[axis] - sphere.radius_m);
        out.high_m = std::max(out.high_m, sphere.centre_m[axis] + sphere.radius_m);
    }
    return out;
}

std::array<int, 2> contact_offsets(const RollingModel& model, const RollingMesh& mesh) {
    const double h = mesh.contact_m;
    const std::array<double, 2> half_m = footprint_m(model);
    return {static_cast<int>(2.0 * half_m[0] / h) + 2, static_cast<int>(2.0 * half_m[1] / h) + 2};
}

GridLines contact_lines(const RollingModel& model, const RollingMesh& mesh) {
    const double h = mesh.contact_m;
    return layer_lines(
        model, {h, h}, contact_offsets(model, mesh),
        heights_from_depths(outward_coordinates_m(0.75 * h, 1, kGrowth, model.size_m[2]), model.size_m[2]));
}

GridLines side_lines(const RollingModel& model, const RollingMesh& mesh) {
    GridLines out;
    for (std::size_t c = 0; c < 2; ++c) {
        const double half_m = 0.5 * model.size_m[c];
        (c == 0 ? out.x_m : out.y_m) = VectorXd::LinSpaced(std::lround(half_m / mesh.surface_m[c]) + 1, 0.0, half_m);
    }
    const double first_m = 0.6 * std::min(mesh.surface_m[0], mesh.surface_m[1]);
    out.z_m = heights_from_depths(outward_coordinates_m(first_m, 1, kGrowth, model.size_m[2]), model.size_m[2]);
    return out;
}

GridLines side_layer_lines(const RollingModel& model, const RollingMesh& mesh) {
    GridLines block = side_lines(model, mesh);
    const int most = static_cast<int>(std::max(block.x_m.size(), block.y_m.size())) - 1;
    return layer_lines(model, mesh.surface_m, {most, most}, std::move(block.z_m));
}

GridLines inclusion_lines(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group) {
    const double thickness_m = model.size_m[2];
    const auto along = [&](std::size_t c) {
        return group_lines_m(model, mesh, group, model.size_m[c], 0.4 * thickness_m,
                             [c](const Sphere& s) { return s.centre_m[c]; });
    };
    const VectorXd depth_m = group_lines_m(model, mesh, group, thickness_m, 0.2 * thickness_m,
                                           [&](const Sphere& s) { return thickness_m - s.centre_m[2]; });
    return {along(0), along(1), heights_from_depths(depth_m, thickness_m)};
}

std::vector<int> inclusion_samples(const RollingModel& model, const RollingMesh& mesh, const std::vector<int>& group,
                                   std::size_t axis, const VectorXd& lines_m) {
    const Extent extent = extent_of(model, group, axis);
    return sample_lines(lines_m, extent.low_m - mesh.reach_m, extent.high_m + mesh.reach_m, model.size_m[2] / 16.0);
}

}  // namespace palpa::mechanics
