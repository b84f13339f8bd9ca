#pragma once
// A volume mesh of one kind of cell, its outer faces, and the boxes that most scenes are.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa::mechanics {

// cells: 8 x n (hexahedra) or 4 x n (tetrahedra) node numbers in VTK order, which is also CalculiX's and
// Gmsh's: the bottom face counter-clockwise seen from above, then the top one; tets with positive volume.
struct Mesh {
    Eigen::Matrix3Xd nodes_m;
    Eigen::MatrixXi cells;
    Eigen::VectorXi region;  // one per cell: position in the list of materials
    // As the file numbers them, for messages; empty: their positions.
    std::vector<std::uint64_t> node_number{};
    std::vector<std::uint64_t> cell_number{};
};

inline std::uint64_t number_of_node(const Mesh& mesh, Eigen::Index node) {
    const auto i = static_cast<std::size_t>(node);
    return mesh.node_number.empty() ? i : mesh.node_number[i];
}
inline std::uint64_t number_of_cell(const Mesh& mesh, Eigen::Index cell) {
    const auto i = static_cast<std::size_t>(cell);
    return mesh.cell_number.empty() ? i : mesh.cell_number[i];
}

inline bool is_hex(const Mesh& mesh) { return mesh.cells.rows() == 8; }

// Outer faces, corners counter-clockwise seen from outside. corners: 4 x n or 3 x n.
struct Faces {
    Eigen::MatrixXi corners;
    Eigen::VectorXi cell;
};

Faces boundary_faces(const Mesh& mesh);

// Pairs of cells that share a whole face.
std::vector<std::array<int, 2>> face_neighbours(const Mesh& mesh);

// The six sides of a mesh's bounding box.
enum class Side { xmin, xmax, ymin, ymax, zmin, zmax };
inline int axis_of(Side side) { return static_cast<int>(side) / 2; }
inline bool is_max(Side side) { return static_cast<int>(side) % 2 == 1; }

// Those of `outer` that lie in a side of the bounding box, to 1e-9 of its size.
Faces faces_on(const Mesh& mesh, const Faces& outer, Side side);

// Node numbers, ascending, each once.
std::vector<int> nodes_of(const Faces& faces);

// Share of the surface that belongs to each node, m^2: A_i = int N_i dA (2 x 2 Gauss on quads). Length
// n_nodes.
Eigen::VectorXd tributary_area_m2(const Mesh& mesh, const Faces& faces);

struct Grading {
    std::array<double, 2> centre_m{0.0, 0.0};  // x, y
    double finest_m = 0.0;
};

// Corner at the origin, z up, the tissue's surface at zmax.
struct Box {
    std::array<double, 3> size_m{0.1, 0.1, 0.05};
    std::array<int, 3> cells{10, 10, 5};
    std::optional<Grading> grading;  // absent = uniform
};

// n cells over [0, length], growing geometrically to both sides of `centre_m`, where a node stands:
//   h_k = finest q^k, one ratio q per side, cells shared out so that the larger q is smallest.
// A side that `finest` would overfill is uniform. Returns n + 1 ascending coordinates.
Eigen::VectorXd graded_coordinates_m(double length_m, int n, double centre_m, double finest_m);

// Tensor product of three ascending lists; nodes run x fastest, then y, then z. Throws MeshError.
Mesh hex_box(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m);
Mesh hex_box(const Box& box);

// Six tets per hexahedron about the diagonal 0-6: neighbours match, and no new nodes. Keeps the regions.
Mesh split_to_tets(const Mesh& hexes);

struct Sphere {
    std::array<double, 3> centre_m{0.0, 0.0, 0.0};
    double radius_m = 0.0;
};

// Share of each cell inside the sphere, 0..1, by n_sub^3 sample points (hexahedra: trilinear; tets: a
// barycentric lattice). n_sub = 1 samples the centroid: 0 or 1.
Eigen::VectorXd sphere_share(const Mesh& mesh, const Sphere& sphere, int n_sub);

// Cells whose centroid is inside get the region. Returns how many.
int assign_sphere(const Sphere& sphere, int region, Mesh& mesh);

}  // namespace palpa::mechanics
