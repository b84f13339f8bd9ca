#pragma once
// The tissue's surface around the indenter: how far it sinks at a distance r from the indenter's axis.
//
// Frictionless rigid sphere of radius R pressed by `depth` into an elastic half-space (Sneddon, Int. J. Eng.
// Sci. 3 (1965) 47; for depth << R it is Hertz's solution). With the contact radius a,
//     depth = (a/2) ln((R + a)/(R - a))
//     u(r) = depth - (R - sqrt(R^2 - r^2))                             r <= a
//     u(r) = (2/pi) integral_0^a g(t) / sqrt(r^2 - t^2) dt             r >  a
//     g(t) = depth - (t/2) ln((R + t)/(R - t))
// A half-space answers as 1/r for ever; a layer of thickness h that is bonded to its base stops after about
// one and a half. So outside the contact u is multiplied by a smooth taper from 1 at r = a to 0 at
// r = a + kReach h. How far that is from the exact layer: tests/avatar/test_surface.cpp.
// Independent of the modulus; 0 <= depth; depth beyond h is taken as h.

#include <array>

namespace palpa::avatar {

inline constexpr int kSurfacePoints = 64;
inline constexpr double kLayerReach =
    1.5;  // thicknesses; between 1 and 2 the error changes by 0.2 % of the depth, 2026-11

// u at r_i = reach_m * (i / (kSurfacePoints - 1))^2: finer near the axis, 0 at reach_m and beyond.
struct SurfaceCurve {
    double reach_m = 0.0;
    double contact_radius_m = 0.0;
    std::array<double, kSurfacePoints> sink_m{};
};

// Contact radius of a sphere of radius `radius_m` at `depth_m`; below radius_m at any depth.
double sphere_contact_radius_m(double depth_m, double radius_m);

// u(r) of the half-space.
double half_space_sink_m(double r_m, double depth_m, double contact_radius_m, double radius_m);

SurfaceCurve surface_curve(double depth_m, double radius_m, double thickness_m);

double sink_at_m(const SurfaceCurve& curve, double r_m);  // linear between the points

}  // namespace palpa::avatar
