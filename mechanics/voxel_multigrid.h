#pragma once
// Geometric multigrid on finite cells: a fixed, symmetric, positive approximation of K^-1.

#include <vector>

#include "mechanics/solver.h"
#include "mechanics/voxel_grid.h"

namespace palpa::mechanics {

// Levels from the finest down; the coarsest is factored.
struct Multigrid {
    std::vector<GridLevel> levels;
    std::vector<double> largest;  // eigenvalue of D^-1 K on each level, D being its diagonal blocks; a bit above it
    SparseCholesky bottom{best_solver()};
};

// Coarsens until at most `bottom_nodes` are left, and factors. Throws SolverError and OutOfMemory.
Multigrid make_multigrid(GridLevel finest, int bottom_nodes = 600);

// Vectors of each level.
struct MultigridWork {
    std::vector<Eigen::Matrix3Xd> x, b, d, Kd;
};

// z = B r, one V-cycle with two steps of Chebyshev's iteration on the diagonal blocks before and after. B is symmetric and
// positive definite, as conjugate gradients need it. r is 0 at fixed dofs, and so is z. 3 x n_nodes.
// Source: Adams, Brezina, Hu, Tuminaro, "Parallel multigrid smoothing", J. Comput. Phys. 188 (2003), section 3 (the
//         smoother); Saad, Iterative Methods for Sparse Linear Systems, 2nd edition, algorithm 12.1 (the recurrence).
void v_cycle(const Multigrid& multigrid, const Eigen::Matrix3Xd& r, MultigridWork& work, Eigen::Matrix3Xd& z);

}  // namespace palpa::mechanics
