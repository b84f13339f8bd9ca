#pragma once
// One level of finite cells for matrix-free products, and the next coarser level by Galerkin's product.

#include <Eigen/Core>
#include <array>
#include <cstdint>
#include <vector>

#include "mechanics/elements.h"
#include "mechanics/stiffness.h"
#include "mechanics/voxel_cells.h"

namespace palpa::mechanics {

struct GridLevel {
    std::array<int, 3> n{0, 0, 0};                 // cells along x, y, z
    std::vector<std::array<int, 3>> node_place;    // of each node, 0 <= place[c] <= n[c]; x fastest, then y, then z
    std::vector<std::array<int, 3>> cell_place;    // of each cell; cells are ordered by their matrix
    std::vector<std::array<int, 8>> corners;       // nodes of each cell, in VTK order
    std::vector<int> first;                        // cells first[p] to first[p + 1] - 1 have matrix p
    std::vector<HexMatrix> stiffness_N_per_m;      // rows and columns of fixed dofs are 0
    std::vector<Eigen::Matrix3d> inverse_m_per_N;  // of each node: the inverse of its diagonal block; 1 where that is 0
    // finest level only: 1 where a displacement is free, 0 where it is fixed at 0, 3 x n_nodes; else empty
    Eigen::Matrix3Xd free;
    // For each node, eight nodes of the next coarser level with weight 1/8 each; nodes appear more than once.
    std::vector<std::array<int, 8>> coarse;
};

inline int n_nodes(const GridLevel& level) { return static_cast<int>(level.node_place.size()); }

// Numbers of the nodes at places of the grid.
class NodeNumbers {
  public:
    explicit NodeNumbers(const GridLevel& level);
    int operator()(int x, int y, int z) const { return number_[place(x, y, z)]; }  // -1: no cell is there

  private:
    std::size_t place(int x, int y, int z) const;
    std::array<int, 3> n_;
    std::vector<int> number_;
};

// Returns the finest level without supports.
GridLevel finest_level(const VoxelCells& cells);

// Fixes displacements at 0: fixed: for each node, bit c set for axis c.
void fix_nodes(const std::vector<std::uint8_t>& fixed, GridLevel& level);

// Returns the level whose cells are 2 x 2 x 2 of these, with matrices K_c = sum P^T K P (P: trilinear interpolation), and
// fills level.coarse. Equal groups of children share one matrix.
GridLevel coarser_level(GridLevel& level);

// y = K x, both 3 x n_nodes, without assembling K. Fixed dofs of y are 0.
void multiply(const GridLevel& level, const Eigen::Matrix3Xd& x, Eigen::Matrix3Xd& y);

// Returns the lower triangle of the assembled matrix; dofs without stiffness get 1 on the diagonal. relative_shift: times
// the diagonal is added to it.
LowerMatrix assembled(const GridLevel& level, double relative_shift);

}  // namespace palpa::mechanics
