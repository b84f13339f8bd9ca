#pragma once
// Stiffness and mean strain of one cell, for small strains.

#include <Eigen/Core>
#include <array>
#include <string_view>

#include "mechanics/material.h"

namespace palpa::mechanics {

// hex8_bbar  integrates the change of shape fully and averages the change of volume over the cell (mean dilatation)
// hex8       integrates all at 2 x 2 x 2 points (CalculiX C3D8); locks as Poisson's ratio nears 0.5
// tet4       has constant strain (CalculiX C3D4); locks much more
// hex8i      hex8 with nine incompatible modes, which bends as thin walls do (CalculiX C3D8I)
enum class Element { hex8_bbar, hex8, tet4, hex8i };

// The names of the elements in files, in the order of the enum.
inline constexpr std::array<const char*, 4> kElementNames{"hex8-bbar", "hex8", "tet4", "hex8i"};
inline const char* name_of(Element element) { return kElementNames[static_cast<std::size_t>(element)]; }

using Hex = Eigen::Matrix<double, 3, 8>;  // positions or displacements of the corners, in VTK order
using Tet = Eigen::Matrix<double, 3, 4>;
using HexMatrix = Eigen::Matrix<double, 24, 24>;
using TetMatrix = Eigen::Matrix<double, 12, 12>;

// Gradients of the shape functions, and the weight (det J times Gauss weight, m^3), at Gauss point g, 0 ... 7.
struct HexPoint {
    Hex gradient_per_m;
    double volume_m3 = 0.0;
};
HexPoint hex_point(const Hex& corners_m, int g);
// The same in the middle of the cell, with the weight 8.
HexPoint hex_middle(const Hex& corners_m);

// Stiffness of a cell, N/m. Degrees of freedom are ordered node by node, x y z. With g_a = grad N_a and G_a its mean
// over the cell:
//
//   K_ab = sum_g w [ mu ( (g_a . g_b) I + g_b g_a^T ) + lambda' g_a g_b^T ]  (+ kappa V G_a G_b^T with B-bar)
//
// w: weight of Gauss point g; V: volume of the cell. lambda' = lambda with full integration; with B-bar, whose kappa
// term takes over the change of volume, lambda' = -2 mu / 3.
// Source: Hughes, The Finite Element Method (1987), section 4.5.2; written for pairs of nodes instead of B^T D B.
HexMatrix hex8_stiffness_N_per_m(const Hex& corners_m, const Material& material);
HexMatrix hex8_bbar_stiffness_N_per_m(const Hex& corners_m, const Material& material);
TetMatrix tet4_stiffness_N_per_m(const Tet& corners_m, const Material& material);

// hex8i: beside the corners' shape functions stand the modes 1 - r^2, 1 - s^2 and 1 - t^2 of each axis, with gradients
// taken as J0^-T (det J0 / det J) grad, J0 the Jacobian in the middle, so that a uniform strain needs none of them; their
// nine unknowns are eliminated cell by cell.
// Source: Taylor, Beresford & Wilson, "A non-conforming element for stress analysis", IJNME 10 (1976).
HexMatrix hex8i_stiffness_N_per_m(const Hex& corners_m, const Material& material);

// Returns the mean strain over the cell, sym(sum_a u_a G_a^T), which is the same with full integration and with B-bar.
Voigt mean_strain(const Hex& corners_m, const Hex& u_m);
Voigt mean_strain(const Tet& corners_m, const Tet& u_m);

// Computes the shape functions' gradients of a tetrahedron and returns its volume (m^3), negative if it is inverted.
double tet_gradients_per_m(const Tet& corners_m, Tet& gradient_per_m);

}  // namespace palpa::mechanics
