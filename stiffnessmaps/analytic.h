#pragma once
// A force map in closed form: a stand-in for a recording, with the right orders of size and the right shape,
// not a simulation. It says "analytic" in its source.

#include "stiffnessmaps/phantom.h"

namespace palpa::stiffnessmaps {

// Force on a rigid sphere pressed into an elastic layer that is bonded to its base, N.
//   F = 4 E/(3 (1 - nu^2)) sqrt(R) d^1.5 [1 - 2 a c/pi + 4 a^2 c^2/pi^2 - 8 (a^3 + 4 pi^2 b/15) c^3/pi^3
//                                          + 16 a (a^3 + 3 pi^2 b/5) c^4/pi^4],   c = sqrt(R d)/h
//   a = -(1.2876 - 1.4678 nu + 1.3442 nu^2)/(1 - nu),   b = (0.6387 - 1.0277 nu + 1.5164 nu^2)/(1 - nu)
// Source: Dimitriadis et al., Biophysical Journal 82 (2002) 2798. A paraboloid in small strains: beyond
// d = R it is an extrapolation.
double layer_force_N(const Elastic& tissue, double radius_m, double depth_m, double thickness_m);

// Normal force of the whole phantom at (x, y): the layer's force times 1 + sum over the nodules of
//   c exp(-r^2 / (2 w^2)),   c = s (F(d; top)/F(d; h) - 1),   s = D^2/(D^2 + (2 top)^2),   w^2 = (D/2)^2 + (top/2)^2
// D the nodule's diameter, `top` the depth of its top: as if a piece of the stiff base stood there, weaker
// the smaller it is. Judged by its order of size only; the moduli of the nodules do not enter.
double phantom_force_N(const Phantom& phantom, double x_m, double y_m, double depth_m);

// The map of all grid points and depths, with tangential forces by the work argument (field.h).
Map analytic_map(const Phantom& phantom);

}  // namespace palpa::stiffnessmaps
