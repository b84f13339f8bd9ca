#pragma once
// A linear static problem from materials and supports to displacements, reactions and energy.

#include <vector>

#include "mechanics/mesh_check.h"
#include "mechanics/solver.h"
#include "mechanics/supports.h"

namespace palpa::mechanics {

struct Problem {
    Mesh mesh;
    Element element = Element::hex8_bbar;
    std::vector<Material> materials;  // one per cell
    Supports supports;
    // Cells stiffer than this times the softest cell move as rigid bodies (by exact elimination, without a penalty):
    // beyond it the factorisation would lose the digits that the soft cells need.
    double rigid_contrast = 1e8;
};

// Everything that does not depend on the loads.
struct Factored {
    LowerMatrix K_N_per_m;  // of all dofs, without rigid cells
    Reduction reduction;
    LowerMatrix A_N_per_m;  // of the equations that are left
    SparseCholesky cholesky;
    MeshReport report;
    double assemble_s = 0.0;
    double factor_s = 0.0;
};

// Checks materials, mesh and supports (MaterialError, MeshError, SupportError), assembles and factors (SolverError,
// OutOfMemory).
Factored factorise(const Problem& problem, SolverKind solver);

struct Solution {
    Eigen::Matrix3Xd u_m;
    Eigen::Matrix3Xd reaction_N;  // of the supports on the body; 0 at free dofs
    double energy_J = 0.0;        // 1/2 u^T K u
    double work_J = 0.0;          // 1/2 (f^T u + reaction^T u), which equals energy_J up to round-off
    double backward_error = 0.0;
    double solve_s = 0.0;
};

// load_N: 3 x n_nodes. Throws LoadError for another size or numbers that are not finite.
Solution solve(const Factored& factored, const Eigen::Matrix3Xd& load_N);

}  // namespace palpa::mechanics
