#pragma once
// Stiffness, strain and stress of one cell, small strains.

#include <Eigen/Core>

#include "mechanics/material.h"

namespace palpa::mechanics {

// hex8_bbar: full integration of the shape change, the volume change averaged over the cell (mean
// dilatation). hex8:      full 2 x 2 x 2 integration (CalculiX C3D8); locks as poisson nears 0.5. tet4:
// constant strain (C3D4); locks much more.
enum class Element { hex8_bbar, hex8, tet4 };

using Hex = Eigen::Matrix<double, 3, 8>;  // corner positions or displacements
using Tet = Eigen::Matrix<double, 3, 4>;
using HexMatrix = Eigen::Matrix<double, 24, 24>;
using TetMatrix = Eigen::Matrix<double, 12, 12>;

// Gradients of the shape functions and the weight (det J times Gauss weight, m^3) at point g of 0..7.
struct HexPoint {
    Hex gradient_per_m;
    double volume_m3 = 0.0;
};
HexPoint hex_point(const Hex& corners_m, int g);

// N/m; degrees of freedom node by node, x y z. With g_a = grad N_a and G_a its mean over the cell:
//
//   K_ab = sum_g w [ mu ( (g_a . g_b) I + g_b g_a^T ) + lambda' g_a g_b^T ]  (+ kappa V G_a G_b^T with B-bar)
//
// lambda' = lambda (full) or -2 mu / 3 (B-bar, whose kappa term takes over the volume change).
// Source: Hughes, The Finite Element Method (1987), section 4.5.2; written per node pair instead of B^T D B.
HexMatrix hex8_stiffness_N_per_m(const Hex& corners_m, const Material& material);
HexMatrix hex8_bbar_stiffness_N_per_m(const Hex& corners_m, const Material& material);
TetMatrix tet4_stiffness_N_per_m(const Tet& corners_m, const Material& material);

// Mean strain over the cell: sym(sum_a u_a G_a^T), the same for full and B-bar.
Voigt mean_strain(const Hex& corners_m, const Hex& u_m);
Voigt mean_strain(const Tet& corners_m, const Tet& u_m);

// Volume and shape-function gradients of a tetrahedron; the volume is negative for an inverted one.
double tet_gradients_per_m(const Tet& corners_m, Tet& gradient_per_m);

}  // namespace palpa::mechanics
