#pragma once
// Closed forms and quadratures that the finite elements are measured against.

namespace palpa::mechanics {

struct ParabolicPatch {
    double radius_m = 0.008;
    double force_N = 0.025;
};

struct Layer {
    double young_Pa = 2500.0;
    double poisson = 0.45;
    double thickness_m = 0.05;
};

// Returns the depression at radius r of an elastic layer, bonded to a rigid base and infinitely wide, under
// p(r) = P (1 - r^2/a^2):
//   u(r) = 2 (1 - nu^2)/E  int_0^inf  2 P J2(k a)/k^2  J0(k r)  W(k h) dk,    P = 2 F / (pi a^2)
//   W(x) = (2 kap sinh 2x - 4 x) / (2 kap cosh 2x + 4 x^2 + 1 + kap^2),       kap = 3 - 4 nu
// Computed as the half-space in closed form plus the integral with W - 1, which is cut off at k h = 40. The formula is
// the Hankel transform of order 0 of the layer's equilibrium; finite elements of a wide slab agree with it to 0.3 %
// (tests/mechanics/test_statics.cpp).
double layer_depression_m(const Layer& layer, const ParabolicPatch& patch, double r_m);

// Returns the work-conjugate mean depression, int p u dA / F.
double layer_mean_depression_m(const Layer& layer, const ParabolicPatch& patch);

// The same two on a half-space. The depression is 2 (1 - nu^2)/E 2 P times
//   r <= a:  a/3 2F1(1/2, -3/2; 1; r^2/a^2)         r > a:  a^2/(8 r) 2F1(1/2, 1/2; 3; a^2/r^2)
double half_space_depression_m(const Layer& layer, const ParabolicPatch& patch, double r_m);
double half_space_mean_depression_m(const Layer& layer, const ParabolicPatch& patch);

// Returns E* = E / (1 - nu^2).
inline double plane_strain_modulus_Pa(double young_Pa, double poisson) { return young_Pa / (1.0 - poisson * poisson); }

// Rigid sphere on a half-space (Hertz):  F = 4/3 E* sqrt(R) d^1.5,  a = sqrt(R d),  p0 = 3 F / (2 pi a^2)
double hertz_force_N(double plane_modulus_Pa, double radius_m, double depth_m);
double hertz_contact_radius_m(double radius_m, double depth_m);

// Rigid sphere on a bonded incompressible layer, with x = sqrt(R d)/h:
//   F = Hertz's force (1 + 1.133 x + 1.283 x^2 + 0.769 x^3 + 0.0975 x^4)
// Source: Dimitriadis et al., Biophys. J. 82 (2002) 2798, equation (12).
double dimitriadis_force_N(double young_Pa, double radius_m, double depth_m, double thickness_m);

// Flat round punch of radius a on a half-space:  F = 2 E* a d
double punch_force_N(double plane_modulus_Pa, double punch_radius_m, double depth_m);

// Point load on a half-space (Boussinesq):  u(r) = F / (pi E* r); singular under the load.
double boussinesq_depression_m(double plane_modulus_Pa, double force_N, double r_m);

}  // namespace palpa::mechanics
