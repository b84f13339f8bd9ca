#pragma once
// Static equilibrium at large strains: displacements where the energy of the body less the work of the loads has a
// minimum.
//
// Newton's method with a line search (Armijo's rule; an infinite energy is refused). Loads and prescribed displacements
// grow together by one factor, 0 to 1: at first all at once, and half as far after every failure. The tangent is exact;
// only where its factorisation fails are the negative eigenvalues of the cells taken out. Loads keep direction and
// size (dead loads).
// Source: Nocedal & Wright, Numerical Optimization, 2nd edition (2006), sections 3.1 and 3.4.

#include <optional>

#include "mechanics/large_body.h"
#include "mechanics/solver.h"
#include "mechanics/supports.h"

namespace palpa::mechanics {

struct LargeProblem {
    Mesh mesh;
    Element element = Element::hex8_bbar;
    std::vector<LargeMaterial> materials;  // one per cell
    Supports supports;
};

struct LargeOptions {
    // Greatest out-of-balance force at a free dof over the greatest load or reaction at a dof. Where both vanish, the
    // round-off of the nodal forces counts as balanced.
    double tolerance = 1e-9;
    int most_iterations = 50;  // in one load step
    int most_halvings = 40;    // of the load step, in all
    // Absent: banded where a factorisation takes less than kBandedWork operations, else best_solver().
    std::optional<SolverKind> solver;
};
inline constexpr double kBandedWork = 2e9;  // about a second on one core

enum class LargeStatus {
    converged,
    stopped,  // a part of the load was reached; the result is the equilibrium there
};

struct LargeSolution {
    LargeStatus status = LargeStatus::stopped;
    double load_share = 0.0;  // of loads and prescribed displacements that the result belongs to
    // The tangent is positive definite there: small disturbances do not grow. False past a buckling load.
    bool stable = false;
    Eigen::Matrix3Xd u_m;
    Eigen::Matrix3Xd reaction_N;  // of the supports on the body; 0 at free dofs
    double energy_J = 0.0;        // elastic
    double residual = 0.0;        // as LargeOptions::tolerance, and at most that
    int equations = 0;
    int load_steps = 0;
    int iterations = 0;
    int halvings = 0;  // of the load step
    int repairs = 0;   // of the tangent
    SolverKind solver = SolverKind::eigen;
    double assemble_s = 0.0;
    double factor_s = 0.0;
    double solve_s = 0.0;
};

// load_N: 3 x n_nodes. start_m: displacements to begin with, of finite energy (absent: at rest); the free ones count.
// Throws MaterialError, MeshError, SupportError and LoadError for what cannot be computed with, and OutOfMemory; what
// fails in the computation itself is a status, and then the fields are those of the greatest share that was reached.
LargeSolution solve_large(const LargeProblem& problem, const Eigen::Matrix3Xd& load_N, const LargeOptions& options = {},
                          const std::optional<Eigen::Matrix3Xd>& start_m = {});

}  // namespace palpa::mechanics
