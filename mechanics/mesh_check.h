#pragma once
// Checks whether a mesh can be computed with. This is done once, where a mesh enters the program.

#include <string>
#include <vector>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

// Shape of one cell. relative_det of a hexahedron is the smallest Jacobian determinant at its corners and Gauss points,
// relative to the product of the three edge lengths at a corner, averaged over the corners (1 for a brick). That of a
// tetrahedron is det J relative to the cube of its longest edge (0.707 if regular).
struct CellQuality {
    double relative_det = 0.0;
    double min_dihedral_deg = 90.0;  // tetrahedra: smallest angle between two faces
    double radius_ratio = 1.0;       // tetrahedra: 3 r_in / r_out (1 if regular)
};
CellQuality cell_quality(const Mesh& mesh, Eigen::Index cell);

struct MeshReport {
    double volume_m3 = 0.0;
    double worst_relative_det = 0.0;
    double worst_dihedral_deg = 90.0;
    int worst_cell = -1;
    std::vector<int> slivers;      // cells that are usable but flat: relative_det < kSliver or angle < kSliverAngle_deg
    std::vector<int> loose_nodes;  // nodes of no cell; they are left out of the equations
};

// A cell whose relative_det is at most kFlat counts as without volume: its stiffness, about 1/kFlat times that of a
// good cell, would drown that of its neighbours.
inline constexpr double kFlat = 1e-12;
inline constexpr double kSliver = 1e-3;
inline constexpr double kSliverAngle_deg = 1.0;

// Throws MeshError for a mesh without cells, with cells of other than 8 or 4 corners, or without one region per cell;
// and, with a list of the cells, for node numbers out of range, coordinates that are not finite, inverted cells
// (relative_det < -kFlat) and cells without volume (|relative_det| <= kFlat).
MeshReport check_mesh(const Mesh& mesh);

// Cells that are joined through whole faces are one part. of_cell holds the number of each cell's part; parts are
// numbered from 0 in the order of their first cells.
struct Parts {
    int count = 0;
    std::vector<int> of_cell;
};
Parts parts_of(const Mesh& mesh);

// Describe a part and a node for messages, in mm and with the numbers of the file:
// "part 1 of 3 (27 cells from cell 54, x 0..100, y 0..100, z 0..50 mm)" and "node 17 (10, 20, 0 mm)".
std::string describe_part(const Mesh& mesh, const Parts& parts, int part);
std::string describe_node(const Mesh& mesh, Eigen::Index node);

}  // namespace palpa::mechanics
