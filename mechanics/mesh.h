#pragma once
// A volume mesh with cells of one kind, its outer faces, and meshes of boxes.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <optional>
#include <vector>

namespace palpa::mechanics {

// cells: 8 x n_cells (hexahedra) or 4 x n_cells (tetrahedra) node numbers in VTK order, which is also that of CalculiX
// and Gmsh: the bottom face counter-clockwise seen from above, then the top face; a tetrahedron has positive volume.
struct Mesh {
    Eigen::Matrix3Xd nodes_m;  // 3 x n_nodes
    Eigen::MatrixXi cells;
    Eigen::VectorXi region;  // one per cell: position in the list of materials
    // Numbers in the mesh's file, for messages; if empty, positions are used.
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

// Faces of cells, 4 x n_faces or 3 x n_faces corners each, counter-clockwise seen from outside the cell.
struct Faces {
    Eigen::MatrixXi corners;  // node numbers
    Eigen::VectorXi cell;     // the cell of each face
};

// Returns the outer faces, which belong to one cell only.
Faces boundary_faces(const Mesh& mesh);

// Pairs of cells that share a whole face.
std::vector<std::array<int, 2>> face_neighbours(const Mesh& mesh);

// The six sides of a mesh's bounding box.
enum class Side { xmin, xmax, ymin, ymax, zmin, zmax };
inline int axis_of(Side side) { return static_cast<int>(side) / 2; }
inline bool is_max(Side side) { return static_cast<int>(side) % 2 == 1; }

// Returns the faces of `outer` that lie in a side of the bounding box, to 1e-9 of the box's longest edge.
Faces faces_on(const Mesh& mesh, const Faces& outer, Side side);

// Returns the nodes of faces, ascending, each once.
std::vector<int> nodes_of(const Faces& faces);

// Returns the tributary area of each node of the mesh, A_i = int N_i dA (2 x 2 Gauss points on quads); 0 for nodes that
// are on none of the faces.
Eigen::VectorXd tributary_area_m2(const Mesh& mesh, const Faces& faces);

struct Grading {
    std::array<double, 2> centre_m{0.0, 0.0};  // x, y
    double finest_m = 0.0;                     // size of the cells there, and along z at zmax
};

// A box with a corner at the origin, z up, the tissue's surface at zmax.
struct Box {
    std::array<double, 3> size_m{0.1, 0.1, 0.05};
    std::array<int, 3> cells{10, 10, 5};
    std::optional<Grading> grading;  // absent = uniform
};

// Divides [0, length] into n cells that grow geometrically to both sides of `centre_m`, where a node stands if n > 1:
//   h_k = finest q^k, with one ratio q per side; the cells are shared out so that the larger q is as small as possible.
// A side that n cells of the finest size would overfill is uniform. Returns n + 1 ascending coordinates. Throws
// MeshError.
Eigen::VectorXd graded_coordinates_m(double length_m, int n, double centre_m, double finest_m);

// Return a mesh of bricks, from three ascending lists of coordinates or from a box; nodes are numbered x fastest, then
// y, then z. Throw MeshError.
Mesh hex_box(const Eigen::VectorXd& x_m, const Eigen::VectorXd& y_m, const Eigen::VectorXd& z_m);
Mesh hex_box(const Box& box);

// Splits each hexahedron into six tetrahedra about its diagonal 0-6, without new nodes. Neighbours match if all
// hexahedra have their corners in the same order, as those of hex_box() have. Keeps the regions.
Mesh split_to_tets(const Mesh& hexes);

struct Sphere {
    std::array<double, 3> centre_m{0.0, 0.0, 0.0};
    double radius_m = 0.0;
};

// Returns the share of each cell that is inside the sphere, 0..1, by sample points: n_sub^3 in a hexahedron, a lattice
// with n_sub points along each edge in a tetrahedron. With n_sub = 1 the only sample is the centroid, so the share is 0
// or 1.
Eigen::VectorXd sphere_share(const Mesh& mesh, const Sphere& sphere, int n_sub);

// Gives the region to all cells whose centroid is inside the sphere. Returns how many these are.
int assign_sphere(const Sphere& sphere, int region, Mesh& mesh);

}  // namespace palpa::mechanics
