#pragma once
// Exact integrals of a parabolic pressure over straight-sided cells.

#include <Eigen/Core>

namespace palpa::mechanics {

// Integrals of (1 - r^2/R^2) times 1, x, y, x^2, x y, y^2 over the part of a polygon inside the disc r <= R
// about the origin. corners_m: 2 x n, positive area when counter-clockwise (a clockwise polygon gives minus
// its value).
//
// By edges, no case distinction for overlap: each edge is cut where it crosses the circle. A piece p -> q
// inside adds the fan triangle (0, p, q) (signed), integrated by Radon's seven points, exact to degree 5. A
// piece outside adds the sector theta = atan2(p x q, p . q) from angle t to u = t + theta:
//   1: R^2 theta/4    x: 2 R^3 (sin u - sin t)/15    y: -2 R^3 (cos u - cos t)/15
//   x^2: R^4/12 (theta/2 + (sin 2u - sin 2t)/4)    x y: R^4/12 (sin^2 u - sin^2 t)/2    y^2: as x^2 with a
//   minus
// Source: numerics.md section 6.6; the second-degree moments, for bilinear faces, are ours.
using DiscMoments = Eigen::Matrix<double, 6, 1>;
DiscMoments disc_moments(const Eigen::Matrix2Xd& corners_m, double radius_m);

}  // namespace palpa::mechanics
