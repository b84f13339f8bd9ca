#pragma once
// The stiffness matrix of a mesh and what is read off a displacement field cell by cell.

#include <Eigen/SparseCore>
#include <span>
#include <vector>

#include "mechanics/elements.h"
#include "mechanics/mesh.h"

namespace palpa::mechanics {

// Only the lower triangle is stored, columns compressed, rows ascending. Row 3 i + c is node i, axis c.
using LowerMatrix = Eigen::SparseMatrix<double>;

// Sum of the cell stiffnesses, 3 n_nodes squared. Cells marked in `skip` (empty = none) add nothing. Summed
// in the order of the cells: the same bits every time. materials: one per cell.
LowerMatrix stiffness_N_per_m(const Mesh& mesh, Element element, std::span<const Material> materials,
                              const std::vector<bool>& skip = {});

// Mean strain and stress of each cell, 6 x n_cells, xx yy zz xy yz xz.
struct CellFields {
    Eigen::Matrix<double, 6, Eigen::Dynamic> strain;
    Eigen::Matrix<double, 6, Eigen::Dynamic> stress_Pa;
};
CellFields cell_fields(const Mesh& mesh, std::span<const Material> materials, const Eigen::Matrix3Xd& u_m);

// Largest magnitude of a principal strain over all cells: the figure that says whether small strains still
// hold.
double max_principal_strain(const CellFields& fields);

}  // namespace palpa::mechanics
