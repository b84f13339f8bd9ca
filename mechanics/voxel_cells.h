#pragma once
// Finite cells: cubes of several voxels, of which those that are partly filled are integrated over their voxels.

#include <array>
#include <span>
#include <vector>

#include "mechanics/elements.h"
#include "mechanics/material.h"
#include "mechanics/voxels.h"

namespace palpa::mechanics {

// The cells with at least one voxel in them. Cells with the same voxels have the same pattern, and share one matrix.
struct VoxelCells {
    std::array<int, 3> n{0, 0, 0};  // cells along x, y, z; those at the high sides may reach beyond the voxels
    int voxels_per_cell = 1;        // along each edge
    double cell_m = 0.0;            // edge
    Point origin_m{};
    std::vector<std::array<int, 3>> place;     // of each cell, 0 <= place[c] < n[c]; x runs fastest, then y, then z
    std::vector<int> pattern;                  // of each cell
    std::vector<HexMatrix> stiffness_N_per_m;  // of each pattern
    std::vector<double> share;                 // of each pattern: volume that is filled, 0..1
};

// In a cell that is not full, a material this much softer than the cell's commonest one fills all of the cell.
inline constexpr double kSoftFill = 1e-6;

// The most cells that are computed with.
inline constexpr std::int64_t kMostCells = 4'000'000;

// Returns the cells of a part. A pattern's matrix is that of hex8_bbar_stiffness_N_per_m(), whose integrals run over the
// voxels that are filled:
//
//   K_ab = sum_m int_m [ mu_m ( (g_a . g_b) I + g_b g_a^T ) - 2/3 mu_m g_a g_b^T ] dV  +  ( sum_m kappa_m V_m ) G_a G_b^T
//
// m: materials in the cell; G_a: mean of grad N_a over all that is filled. The integrands are polynomials, and the runs
// are boxes, so that all integrals are exact: a full cell of one material has the matrix of hex8_bbar to round-off. To a
// cell that is not full, kSoftFill of the full cell is added. In a cell of several materials the layers across the axis along
// which it varies most stretch and shear each by its own material, by three displacements of its own that are condensed out.
// Source: Parvizian, Duester, Rank, "Finite cell method", Computational Mechanics 41 (2007), 121-133, sections 2 and 3;
//         the mean dilatation over the filled part is ours, as are the exact integrals instead of sample points.
// materials: by position, as the runs name them. Throws MaterialError as check_materials() does and for a run whose
// material the list does not hold, and MeshError for fewer than 1 voxel per cell, for no voxels and for too many cells.
VoxelCells cells_of(const Voxels& voxels, int voxels_per_cell, std::span<const Material> materials);

}  // namespace palpa::mechanics
