#pragma once
// Displacements of a part of finite cells under a load: conjugate gradients with multigrid, and a factorisation to check.

#include <vector>

#include "mechanics/voxel_multigrid.h"

namespace palpa::mechanics {

struct VoxelStop {
    double energy_error = 1e-3;  // of the energy, and so of the displacement under the load
    int most_iterations = 500;
};

struct VoxelSolution {
    Eigen::Matrix3Xd u_m;  // 3 x n_nodes
    // f . u, J, taken as 2 f . u - u . K u: its error is of second order in that of u, from any start.
    double work_J = 0.0;
    double energy_error = 0.0;  // estimate of |u - u_exact|^2 / |u|^2 in the energy norm
    int iterations = 0;
    bool converged = false;
};

// Solves K u = f by conjugate gradients, from `start` (3 x n_nodes) or, if that is empty, from 0. Forces on fixed dofs
// are left out. Stops by the estimate of the error in the energy norm,
//
//   |u - u_k|^2 = sum over j >= k of alpha_j (r_j . z_j)
//
// cut off where its terms have fallen to a fifth, which bounds from below the error of the iterate k, several steps before
// the one that is returned. The residual says little: with 0.02 % left in the displacement it was four times the load.
// Source: Hestenes, Stiefel, J. Res. Natl. Bur. Stand. 49 (1952), theorem 6:1; Strakos, Tichy, Electron. Trans. Numer.
//         Anal. 13 (2002), 56-80, equation (3.10). Where to cut is ours.
// Throws LoadError for another size, or numbers that are not finite. If numbers overflow, the solution is the last finite
// iterate, and not converged.
VoxelSolution solve(const Multigrid& multigrid, const Eigen::Matrix3Xd& load_N, const VoxelStop& stop,
                    const Eigen::Matrix3Xd& start = {});

// The same an iteration at a time, for a loop that must not stand still.
struct VoxelIteration {
    VoxelStop stop;
    Eigen::Matrix3Xd f, r, z, p, Kp;
    MultigridWork work;
    double rz = 0.0;
    std::vector<double> terms;  // of the estimate
    VoxelSolution solution;     // whole once it has ended
    bool ended = false;
};
VoxelIteration begin_solve(const Multigrid& multigrid, const Eigen::Matrix3Xd& load_N, const VoxelStop& stop,
                           const Eigen::Matrix3Xd& start = {});
bool advance(const Multigrid& multigrid, VoxelIteration& it);  // one iteration; false once it has ended

// The same by one factorisation of the finest level (47,563 cells take 1.06 GB). backward_error: as in solver.h. Throws
// SolverError, OutOfMemory and LoadError.
struct DirectSolution {
    Eigen::Matrix3Xd u_m;
    double work_J = 0.0;
    double backward_error = 0.0;
};
DirectSolution solve_directly(const GridLevel& level, const Eigen::Matrix3Xd& load_N);

// Bytes that the levels hold, without the bottom's factor.
std::size_t memory_bytes(const Multigrid& multigrid);

}  // namespace palpa::mechanics
