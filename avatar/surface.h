#pragma once
// The tissue's surface around the indenter: how far it sinks, u, at a distance r from the indenter's axis.
//
// A frictionless rigid sphere of radius R is pressed by `depth` into an elastic half-space (Sneddon, Int. J. Eng. Sci.
// 3 (1965) 47; for depth << R this is Hertz's solution). With the contact radius a,
//     depth = (a/2) ln((R + a)/(R - a))
//     u(r) = depth - (R - sqrt(R^2 - r^2))                             r <= a
//     u(r) = (2/pi) integral_0^a g(t) / sqrt(r^2 - t^2) dt             r >  a
//     g(t) = depth - (t/2) ln((R + t)/(R - t))
// Far away the sink of a half-space falls only as 1/r, whereas that of a layer of thickness h, bonded to its base, ends
// after about 1.5 h. Outside the contact u is therefore multiplied by a smooth taper from 1 at r = a to 0 at
// r = a + kLayerReach h. tests/avatar/test_surface.cpp measures the difference from the exact layer. The result does
// not depend on the modulus. A depth below 0 is taken as 0, one beyond h as h.

#include <array>

namespace palpa::avatar {

inline constexpr int kSurfacePoints = 64;
// In thicknesses; between 1 and 2 the error changes by 0.2 % of the depth, 2026-11.
inline constexpr double kLayerReach = 1.5;

// sink_m[i] is u at r_i = reach_m * (i / (kSurfacePoints - 1))^2: finer near the axis, 0 at reach_m and beyond.
struct SurfaceCurve {
    double reach_m = 0.0;
    double contact_radius_m = 0.0;
    std::array<double, kSurfacePoints> sink_m{};
};

// Returns the contact radius a of a sphere of radius `radius_m`: 0 for a depth of 0 or less, below radius_m at any
// depth.
double sphere_contact_radius_m(double depth_m, double radius_m);

// Returns u(r) of the half-space, without the taper.
double half_space_sink_m(double r_m, double depth_m, double contact_radius_m, double radius_m);

// Returns the tapered curve of a layer of thickness `thickness_m` > 0.
SurfaceCurve surface_curve(double depth_m, double radius_m, double thickness_m);

// Returns the curve's sink at r_m, linear between its points.
double sink_at_m(const SurfaceCurve& curve, double r_m);

}  // namespace palpa::avatar
