#pragma once
// A cantilever of pieces that bends by any angle: the elastica.

#include <span>

#include "mechanics/beam.h"

namespace palpa::mechanics {

struct ElasticaTip {
    double across_m = 0.0;      // along the force
    double shortening_m = 0.0;  // along the axis at rest
    double slope_rad = 0.0;
};

// Tip of a cantilever under a force at the tip that keeps its direction, square to the axis at rest. It bends without
// stretch or shear:
//   D dtheta/ds = M,   dM/ds = -F cos theta,   theta(0) = 0,   M(L) = 0
// Integrated from the tip inwards (Runge and Kutta's fourth order, at most 1/200 of the length and 1/40 of sqrt(D / F) a
// step), with the tip's slope searched for by halving: theta at the clamp grows with it. Where more than 30 lengths
// sqrt(D / F) lie between clamp and tip, the rest hangs straight along the force (to 1e-13). Forces that turn the tip by less
// than 1e-4 rad are taken in proportion. Holds for slopes below a quarter turn, which no force of constant direction exceeds.
// 1e-7 of the elliptic integrals up to F L^2 / D = 10, and 1e-7 of L of the hanging beam's limit beyond, for any force.
// Source: Bisshopp, Drucker, "Large deflection of cantilever beams", Quarterly of Applied Mathematics 3 (1945), 272-275;
//         pieces of different stiffness are ours. clamped_low: as beam_tip(). 0 pieces and a force of 0 give 0; the sign of
//         the force is that of across_m.
ElasticaTip elastica_tip(std::span<const BeamPiece> pieces, bool clamped_low, double force_N);

}  // namespace palpa::mechanics
