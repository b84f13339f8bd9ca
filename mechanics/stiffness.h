#pragma once
// The stiffness matrix of a mesh, and the strain and stress of its cells.

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "mechanics/elements.h"
#include "mechanics/mesh.h"

namespace palpa::mechanics {

// Only the lower triangle is stored, by compressed columns with ascending rows. Row 3 i + c belongs to node i, axis c.
using LowerMatrix = Eigen::SparseMatrix<double>;

// Returns the sum of the cells' stiffnesses, 3 n_nodes x 3 n_nodes. Cells marked in `skip` (empty for none) add
// nothing. The sum runs in the order of the cells, so that it is the same to the last bit every time. materials: one
// per cell. Throws MeshError if the cells do not fit the element, and MaterialError if there is not one material per
// cell.
LowerMatrix stiffness_N_per_m(const Mesh& mesh, Element element, std::span<const Material> materials,
                              const std::vector<bool>& skip = {});

// Mean strain and stress of each cell, 6 x n_cells, xx yy zz xy yz xz (material.h).
struct CellFields {
    Eigen::Matrix<double, 6, Eigen::Dynamic> strain;
    Eigen::Matrix<double, 6, Eigen::Dynamic> stress_Pa;
};
CellFields cell_fields(const Mesh& mesh, std::span<const Material> materials, const Eigen::Matrix3Xd& u_m);

// Returns the largest magnitude of a principal strain over all cells, which shows whether strains are still small.
double max_principal_strain(const CellFields& fields);

// Returns the largest rotation of a cell in its middle, rad, that of small displacements: the length of half the curl.
double max_rotation_rad(const Mesh& mesh, const Eigen::Matrix3Xd& u_m);

}  // namespace palpa::mechanics
