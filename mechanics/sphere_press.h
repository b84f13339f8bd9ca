#pragma once
// A rigid sphere pressed into a block at large strains, frictionless, by one Newton step at a time: for loops that follow
// a finger. Step by step at one depth it converges to the equilibrium.
//
// With the sphere's centre c, its radius R and the unit normals n_k = (x_k - c) / |x_k - c| at the nodes of the surface, a
// step du from u solves
//
//   K du = -grad E(u) + sum_k p_k n_k,     0 <= p_k   and   g_k + n_k . du_k >= 0,  one of the two 0,     g_k = |x_k - c| - R
//
// where K is the current tangent of the energy E less the curvature of the contact, sum_k p_k (1 - n_k n_k^T) / |x_k - c|, of
// the step before. Eliminated to the nodes of the contact this is a linear complementarity problem (mechanics/lcp.h). The
// sphere is the god-object: it stays on the surface, and the pressures p keep it there.
// Source: Wriggers, Computational Contact Mechanics, 2nd edition (2006), sections 5.3 and 6.3 (contact of nodes, and its
// linearisation).
//
// The sphere stands over the middle of the block, so that a quarter of it is computed.

#include <array>

#include "mechanics/banded.h"
#include "mechanics/large_body.h"
#include "mechanics/lcp.h"

namespace palpa::mechanics {

// The block: bonded at its base, free at its sides.
struct SpherePressBlock {
    std::array<double, 3> size_m{0.04, 0.04, 0.02};
    LargeMaterial material;
    double radius_m = 8e-3;  // of the sphere
    double finest_m = 1e-3;  // cells under the sphere
    int cells = 5;           // along each half side, and over the height
};

// Prepared once; constant while it runs.
struct SpherePress {
    SpherePressBlock block;
    LargeBody body;             // a quarter: the corner at the origin is under the sphere
    std::vector<int> equation;  // one per dof; -1: held
    LowerMatrix reduced;        // pattern of the free equations
    std::vector<int> source;    // for each of its values the position in the tangent of the whole body
    BandedFactor factor;        // analysed
    std::vector<int> touch;     // nodes of the surface that the sphere can reach
    double greatest_depth_m = 0.0;
};

// What a step changes.
struct SpherePressWork {
    Eigen::Matrix3Xd u_m;
    Eigen::VectorXd p_N;  // of the touch nodes
    double depth_m = 0.0;
    // scratch
    Eigen::Matrix3Xd gradient_N;
    Eigen::Matrix3Xd trial_m;
    Eigen::Matrix3Xd normal;  // of the touch nodes
    Eigen::VectorXd gap_m;
    LowerMatrix K_N_per_m;
    LowerMatrix A;
    BandedFactor factor;
    Eigen::MatrixXd block;  // equations x (1 + touch nodes)
    Eigen::MatrixXd compliance_m_per_N;
    Eigen::VectorXd b_m;
    Eigen::VectorXd slope;
    LcpWork lcp;
};

struct SpherePressAnswer {
    double force_N = 0.0;        // of the whole block on the sphere
    double slope_N_per_m = 0.0;  // to a few per cent: as if the normals did not turn
    double residual_N = 0.0;     // greatest force out of balance before the step
    bool valid = true;           // false: no step could be taken; the work is as before
};

// greatest_depth_m: less than 0.6 of the height and than the radius. Throws MaterialError, MeshError and LoadError for what
// cannot be computed with, and SolverError in a build without LAPACK.
SpherePress make_sphere_press(const SpherePressBlock& block, double greatest_depth_m);
SpherePressWork make_work(const SpherePress& press);

// One step with the sphere at a depth, which is clamped to 0 ... greatest_depth_m. Allocates nothing, throws nothing.
SpherePressAnswer step_to(const SpherePress& press, double depth_m, SpherePressWork& work) noexcept;

// Steps at one depth until the forces balance to 1e-9 of the greatest, at most 60.
SpherePressAnswer converge_at(const SpherePress& press, double depth_m, SpherePressWork& work) noexcept;

}  // namespace palpa::mechanics
