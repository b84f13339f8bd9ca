#pragma once
// Loads as nodal forces, 3 x n_nodes, newtons.

#include <Eigen/Core>
#include <array>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

// The pressure of a finger pad that presses on one side of the body:
//   p(r) = Pmax (1 - 4 r^2/d0^2) for r <= d0/2,   Pmax = 8 F / (pi d0^2)
// Source: "Integrating Tactile and Force Feedback with Finite Element Models", equation (1).
struct ParabolicPressure {
    Side side = Side::zmax;
    std::array<double, 2> centre_m{0.0, 0.0};  // the two other axes in the order x, y, z
    double diameter_m = 0.016;
    double force_N = 0.025;
};

// consistent  F_i = int p N_i dA, exact on triangles and parallelograms. Other quads are split into triangles in both
//             ways, and the mean is taken, which keeps the total and the first moment exact.
// thirds      each corner of a face gets an equal share of the face's force, as in equation (2) of the same paper: the
//             total is right, the first moment is not.
enum class LoadShare { consistent, thirds };

struct PressureLoad {
    Eigen::Matrix3Xd force_N;  // 3 x n_nodes
    double applied_N = 0.0;    // the part of the force that falls on the side
    bool partial = false;      // part of the disc is beside the body
};
// Throws LoadError for a diameter that is not > 0 and for numbers that are not finite.
PressureLoad parabolic_load(const Mesh& mesh, const Faces& outer, const ParabolicPressure& pressure, LoadShare share);

// Constant traction t on faces, x, y, z: F_i = A_i t, with the tributary area A_i. Throws LoadError if it is not
// finite.
Eigen::Matrix3Xd traction_load(const Mesh& mesh, const Faces& faces, const std::array<double, 3>& traction_Pa);

// Constant pressure into the body on faces that may be bent: F_i = -p int N_i n dA (2 x 2 Gauss points on quads).
// Throws LoadError if it is not finite.
Eigen::Matrix3Xd pressure_load(const Mesh& mesh, const Faces& faces, double pressure_Pa);

// Returns the work-conjugate mean displacement of a load: sum f . u / applied_N, metres, positive along the load.
double mean_displacement_m(const PressureLoad& load, const Eigen::Matrix3Xd& u_m);

}  // namespace palpa::mechanics
