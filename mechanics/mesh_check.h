#pragma once
// Is this mesh one that can be computed with? Asked once, where a mesh enters.

#include <string>
#include <vector>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

// Shape of one cell. Hexahedra: smallest Jacobian determinant over corners and Gauss points, relative to the
// product of the edge lengths at the corners (1 = brick). Tetrahedra: det J relative to longest edge^3 (0.707
// = regular), the smallest angle between two faces, and 3 r_in / r_out (1 = regular).
struct CellQuality {
    double relative_det = 0.0;
    double min_dihedral_deg = 90.0;
    double radius_ratio = 1.0;
};
CellQuality cell_quality(const Mesh& mesh, Eigen::Index cell);

struct MeshReport {
    double volume_m3 = 0.0;
    double worst_relative_det = 0.0;
    double worst_dihedral_deg = 90.0;
    int worst_cell = -1;
    std::vector<int> slivers;      // usable but flat: relative_det < kSliver or dihedral < kSliverAngle_deg
    std::vector<int> loose_nodes;  // in no cell; they are left out of the equations
};

// A cell under kFlat counts as without volume: its stiffness, of the order of 1/kFlat, would drown its
// neighbours'.
inline constexpr double kFlat = 1e-12;
inline constexpr double kSliver = 1e-3;
inline constexpr double kSliverAngle_deg = 1.0;

// Throws MeshError, listing the cells, for node numbers out of range, coordinates that are not finite,
// inverted cells (det J < 0) and cells without volume (relative det < kFlat).
MeshReport check_mesh(const Mesh& mesh);

// Cells joined through whole faces make a part. of_cell numbers them from 0 in the order of their first
// cells.
struct Parts {
    int count = 0;
    std::vector<int> of_cell;
};
Parts parts_of(const Mesh& mesh);

// For messages, which speak in mm and in the file's numbers:
// "part 1 of 3 (27 cells from cell 54, x 0..100, y 0..100, z 0..50 mm)" and "node 17 (10, 20, 0 mm)".
std::string describe_part(const Mesh& mesh, const Parts& parts, int part);
std::string describe_node(const Mesh& mesh, Eigen::Index node);

}  // namespace palpa::mechanics
