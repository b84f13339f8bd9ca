#include "mechanics/mesh.h"

#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;
using Eigen::Vector3d;

constexpr std::array<std::array<int, 4>, 6> kHexFaces{
    {{0, 3, 2, 1}, {4, 5, 6, 7}, {0, 1, 5, 4}, {1, 2, 6, 5}, {2, 3, 7, 6}, {3, 0, 4, 7}}};
constexpr std::array<std::array<int, 3>, 4> kTetFaces{{{0, 2, 1}, {0, 1, 3}, {1, 2, 3}, {2, 0, 3}}};

struct FaceKey {
    std::array<int, 4> sorted{-1, -1, -1, -1};  // node numbers, ascending; a triangle leaves one -1
    int cell = 0;
    int local = 0;
};

int local_corner(bool hex, int face, int k) {
    const auto f = static_cast<std::size_t>(face);
    const auto c = static_cast<std::size_t>(k);
    return hex ? kHexFaces[f][c] : kTetFaces[f][c];
}

// Returns all faces of all cells, sorted so that equal faces are side by side, the lower cell first.
std::vector<FaceKey> sorted_faces(const Mesh& mesh) {
    const bool hex = is_hex(mesh);
    const int n_faces = hex ? 6 : 4;
    const int n_corners = hex ? 4 : 3;
    std::vector<FaceKey> keys;
    keys.reserve(static_cast<std::size_t>(mesh.cells.cols() * n_faces));
    for (int cell = 0; cell < mesh.cells.cols(); ++cell) {
        for (int face = 0; face < n_faces; ++face) {
            FaceKey key;
            key.cell = cell;
            key.local = face;
            for (int k = 0; k < n_corners; ++k)
                key.sorted[static_cast<std::size_t>(k)] = mesh.cells(local_corner(hex, face, k), cell);
            std::sort(key.sorted.begin(), key.sorted.end());
            keys.push_back(key);
        }
    }
    std::sort(keys.begin(), keys.end(), [](const FaceKey& a, const FaceKey& b) {
        return a.sorted != b.sorted ? a.sorted < b.sorted : a.cell < b.cell;
    });
    return keys;
}

// Returns the ratio q >= 1 for which first * (q^n - 1)/(q - 1) = length, by bisection; 1 if n cells of the first size
// fill the length or more.
double growth_ratio(double length_m, int n, double first_m) {
    const auto filled = [&](double q) {
        double sum = 0.0;
        double h = first_m;
        for (int i = 0; i < n && sum < 2.0 * length_m; ++i, h *= q) sum += h;
        return sum;
    };
    if (n * first_m >= length_m) return 1.0;
    double low = 1.0;
    double high = length_m / first_m + 1.0;
    for (int i = 0; i < 200 && high - low > 1e-16 * high; ++i) {
        const double middle = 0.5 * (low + high);
        (filled(middle) < length_m ? low : high) = middle;
    }
    return 0.5 * (low + high);
}

// Returns the distances from the centre to the n nodes of one side; the last one is `length`.
Eigen::VectorXd one_side_m(double length_m, int n, double first_m) {
    const double q = growth_ratio(length_m, n, first_m);
    Eigen::VectorXd distance(n);
    double sum = 0.0;
    double h = 1.0;
    for (int i = 0; i < n; ++i, h *= q) distance(i) = (sum += h);
    return distance * (length_m / sum);
}

// Returns how many of n cells stand on the left: those in proportion to its length, unless another number makes the
// larger ratio smaller.
int cells_left_of_centre(double left_m, double right_m, int n, double finest_m) {
    const double length_m = left_m + right_m;
    if (left_m <= 1e-12 * length_m) return 0;
    if (right_m <= 1e-12 * length_m) return n;
    const auto larger_ratio = [&](int m) {
        return std::max(growth_ratio(left_m, m, finest_m), growth_ratio(right_m, n - m, finest_m));
    };
    int n_left = std::clamp(static_cast<int>(std::lround(n * left_m / length_m)), 1, n - 1);
    double best = larger_ratio(n_left);
    for (int m = 1; m < n; ++m) {
        const double ratio = larger_ratio(m);
        if (ratio >= best - 1e-9) continue;
        best = ratio;
        n_left = m;
    }
    return n_left;
}

Vector3d point_in_cell(const Mesh& mesh, Index cell, double r, double s, double t) {
    const auto node = [&](int k) -> Vector3d { return mesh.nodes_m.col(mesh.cells(k, cell)); };
    if (!is_hex(mesh)) return (1.0 - r - s - t) * node(0) + r * node(1) + s * node(2) + t * node(3);
    const Vector3d bottom =
        (1 - r) * (1 - s) * node(0) + r * (1 - s) * node(1) + r * s * node(2) + (1 - r) * s * node(3);
    const Vector3d top = (1 - r) * (1 - s) * node(4) + r * (1 - s) * node(5) + r * s * node(6) + (1 - r) * s * node(7);
    return (1 - t) * bottom + t * top;
}

// Returns sample points of the reference cell, 3 x m: the centres of n^3 sub-cubes of a hexahedron, or the points of a
// symmetric lattice in a tetrahedron.
Eigen::Matrix3Xd sample_points(bool hex, int n) {
    std::vector<Vector3d> points;
    for (int i = 0; i < n; ++i) {
        for (int j = 0; j < (hex ? n : n - i); ++j) {
            for (int k = 0; k < (hex ? n : n - i - j); ++k) {
                const double shift = hex ? 0.5 : 0.25;
                points.emplace_back((i + shift) / n, (j + shift) / n, (k + shift) / n);
            }
        }
    }
    Eigen::Matrix3Xd out(3, static_cast<Index>(points.size()));
    for (std::size_t i = 0; i < points.size(); ++i) out.col(static_cast<Index>(i)) = points[i];
    return out;
}

}  // namespace

Faces boundary_faces(const Mesh& mesh) {
    const std::vector<FaceKey> keys = sorted_faces(mesh);
    std::vector<FaceKey> single;
    for (std::size_t i = 0; i < keys.size();) {
        std::size_t end = i + 1;
        while (end < keys.size() && keys[end].sorted == keys[i].sorted) ++end;
        if (end == i + 1) single.push_back(keys[i]);
        i = end;
    }
    std::sort(single.begin(), single.end(), [](const FaceKey& a, const FaceKey& b) {
        return a.cell != b.cell ? a.cell < b.cell : a.local < b.local;
    });
    const bool hex = is_hex(mesh);
    Faces faces;
    faces.corners.resize(hex ? 4 : 3, static_cast<Index>(single.size()));
    faces.cell.resize(static_cast<Index>(single.size()));
    for (Index i = 0; i < faces.cell.size(); ++i) {
        const FaceKey& key = single[static_cast<std::size_t>(i)];
        faces.cell(i) = key.cell;
        for (int k = 0; k < faces.corners.rows(); ++k) {
            faces.corners(k, i) = mesh.cells(local_corner(hex, key.local, k), key.cell);
        }
    }
    return faces;
}

std::vector<std::array<int, 2>> face_neighbours(const Mesh& mesh) {
    const std::vector<FaceKey> keys = sorted_faces(mesh);
    std::vector<std::array<int, 2>> pairs;
    for (std::size_t i = 1; i < keys.size(); ++i) {
        if (keys[i].sorted == keys[i - 1].sorted) pairs.push_back({keys[i - 1].cell, keys[i].cell});
    }
    return pairs;
}

Faces faces_on(const Mesh& mesh, const Faces& outer, Side side) {
    const auto along = mesh.nodes_m.row(axis_of(side));
    const double plane = is_max(side) ? along.maxCoeff() : along.minCoeff();
    const double tolerance = 1e-9 * (mesh.nodes_m.rowwise().maxCoeff() - mesh.nodes_m.rowwise().minCoeff()).maxCoeff();
    std::vector<Index> kept;
    for (Index i = 0; i < outer.cell.size(); ++i) {
        double off = 0.0;
        for (Index k = 0; k < outer.corners.rows(); ++k)
            off = std::max(off, std::abs(along(outer.corners(k, i)) - plane));
        if (off <= tolerance) kept.push_back(i);
    }
    Faces faces{Eigen::MatrixXi(outer.corners.rows(), static_cast<Index>(kept.size())),
                Eigen::VectorXi(static_cast<Index>(kept.size()))};
    for (std::size_t i = 0; i < kept.size(); ++i) {
        faces.corners.col(static_cast<Index>(i)) = outer.corners.col(kept[i]);
        faces.cell(static_cast<Index>(i)) = outer.cell(kept[i]);
    }
    return faces;
}

std::vector<int> nodes_of(const Faces& faces) {
    std::vector<int> nodes(faces.corners.data(), faces.corners.data() + faces.corners.size());
    std::sort(nodes.begin(), nodes.end());
    nodes.erase(std::unique(nodes.begin(), nodes.end()), nodes.end());
    return nodes;
}

Eigen::VectorXd tributary_area_m2(const Mesh& mesh, const Faces& faces) {
    Eigen::VectorXd area = Eigen::VectorXd::Zero(mesh.nodes_m.cols());
    const double g = 1.0 / std::sqrt(3.0);
    for (Index f = 0; f < faces.cell.size(); ++f) {
        const auto node = [&](int k) -> Vector3d { return mesh.nodes_m.col(faces.corners(k, f)); };
        if (faces.corners.rows() == 3) {
            const double third = (node(1) - node(0)).cross(node(2) - node(0)).norm() / 6.0;
            for (int k = 0; k < 3; ++k) area(faces.corners(k, f)) += third;
            continue;
        }
        for (const double r : {-g, g}) {
            for (const double s : {-g, g}) {
                const Vector3d along_r = 0.25 * ((1 - s) * (node(1) - node(0)) + (1 + s) * (node(2) - node(3)));
                const Vector3d along_s = 0.25 * ((1 - r) * (node(3) - node(0)) + (1 + r) * (node(2) - node(1)));
                const double dA = along_r.cross(along_s).norm();
                area(faces.corners(0, f)) += 0.25 * (1 - r) * (1 - s) * dA;
                area(faces.corners(1, f)) += 0.25 * (1 + r) * (1 - s) * dA;
                area(faces.corners(2, f)) += 0.25 * (1 + r) * (1 + s) * dA;
                area(faces.corners(3, f)) += 0.25 * (1 - r) * (1 + s) * dA;
            }
        }
    }
    return area;
}

Eigen::VectorXd graded_coordinates_m(double length_m, int n, double centre_m, double finest_m) {
    if (!(length_m > 0.0) || n < 1 || !(finest_m > 0.0) || !(centre_m >= 0.0 && centre_m <= length_m)) {
        throw MeshError(text("graded box: length ", length_m, " m, ", n, " cells, centre ", centre_m, " m, finest ",
                             finest_m, " m; wanted length > 0, cells >= 1, 0 <= centre <= length, finest > 0"),
                        {});
    }
    const double left = n == 1 ? length_m : centre_m;  // a single cell has no node inside
    const double right = length_m - left;
    const int n_left = cells_left_of_centre(left, right, n, finest_m);
    Eigen::VectorXd x(n + 1);
    if (n_left > 0) x.head(n_left) = left - one_side_m(left, n_left, finest_m).reverse().array();
    x(n_left) = left;
    if (n_left < n) x.tail(n - n_left) = left + one_side_m(right, n - n_left, finest_m).array();
    x(0) = 0.0;
    x(n) = length_m;
    return x;
}

Mesh hex_box(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m) {
    const auto ascending = [](const Eigen::VectorXd& c) {
        return c.size() >= 2 && ((c.tail(c.size() - 1) - c.head(c.size() - 1)).array() > 0.0).all();
    };
    if (!ascending(x_m) || !ascending(y_m) || !ascending(z_m)) {
        throw MeshError(text("box: ", x_m.size(), " x ", y_m.size(), " x ", z_m.size(),
                             " coordinates; wanted at least 2 in each direction, ascending"),
                        {});
    }
    const Index nx = x_m.size();
    const Index ny = y_m.size();
    const Index nz = z_m.size();
    Mesh mesh;
    mesh.nodes_m.resize(3, nx * ny * nz);
    for (Index k = 0, node = 0; k < nz; ++k) {
        for (Index j = 0; j < ny; ++j) {
            for (Index i = 0; i < nx; ++i, ++node) mesh.nodes_m.col(node) << x_m(i), y_m(j), z_m(k);
        }
    }
    mesh.cells.resize(8, (nx - 1) * (ny - 1) * (nz - 1));
    const auto node_at = [&](Index i, Index j, Index k) { return static_cast<int>((k * ny + j) * nx + i); };
    for (Index k = 0, cell = 0; k + 1 < nz; ++k) {
        for (Index j = 0; j + 1 < ny; ++j) {
            for (Index i = 0; i + 1 < nx; ++i, ++cell) {
                mesh.cells.col(cell) << node_at(i, j, k), node_at(i + 1, j, k), node_at(i + 1, j + 1, k),
                    node_at(i, j + 1, k), node_at(i, j, k + 1), node_at(i + 1, j, k + 1), node_at(i + 1, j + 1, k + 1),
                    node_at(i, j + 1, k + 1);
            }
        }
    }
    mesh.region = Eigen::VectorXi::Zero(mesh.cells.cols());
    return mesh;
}

Mesh hex_box(const Box& box) {
    std::array<Eigen::VectorXd, 3> coordinates;
    for (std::size_t axis = 0; axis < 3; ++axis) {
        const double length = box.size_m[axis];
        const int n = box.cells[axis];
        if (!(length > 0.0) || n < 1) {
            throw MeshError(
                text("box: size ", length, " m in ", n, " cells along axis ", axis, "; wanted > 0 and >= 1"), {});
        }
        if (box.grading) {
            const double centre = axis == 2 ? length : box.grading->centre_m[axis];
            coordinates[axis] = graded_coordinates_m(length, n, centre, box.grading->finest_m);
        } else {
            coordinates[axis] = Eigen::VectorXd::LinSpaced(n + 1, 0.0, length);
        }
    }
    return hex_box(coordinates[0], coordinates[1], coordinates[2]);
}

Mesh split_to_tets(const Mesh& hexes) {
    constexpr std::array<std::array<int, 4>, 6> kTets{
        {{0, 1, 2, 6}, {0, 2, 3, 6}, {0, 3, 7, 6}, {0, 7, 4, 6}, {0, 4, 5, 6}, {0, 5, 1, 6}}};
    Mesh tets{hexes.nodes_m, Eigen::MatrixXi(4, 6 * hexes.cells.cols()), Eigen::VectorXi(6 * hexes.cells.cols())};
    for (Index cell = 0, tet = 0; cell < hexes.cells.cols(); ++cell) {
        for (const auto& corners : kTets) {
            for (int k = 0; k < 4; ++k) tets.cells(k, tet) = hexes.cells(corners[static_cast<std::size_t>(k)], cell);
            tets.region(tet++) = hexes.region(cell);
        }
    }
    return tets;
}

Eigen::VectorXd sphere_share(const Mesh& mesh, const Sphere& sphere, int n_sub) {
    const Vector3d centre(sphere.centre_m[0], sphere.centre_m[1], sphere.centre_m[2]);
    const Eigen::Matrix3Xd points = sample_points(is_hex(mesh), std::max(n_sub, 1));
    const double radius2 = sphere.radius_m * sphere.radius_m;
    Eigen::VectorXd share(mesh.cells.cols());
    for (Index cell = 0; cell < mesh.cells.cols(); ++cell) {
        int inside = 0;
        for (Index i = 0; i < points.cols(); ++i) {
            const Vector3d x = point_in_cell(mesh, cell, points(0, i), points(1, i), points(2, i));
            inside += (x - centre).squaredNorm() <= radius2 ? 1 : 0;
        }
        share(cell) = static_cast<double>(inside) / static_cast<double>(points.cols());
    }
    return share;
}

int assign_sphere(const Sphere& sphere, int region, Mesh& mesh) {
    const Eigen::VectorXd share = sphere_share(mesh, sphere, 1);
    int count = 0;
    for (Index cell = 0; cell < share.size(); ++cell) {
        if (share(cell) < 0.5) continue;
        mesh.region(cell) = region;
        ++count;
    }
    return count;
}

}  // namespace palpa::mechanics
