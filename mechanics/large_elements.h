#pragma once
// Energy, gradient and tangent of one cell at large strains.
//
// With the deformation gradient F_g = x grad N at Gauss point g, of weight w_g (rest volume, m^3):
//
//   hex8, tet4   E = sum_g w_g W(F_g)
//   hex8_bbar    E = sum_g w_g W((Jbar / J_g)^(1/3) F_g),   J = det F,   Jbar = sum_g w_g J_g / V       for W(I, J)
//                E = sum_g w_g [ mu |F_g - R_g|^2 - mu/3 t_g^2 ] + V kappa/2 tbar^2,   t = tr S - 3     for corotational
//                with tbar the mean of t_g
//
// so that hex8_bbar takes the change of volume as one number for the cell and does not lock. Both forms of it have
// hex8_bbar_stiffness_N_per_m (elements.h) as tangent at rest.
//
// Source of the first form: Moran, Ortiz & Shih, "Formulation of implicit finite element methods for multiplicative
// finite deformation plasticity", IJNME 29 (1990), with the energy at F-bar in the place of its stress, so that the
// tangent is symmetric. The second form is ours.

#include <array>
#include <cstddef>

#include "mechanics/elements.h"
#include "mechanics/hyperelastic.h"

namespace palpa::mechanics {

// What a cell of N corners is at rest: gradients of the shape functions and weights, by Gauss points.
template <int N>
struct CellRest {
    static constexpr std::size_t kPoints = N == 8 ? 8 : 1;
    std::array<Eigen::Matrix<double, 3, N>, kPoints> gradient_per_m;
    std::array<double, kPoints> volume_m3;
};
CellRest<8> rest_of(const Hex& corners_m);
CellRest<4> rest_of(const Tet& corners_m);

enum class Wanted { energy, gradient, tangent };  // each includes those before it

template <int N>
struct LargeCell {
    double energy_J = 0.0;
    Eigen::Matrix<double, 3, N> gradient_N;               // of the energy: minus the force on each corner
    Eigen::Matrix<double, 3 * N, 3 * N> tangent_N_per_m;  // node by node, x y z; symmetric
};

// x_m: the corners as they are now. mean_volume: the form of hex8_bbar (for N = 8 alone). Where the energy is infinite
// (hyperelastic.h; with mean_volume and W(I, J) also for J_g <= 0), the other fields are not written.
template <int N>
void large_cell(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume,
                const Eigen::Matrix<double, 3, N>& x_m, Wanted wanted, LargeCell<N>& out);

// Sets the negative eigenvalues of a cell's tangent to 0.
template <int N>
void make_positive(Eigen::Matrix<double, 3 * N, 3 * N>& tangent_N_per_m);

// Means over a cell of the Green-Lagrange strain (F^T F - 1)/2 and the Cauchy stress, weighted by rest volumes; shear
// strains are engineering strains (material.h). The stress is NaN where the cell is turned inside out.
struct LargeFields {
    Voigt strain = Voigt::Zero();
    Voigt stress_Pa = Voigt::Zero();
};
template <int N>
LargeFields large_fields(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume,
                         const Eigen::Matrix<double, 3, N>& x_m);

}  // namespace palpa::mechanics
