#pragma once
// Solves a case: what `palpa fem solve` reports and writes.

#include "fem/indenter.h"
#include "files/vtu.h"
#include "mechanics/large_strain.h"
#include "mechanics/linear_range.h"

namespace palpa::fem {

inline constexpr double kMostBackwardError = 1e-12;  // that a converged solution may have

struct FemResult {
    mechanics::Solution solution;  // with laws for large strains: without work and backward error
    // How equilibrium was found; absent for linear materials. Its displacements and reactions stand in `solution`.
    std::optional<mechanics::LargeSolution> large;
    mechanics::CellFields fields;  // large strains: Green-Lagrange strain, Cauchy stress
    Eigen::VectorXd von_mises_Pa;  // per cell; NaN in cells that move as rigid bodies
    int equations = 0;
    // Force of each support on the body, at the dofs that the support itself fixes. A displacement that two supports
    // give counts for the first of them.
    std::vector<Eigen::Vector3d> reaction_N;
    // What supports carry through rigid bodies that they hold, at the other nodes of these bodies.
    Eigen::Vector3d body_reaction_N = Eigen::Vector3d::Zero();
    std::optional<IndenterContact> contact;

    double applied_N = 0.0;  // sum of the loads' sizes that fell on the body
    bool partial = false;    // part of a pressure fell beside the body
    // Displacement into the body under the centre of the indenter, else of the first pressure, else of the first
    // traction; absent without loads.
    std::optional<double> centre_m;
    std::optional<double> skel_m;  // work-conjugate mean displacement, sum f . u / applied_N
    double max_displacement_m = 0.0;

    // Largest out-of-balance force over the largest nodal load or reaction; see also solution.backward_error.
    double residual = 0.0;
    // Backward error below kMostBackwardError, and the contact settled; large strains: the whole load was reached.
    bool converged = false;

    double max_strain = 0.0;        // largest magnitude of a principal strain
    double max_rotation_rad = 0.0;  // of a cell; 0 for large strains
    double linear_ratio = 0.0;      // mechanics/linear_range.h; 0 for large strains
    mechanics::LinearRange linear = mechanics::LinearRange::fine;

    double assemble_s = 0.0;
    double factor_s = 0.0;
};

// Throws InputError for what only solving shows to be wrong, SolverError if the factorisation failed, and
// std::runtime_error if the displacement is not finite.
FemResult solve_case(const FemCase& model, const FemProgress& progress);

// Returns the whole field, with points in mm: displacement_mm and reaction_N on points; strain (tensor components),
// stress_Pa, von_mises_Pa and material (position in FemCase::materials) in cells.
files::VtuGrid vtu_of(const FemCase& model, const FemResult& result);

}  // namespace palpa::fem
