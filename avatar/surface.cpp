#include "avatar/surface.h"

#include <algorithm>
#include <cmath>
#include <numbers>

namespace palpa::avatar {
namespace {

// (t/2) ln((R + t)/(R - t)): the depth at which the contact radius is t.
double punch_term(double t_m, double radius_m) { return 0.5 * t_m * std::log((radius_m + t_m) / (radius_m - t_m)); }

}  // namespace

double sphere_contact_radius_m(double depth_m, double radius_m) {
    if (depth_m <= 0.0) return 0.0;
    // depth(a) is convex and rises from 0 to infinity on (0, R): bisection on a/R needs no derivative
    double low = 0.0;
    double high = 1.0;
    for (int i = 0; i < 60; ++i) {
        const double mid = 0.5 * (low + high);
        if (mid < 1.0 && punch_term(mid, 1.0) * radius_m < depth_m) {
            low = mid;
        } else {
            high = mid;
        }
    }
    return low * radius_m;
}

double half_space_sink_m(double r_m, double depth_m, double contact_radius_m, double radius_m) {
    const double a = contact_radius_m;
    if (r_m <= a) return depth_m - (radius_m - std::sqrt(radius_m * radius_m - r_m * r_m));
    // t = r sin(theta) removes the singularity at t = r; Gauss-Legendre with 8 points on (0, asin(a/r))
    static constexpr std::array<double, 4> kNode{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                                 0.9602898564975363};
    static constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                                   0.1012285362903763};
    const double half = 0.5 * std::asin(a / r_m);
    double sum = 0.0;
    for (std::size_t i = 0; i < kNode.size(); ++i) {
        for (const double x : {kNode[i], -kNode[i]}) {
            const double t = std::min(r_m * std::sin(half * (1.0 + x)), a);
            sum += kWeight[i] * (depth_m - punch_term(t, radius_m));
        }
    }
    return 2.0 / std::numbers::pi * half * sum;
}

SurfaceCurve surface_curve(double depth_m, double radius_m, double thickness_m) {
    SurfaceCurve curve;
    const double depth = std::clamp(depth_m, 0.0, thickness_m);
    const double a = sphere_contact_radius_m(depth, radius_m);
    curve.contact_radius_m = a;
    curve.reach_m = a + kLayerReach * thickness_m;
    for (int i = 0; i + 1 < kSurfacePoints; ++i) {
        const double s = static_cast<double>(i) / (kSurfacePoints - 1);
        const double r = curve.reach_m * s * s;
        const double outside = std::clamp((r - a) / (curve.reach_m - a), 0.0, 1.0);
        const double taper = (1.0 - outside) * (1.0 - outside) * (1.0 + 2.0 * outside);
        curve.sink_m[static_cast<std::size_t>(i)] = taper * half_space_sink_m(r, depth, a, radius_m);
    }
    return curve;
}

double sink_at_m(const SurfaceCurve& curve, double r_m) {
    if (!(r_m < curve.reach_m)) return 0.0;
    const double i = std::sqrt(r_m / curve.reach_m) * (kSurfacePoints - 1);
    const auto below = static_cast<std::size_t>(i);
    const double s = i - static_cast<double>(below);
    const double next = below + 1 < kSurfacePoints ? curve.sink_m[below + 1] : 0.0;
    return (1.0 - s) * curve.sink_m[below] + s * next;
}

}  // namespace palpa::avatar
