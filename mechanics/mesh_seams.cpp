#include "mechanics/mesh_seams.h"

#include <algorithm>
#include <cmath>
#include <unordered_map>

#include "mechanics/face_point.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Matrix3Xd;
using Eigen::Vector3d;

// Outer nodes, sorted into the cubes of a grid. A cube is as wide as the mean face.
struct Grid {
    Vector3d low_m;
    double width_m = 1.0;
    std::vector<int> nodes;
    std::unordered_map<std::uint64_t, std::vector<int>> at;
};

std::uint64_t key_of(const Eigen::Array3d& cube) {
    const auto part = [&](Index i) { return static_cast<std::uint64_t>(std::clamp(cube(i), 0.0, 2097151.0)); };
    return part(0) << 42 | part(1) << 21 | part(2);
}

Eigen::Array3d cube_of(const Grid& grid, const Vector3d& x_m) {
    return ((x_m - grid.low_m) / grid.width_m).array().floor();
}

Grid grid_of(const Mesh& mesh, const Faces& outer) {
    Grid grid;
    grid.low_m = mesh.nodes_m.rowwise().minCoeff();
    grid.nodes = nodes_of(outer);
    double sum_m = 0.0;
    for (Index f = 0; f < outer.cell.size(); ++f) {
        const Matrix3Xd x = corners_of_face_m(mesh, outer, f);
        sum_m += (x.rowwise().maxCoeff() - x.rowwise().minCoeff()).maxCoeff();
    }
    grid.width_m = sum_m / static_cast<double>(std::max<Index>(outer.cell.size(), 1));
    for (const int node : grid.nodes) {
        grid.at[key_of(cube_of(grid, mesh.nodes_m.col(node)))].push_back(node);
    }
    return grid;
}

// Calls `call` for every node that may be in the box. If the box covers more cubes than there are nodes, it calls it
// for all nodes.
template <class Call>
void each_near(const Grid& grid, const Vector3d& low_m, const Vector3d& high_m, Call&& call) {
    const Eigen::Array3d first = cube_of(grid, low_m);
    const Eigen::Array3d last = cube_of(grid, high_m);
    if ((last - first + 1.0).prod() > static_cast<double>(grid.nodes.size())) {
        for (const int node : grid.nodes) call(node);
        return;
    }
    for (double i = first(0); i <= last(0); ++i) {
        for (double j = first(1); j <= last(1); ++j) {
            for (double k = first(2); k <= last(2); ++k) {
                const auto it = grid.at.find(key_of({i, j, k}));
                if (it == grid.at.end()) continue;
                for (const int node : it->second) call(node);
            }
        }
    }
}

bool has_corner(const Mesh& mesh, int cell, int node) { return (mesh.cells.col(cell).array() == node).any(); }

int corner_at(const Mesh& mesh, const Faces& outer, Index face, int node, double reach_m) {
    for (Index k = 0; k < outer.corners.rows(); ++k) {
        const int corner = outer.corners(k, face);
        if ((mesh.nodes_m.col(corner) - mesh.nodes_m.col(node)).norm() <= reach_m) return corner;
    }
    return -1;
}

void once_each(std::vector<Seam>& list) {
    std::stable_sort(list.begin(), list.end(), [](const Seam& a, const Seam& b) { return a.node < b.node; });
    const auto same = [](const Seam& a, const Seam& b) { return a.node == b.node; };
    list.erase(std::unique(list.begin(), list.end(), same), list.end());
}

}  // namespace

Seams find_seams(const Mesh& mesh, const Faces& outer) {
    const Grid grid = grid_of(mesh, outer);
    Seams out;
    for (Index f = 0; f < outer.cell.size(); ++f) {
        const Matrix3Xd x = corners_of_face_m(mesh, outer, f);
        const Vector3d low = x.rowwise().minCoeff();
        const Vector3d high = x.rowwise().maxCoeff();
        const double reach_m = kSeam * (high - low).maxCoeff();
        const Vector3d margin = Vector3d::Constant(reach_m);
        each_near(grid, low - margin, high + margin, [&](int node) {
            const Vector3d place = mesh.nodes_m.col(node);
            if (((place - low).array() < -reach_m).any() || ((place - high).array() > reach_m).any()) return;
            const int cell = outer.cell(f);
            if (has_corner(mesh, cell, node)) return;  // corners of a flat cell lie near its other faces
            const int corner = corner_at(mesh, outer, f, node, reach_m);
            if (corner >= 0) {
                out.doubled.push_back({node, cell, corner});
            } else if (nearest_on_face(x, place).away_m <= reach_m) {
                out.hanging.push_back({node, cell, -1});
            }
        });
    }
    once_each(out.hanging);
    once_each(out.doubled);
    return out;
}

}  // namespace palpa::mechanics
