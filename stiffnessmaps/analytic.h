#pragma once
// A force map in closed form: a stand-in for a recording, of the right order of magnitude and shape, but no simulation.
// The source of the map says "analytic".

#include "stiffnessmaps/phantom.h"

namespace palpa::stiffnessmaps {

// Returns the force on a rigid sphere pressed into an elastic layer that is bonded to its base, N.
//   F = 4 E/(3 (1 - nu^2)) sqrt(R) d^1.5 [1 - 2 a c/pi + 4 a^2 c^2/pi^2 - 8 (a^3 + 4 pi^2 b/15) c^3/pi^3
//                                          + 16 a (a^3 + 3 pi^2 b/5) c^4/pi^4],   c = sqrt(R d)/h
//   a = -(1.2876 - 1.4678 nu + 1.3442 nu^2)/(1 - nu),   b = (0.6387 - 1.0277 nu + 1.5164 nu^2)/(1 - nu)
// Source: Dimitriadis et al., Biophysical Journal 82 (2002) 2798, for a paraboloid and small strains: beyond d = R it
// is an extrapolation.
double layer_force_N(const Elastic& tissue, double radius_m, double depth_m, double thickness_m);

// Returns the normal force of the whole phantom at (x, y), N: the layer's force times 1 + sum over the nodules of
//   c exp(-r^2 / (2 w^2)),   c = s (F(d; top)/F(d; h) - 1),   s = D^2/(D^2 + (2 top)^2),   w^2 = (D/2)^2 + (top/2)^2
// with D the nodule's diameter and `top` the depth of its top: a nodule acts as a piece of the rigid base in its place,
// and less the smaller it is. Only the order of magnitude was checked; the moduli of the nodules do not enter.
double phantom_force_N(const Phantom& phantom, double x_m, double y_m, double depth_m);

// Returns the map of all grid points and depths, with tangential forces by the work argument (field.h).
Map analytic_map(const Phantom& phantom);

}  // namespace palpa::stiffnessmaps
