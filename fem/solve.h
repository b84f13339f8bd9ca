#pragma once
// A case, solved: what `palpa fem solve` reports and writes.

#include "fem/indenter.h"
#include "files/vtu.h"
#include "mechanics/linear_range.h"

namespace palpa::fem {

inline constexpr double kMostBackwardError = 1e-12;  // of a solution that counts as converged

struct FemResult {
    mechanics::Solution solution;
    mechanics::CellFields fields;
    Eigen::VectorXd von_mises_Pa;  // per cell; NaN in cells that move as rigid bodies
    int equations = 0;
    // Of the tissue on each support's side: force of the support on the body. A displacement that two
    // supports give counts for the first of them.
    std::vector<Eigen::Vector3d> reaction_N;
    Eigen::Vector3d body_reaction_N = Eigen::Vector3d::Zero();  // on rigid bodies, beside the supports' own nodes
    std::optional<IndenterContact> contact;

    double applied_N = 0.0;          // sum of the loads' sizes
    bool partial = false;            // part of a pressure fell beside the body
    std::optional<double> centre_m;  // displacement under the first load's centre, into the tissue positive
    std::optional<double> skel_m;    // work-conjugate mean, sum f . u / applied
    double max_displacement_m = 0.0;

    double residual = 0.0;  // |b - A q| / |b|, maximum norm; see also solution.backward_error
    bool converged = false;

    double max_strain = 0.0;  // largest magnitude of a principal strain
    double linear_ratio = 0.0;
    mechanics::LinearRange linear = mechanics::LinearRange::fine;

    double assemble_s = 0.0;
    double factor_s = 0.0;
};

// Throws InputError for what only solving shows to be wrong, SolverError when the factorisation failed, and
// std::runtime_error when an answer is not finite.
FemResult solve_case(const FemCase& model, const FemProgress& progress);

// In mm: displacement_mm and reaction_N on points; strain (tensor components), stress_Pa, von_mises_Pa and
// material (position in FemCase::materials) in cells.
files::VtuGrid vtu_of(const FemCase& model, const FemResult& result);

}  // namespace palpa::fem
