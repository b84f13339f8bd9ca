#include "mechanics/mesh_check.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <algorithm>
#include <cmath>
#include <numbers>
#include <numeric>

#include "mechanics/elements.h"
#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

std::string first_few(const Mesh& mesh, const std::vector<int>& cells) {
    std::string out;
    for (std::size_t i = 0; i < std::min<std::size_t>(cells.size(), 8); ++i)
        out += text(i == 0 ? "" : ", ", number_of_cell(mesh, cells[i]));
    if (cells.size() > 8) out += text(", ... (", cells.size(), " in all)");
    return out;
}

void check_numbers(const Mesh& mesh) {
    if (mesh.cells.cols() == 0 || (mesh.cells.rows() != 8 && mesh.cells.rows() != 4)) {
        throw MeshError(text("mesh: ", mesh.cells.cols(), " cells of ", mesh.cells.rows(),
                             " corners; wanted at least one, of 8 or 4"),
                        {});
    }
    if (mesh.region.size() != mesh.cells.cols()) {
        throw MeshError(text("mesh: ", mesh.region.size(), " regions for ", mesh.cells.cols(), " cells"), {});
    }
    std::vector<int> bad;
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        const auto corners = mesh.cells.col(cell).array();
        if ((corners < 0).any() || (corners >= static_cast<int>(mesh.nodes_m.cols())).any())
            bad.push_back(static_cast<int>(cell));
    }
    if (!bad.empty()) {
        throw MeshError(
            text("mesh: node numbers outside 0..", mesh.nodes_m.cols() - 1, " in cells ", first_few(mesh, bad)), bad);
    }
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        for (Index k = 0; k < mesh.cells.rows(); ++k) {
            if (mesh.nodes_m.col(mesh.cells(k, cell)).allFinite()) continue;
            bad.push_back(static_cast<int>(cell));
            break;
        }
    }
    if (!bad.empty())
        throw MeshError(text("mesh: coordinates that are not finite in cells ", first_few(mesh, bad)), bad);
}

Tet tet_corners(const Mesh& mesh, Index cell) {
    Tet corners;
    for (int k = 0; k < 4; ++k) corners.col(k) = mesh.nodes_m.col(mesh.cells(k, cell));
    return corners;
}

Hex hex_corners(const Mesh& mesh, Index cell) {
    Hex corners;
    for (int k = 0; k < 8; ++k) corners.col(k) = mesh.nodes_m.col(mesh.cells(k, cell));
    return corners;
}

double det_of(const Vector3d& a, const Vector3d& b, const Vector3d& c) { return a.dot(b.cross(c)); }

CellQuality hex_quality(const Hex& x) {
    // the three edges that leave each corner, right-handed
    constexpr std::array<std::array<int, 3>, 8> kNext{
        {{1, 3, 4}, {2, 0, 5}, {3, 1, 6}, {0, 2, 7}, {7, 5, 0}, {4, 6, 1}, {5, 7, 2}, {6, 4, 3}}};
    double worst = std::numeric_limits<double>::infinity();
    double bricks = 0.0;  // mean volume of the bricks with the edge lengths of each corner
    for (int k = 0; k < 8; ++k) {
        const auto& next = kNext[static_cast<std::size_t>(k)];
        const Vector3d a = x.col(next[0]) - x.col(k);
        const Vector3d b = x.col(next[1]) - x.col(k);
        const Vector3d c = x.col(next[2]) - x.col(k);
        worst = std::min(worst, det_of(a, b, c));
        bricks += a.norm() * b.norm() * c.norm() / 8.0;
    }
    for (int g = 0; g < 8; ++g) worst = std::min(worst, 8.0 * hex_point(x, g).volume_m3);
    return {worst / bricks, 90.0, 1.0};
}

CellQuality tet_quality(const Tet& x) {
    constexpr std::array<std::array<int, 2>, 6> kEdges{{{0, 1}, {0, 2}, {0, 3}, {1, 2}, {1, 3}, {2, 3}}};
    double longest = 0.0;
    for (const auto& e : kEdges) longest = std::max(longest, (x.col(e[1]) - x.col(e[0])).norm());
    const Vector3d a = x.col(1) - x.col(0);
    const Vector3d b = x.col(2) - x.col(0);
    const Vector3d c = x.col(3) - x.col(0);
    const double det = det_of(a, b, c);

    // outward normals, each as long as twice its face's area; they give the angles between faces
    Eigen::Matrix<double, 3, 4> n;
    n.col(0) = (x.col(2) - x.col(1)).cross(x.col(3) - x.col(1));
    n.col(1) = c.cross(b);
    n.col(2) = a.cross(c);
    n.col(3) = b.cross(a);
    double min_angle = std::numbers::pi;
    for (const auto& e : kEdges) {
        const Vector3d p = n.col(e[0]);
        const Vector3d q = n.col(e[1]);
        min_angle = std::min(min_angle, std::atan2(p.cross(q).norm(), -p.dot(q)));
    }
    // r_in = det / sum of |n|;  r_out = | |a|^2 b x c + |b|^2 c x a + |c|^2 a x b | / (2 det)
    const double r_in = det / n.colwise().norm().sum();
    const Vector3d to_centre =
        a.squaredNorm() * b.cross(c) + b.squaredNorm() * c.cross(a) + c.squaredNorm() * a.cross(b);
    const double r_out = to_centre.norm() / (2.0 * std::abs(det));
    return {det / std::pow(longest, 3), min_angle * 180.0 / std::numbers::pi, det == 0.0 ? 0.0 : 3.0 * r_in / r_out};
}

// Union-find: returns the root of cell i, and shortens the way there.
int root_of(std::vector<int>& parent, int i) {
    while (parent[static_cast<std::size_t>(i)] != i) {
        int& up = parent[static_cast<std::size_t>(i)];
        up = parent[static_cast<std::size_t>(up)];
        i = up;
    }
    return i;
}

}  // namespace

CellQuality cell_quality(const Mesh& mesh, Index cell) {
    return is_hex(mesh) ? hex_quality(hex_corners(mesh, cell)) : tet_quality(tet_corners(mesh, cell));
}

MeshReport check_mesh(const Mesh& mesh) {
    check_numbers(mesh);
    MeshReport report;
    report.worst_relative_det = std::numeric_limits<double>::infinity();
    std::vector<int> inverted;
    std::vector<int> flat;
    std::vector<bool> used(static_cast<std::size_t>(mesh.nodes_m.cols()), false);
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        const int number = static_cast<int>(cell);
        CellQuality q = cell_quality(mesh, cell);
        if (!std::isfinite(q.relative_det)) q.relative_det = 0.0;  // 0 / 0 if all corners are in one place
        if (q.relative_det < -kFlat)
            inverted.push_back(number);
        else if (!(q.relative_det > kFlat))
            flat.push_back(number);
        if (q.relative_det < kSliver || q.min_dihedral_deg < kSliverAngle_deg) report.slivers.push_back(number);
        if (report.worst_cell < 0 || q.relative_det < report.worst_relative_det) {
            report.worst_relative_det = q.relative_det;
            report.worst_cell = number;
        }
        report.worst_dihedral_deg = std::min(report.worst_dihedral_deg, q.min_dihedral_deg);
        for (Index k = 0; k < mesh.cells.rows(); ++k) used[static_cast<std::size_t>(mesh.cells(k, cell))] = true;
        if (is_hex(mesh)) {
            const Hex corners = hex_corners(mesh, cell);
            for (int g = 0; g < 8; ++g) report.volume_m3 += hex_point(corners, g).volume_m3;
        } else {
            const Tet x = tet_corners(mesh, cell);
            report.volume_m3 += det_of(x.col(1) - x.col(0), x.col(2) - x.col(0), x.col(3) - x.col(0)) / 6.0;
        }
    }
    if (!inverted.empty() || !flat.empty()) {
        std::string what = "mesh:";
        if (!inverted.empty()) what += text(" inverted cells ", first_few(mesh, inverted), ";");
        if (!flat.empty()) what += text(" cells without volume ", first_few(mesh, flat), ";");
        what += text(" worst is cell ", number_of_cell(mesh, report.worst_cell), " with relative volume ",
                     report.worst_relative_det, ", must be > ", kFlat);
        inverted.insert(inverted.end(), flat.begin(), flat.end());
        throw MeshError(what, inverted);
    }
    for (std::size_t node = 0; node < used.size(); ++node) {
        if (!used[node]) report.loose_nodes.push_back(static_cast<int>(node));
    }
    return report;
}

Parts parts_of(const Mesh& mesh) {
    std::vector<int> parent(static_cast<std::size_t>(mesh.cells.cols()));
    std::iota(parent.begin(), parent.end(), 0);
    for (const auto& [a, b] : face_neighbours(mesh)) {
        const int low = std::min(root_of(parent, a), root_of(parent, b));
        const int high = std::max(root_of(parent, a), root_of(parent, b));
        parent[static_cast<std::size_t>(high)] = low;
    }
    Parts parts{0, std::vector<int>(parent.size(), -1)};
    for (int cell = 0; cell < static_cast<int>(parent.size()); ++cell) {
        const int root = root_of(parent, cell);
        int& number = parts.of_cell[static_cast<std::size_t>(cell)];
        number = root == cell ? parts.count++ : parts.of_cell[static_cast<std::size_t>(root)];
    }
    return parts;
}

std::string describe_part(const Mesh& mesh, const Parts& parts, int part) {
    Vector3d low = Vector3d::Constant(std::numeric_limits<double>::infinity());
    Vector3d high = -low;
    int cells = 0;
    int first = -1;
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        if (parts.of_cell[static_cast<std::size_t>(cell)] != part) continue;
        if (cells++ == 0) first = static_cast<int>(cell);
        for (Index k = 0; k < mesh.cells.rows(); ++k) {
            low = low.cwiseMin(mesh.nodes_m.col(mesh.cells(k, cell)));
            high = high.cwiseMax(mesh.nodes_m.col(mesh.cells(k, cell)));
        }
    }
    low *= 1e3;
    high *= 1e3;
    return text("part ", part + 1, " of ", parts.count, " (", cells, " cells from cell ", number_of_cell(mesh, first),
                ", x ", low.x(), "..", high.x(), ", y ", low.y(), "..", high.y(), ", z ", low.z(), "..", high.z(),
                " mm)");
}

std::string describe_node(const Mesh& mesh, Index node) {
    const Vector3d mm = 1e3 * mesh.nodes_m.col(node);
    return text("node ", number_of_node(mesh, node), " (", mm.x(), ", ", mm.y(), ", ", mm.z(), " mm)");
}

}  // namespace palpa::mechanics
