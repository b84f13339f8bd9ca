#pragma once
// Elastic laws for large strains, as energy per rest volume of the deformation gradient F.
//
// Isotropic laws are W(I, J) with I = F : F and J = det F. All of them have shear modulus mu and bulk modulus kappa at
// rest, where W = 0; lambda = kappa - 2 mu / 3:
//
//   neo_hookean         mu/2 (I - 3) - mu ln J + lambda/2 (ln J)^2
//   neo_hookean_split   mu/2 (J^(-2/3) I - 3) + kappa/2 (J - 1)^2      (CalculiX: C10 = mu/2, D1 = 2/kappa)
//   stable_neo_hookean  m/2 (I - 3) + l/2 ((J - a)^2 - (1 - a)^2) - m/2 ln((I + 1)/4),
//                       m = 4/3 mu, l = lambda + 5/6 mu, a = 1 + 3/4 m / l
//
// The first is infinite at J <= 0, and so is the second; the third is finite everywhere. Forms of one name differ: by
// 5 to 7 % in the force at twice the length. Hence results name the form.
//
// corotational, with F = R S (R the rotation nearest to F, det R = +1):
//
//   W = mu |F - R|^2 + lambda/2 (tr S - 3)^2
//
// It is the linear law in the strain S - 1, which rotations leave alone; it is finite even for a body crushed flat.
//
// Sources: Bonet & Wood, Nonlinear Continuum Mechanics for Finite Element Analysis, 2nd edition (2008), section 6.4
// (the first two); Smith, de Goes & Kim, "Stable Neo-Hookean Flesh Simulation", ACM Trans. Graph. 37(2), 2018,
// equation (14) and section 3.4 (the third); Sifakis & Barbic, SIGGRAPH 2012 course "FEM Simulation of 3D Deformable
// Solids", section 3.4 (the last).

#include <Eigen/Core>
#include <array>
#include <span>
#include <string_view>

#include "mechanics/material.h"

namespace palpa::mechanics {

enum class Law { linear, neo_hookean, neo_hookean_split, stable_neo_hookean, corotational };

// The names of the laws in files, in the order of the enum: "neo-hookean-split".
inline constexpr std::array<std::string_view, 5> kLawNames{"linear", "neo-hookean", "neo-hookean-split",
                                                           "stable-neo-hookean", "corotational"};
inline std::string_view name_of(Law law) { return kLawNames[static_cast<std::size_t>(law)]; }

struct LargeMaterial {
    Law law = Law::neo_hookean;  // not linear, which is not indifferent to rotations
    double mu_Pa = 45e3;
    double kappa_Pa = 430e3;
};

// Throws MaterialError with the entries unless both moduli are > 0 and finite and the law is not linear.
void check_large_materials(std::span<const LargeMaterial> materials);

// The same moduli at rest as Young's modulus and Poisson's ratio, and back.
Material at_rest(const LargeMaterial& material);
LargeMaterial with_law(const Material& material, Law law);

// Energy density and its derivatives. W is infinite, and the rest is 0, where the law is not defined.
struct EnergyDensity {
    double W_Pa = 0.0;
    double I = 0.0, J = 0.0;              // dW/dI, dW/dJ, Pa
    double II = 0.0, IJ = 0.0, JJ = 0.0;  // second derivatives, Pa
};

// W(I, J). Not for linear and corotational.
EnergyDensity energy_density(const LargeMaterial& material, double I, double J);

// What the laws take of J, for many points of one J.
struct VolumeChange {
    double J = 1.0;
    double two_thirds = 1.0;  // J^(2/3)
    double log = 0.0;
};
VolumeChange volume_change(double J);  // not a number but for J where J <= 0

// The same as a function of A = J^(-2/3) I, which measures the change of shape alone, and of J: the fields I, II and IJ
// hold the derivatives by A. Infinite at J <= 0 for every law.
EnergyDensity split_energy_density(const LargeMaterial& material, double A, const VolumeChange& volume);
inline EnergyDensity split_energy_density(const LargeMaterial& material, double A, double J) {
    return split_energy_density(material, A, volume_change(J));
}

// F = U diag(s) V^T with rotations U and V; the entry of s of smallest magnitude, the last, is negative where det F < 0.
// R = U V^T.
struct Stretches {
    Eigen::Matrix3d U, V;
    Eigen::Vector3d s;
    Eigen::Matrix3d rotation() const { return U * V.transpose(); }
};
Stretches stretches_of(const Eigen::Matrix3d& F);

// The rotation nearest to F, and what its derivative needs. With S = R^T F (symmetric):
//   dR = R [w]_x,   w = inverse axl(R^T dF),   inverse = (tr S 1 - S)^-1,   axl(A) = (A_32 - A_23, A_13 - A_31, A_21 - A_12)
// R jumps where two stretches are opposite; there `inverse` is kept finite, for a line search to deal with.
// Newton's iteration for the polar factor (Higham, SIAM J. Sci. Stat. Comput. 7, 1986) where F is far from singular, else
// from the stretches.
struct Polar {
    Eigen::Matrix3d R, S, inverse;
};
Polar polar_of(const Eigen::Matrix3d& F);

// Cauchy stress, Pa, at a deformation gradient with det F > 0.
Eigen::Matrix3d cauchy_stress_Pa(const LargeMaterial& material, const Eigen::Matrix3d& F);

}  // namespace palpa::mechanics
