#pragma once
// Exact integrals of a parabolic pressure over straight-sided cells.

#include <Eigen/Core>

namespace palpa::mechanics {

// Integrals of (1 - r^2/R^2) times 1, x, y, x^2, x y, y^2 over the part of a polygon inside the disc r <= R about the
// origin, in m^2, m^3 and m^4. corners_m: 2 x n, counter-clockwise; a clockwise polygon gives the negative of its
// value.
//
// The integral is a sum over edges, so that no kind of overlap is a special case. Each edge is cut where it crosses the
// circle. A piece p -> q inside adds the signed fan triangle (0, p, q), integrated by Radon's seven points, which are
// exact to degree 5. A piece outside adds the sector of the angle theta = atan2(p x q, p . q), from t to u = t + theta:
//   1: R^2 theta/4    x: 2 R^3 (sin u - sin t)/15    y: -2 R^3 (cos u - cos t)/15
//   x^2: R^4/12 (theta/2 + (sin 2u - sin 2t)/4)      y^2: R^4/12 (theta/2 - (sin 2u - sin 2t)/4)
//   x y: R^4/12 (sin^2 u - sin^2 t)/2
// The sectors are integrated in closed form here; tests/mechanics/test_disc_integral.cpp compares all moments with
// brute force.
using DiscMoments = Eigen::Matrix<double, 6, 1>;
DiscMoments disc_moments(const Eigen::Matrix2Xd& corners_m, double radius_m);

}  // namespace palpa::mechanics
