// Checks whether a model of rolling.h can be computed, and chooses how fine its meshes are.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/error.h"
#include "mechanics/rolling_mesh.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

constexpr int kMostInPatch = 600;        // contact nodes under the tool
constexpr double kMostSideCells = 60.0;  // of the mesh of S, over half the block
constexpr double kShortest = 0.25;       // length of a cylinder, in spacings

double tool_reach_m(const RollingModel& model) {
    const double d = std::min(model.greatest_depth_m, model.radius_m);
    return std::sqrt(d * (2.0 * model.radius_m - d));
}

// Returns the spacing at which about kMostInPatch nodes are under the tool.
double least_spacing_m(const RollingModel& model) {
    if (model.shape == IndenterShape::sphere) return tool_reach_m(model) * std::sqrt(std::numbers::pi / kMostInPatch);
    const std::array<double, 2> half_m = footprint_m(model);
    return std::sqrt(4.0 * half_m[0] * half_m[1] / kMostInPatch);
}

}  // namespace

void check_model(const RollingModel& model) {
    std::vector<Material> materials{model.tissue};
    for (const Inclusion& inclusion : model.inclusions) materials.push_back(inclusion.material);
    check_materials(materials);
    if (!(*std::min_element(model.size_m.begin(), model.size_m.end()) > 0.0) || !(model.radius_m > 0.0)) {
        throw LoadError(text("rolling: block of ", model.size_m[0], " x ", model.size_m[1], " x ", model.size_m[2],
                             " m, indenter of ", model.radius_m, " m; all must be > 0"));
    }
    if (model.shape == IndenterShape::cylinder && !(model.length_m > 0.0 && std::isfinite(model.length_m))) {
        throw LoadError(text("rolling: cylinder of ", model.length_m, " m length; must be finite and > 0"));
    }
    if (!(model.friction >= 0.0) || !std::isfinite(model.friction)) {
        throw LoadError(text("rolling: friction coefficient ", model.friction, "; must be finite and >= 0"));
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
            const double apart_m =
                std::hypot(a.centre_m[0] - b.centre_m[0], a.centre_m[1] - b.centre_m[1], a.centre_m[2] - b.centre_m[2]);
            if (apart_m >= a.radius_m + b.radius_m) continue;
            throw LoadError(text("rolling: inclusions ", j, " and ", i, " overlap: centres ", apart_m,
                                 " m apart, radii ", b.radius_m, " and ", a.radius_m, " m"));
        }
    }
}

std::array<double, 2> footprint_m(const RollingModel& model) {
    if (model.shape == IndenterShape::sphere) return {model.radius_m, model.radius_m};
    const double R = model.radius_m;
    const double d = std::min(2.0 * model.greatest_depth_m, R);
    return {std::sqrt(d * (2.0 * R - d)), 0.5 * model.length_m};
}

Indenter indenter_of(const RollingModel& model) {
    if (model.shape == IndenterShape::sphere) return {model.shape, model.radius_m};
    return {model.shape, model.radius_m, model.length_m};
}

RollingMesh choose_rolling_mesh(const RollingModel& model, double coarseness) {
    check_model(model);
    RollingMesh mesh;
    const double contact_radius_m = std::sqrt(model.radius_m * std::min(model.least_depth_m, model.radius_m));
    mesh.contact_m = coarseness * std::max(contact_radius_m / 4.35, least_spacing_m(model));
    if (model.shape == IndenterShape::cylinder) {
        // so that each row of nodes stands for one of equal cells along the cylinder
        // and coarser meshes have fewer, so that their difference tells an error
        const double usual = std::ceil(model.length_m * coarseness / mesh.contact_m - 1e-9);
        const double cells = coarseness > 1.0 ? std::max(1.0, std::round(usual / coarseness))
                                              : std::ceil(model.length_m / mesh.contact_m - 1e-9);
        if (model.length_m < kShortest * mesh.contact_m) {
            throw LoadError(text("rolling: cylinder of ", 1e3 * model.length_m, " mm length; must be at least ",
                                 1e3 * kShortest * mesh.contact_m, " mm, a quarter of the nodes' spacing under it"));
        }
        mesh.contact_m = model.length_m / cells;
    }
    for (std::size_t c = 0; c < 2; ++c) {
        const double half_m = 0.5 * model.size_m[c];
        const double cells = std::clamp(std::ceil(half_m / (model.size_m[2] / 12.0)), 4.0, kMostSideCells);
        mesh.surface_m[c] = half_m / std::clamp(std::ceil(cells / coarseness - 1e-9), 3.0, kMostSideCells);
    }
    mesh.cells_across = std::max(2.0, 8.0 / coarseness);
    mesh.reach_m = 0.8 * model.size_m[2];
    return mesh;
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

}  // namespace palpa::mechanics
