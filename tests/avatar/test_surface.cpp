#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <vector>

#include "avatar/surface.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::avatar;
using namespace palpa::test;

namespace {

// Hertz: parabolic indenter, surface outside the contact in closed form (Johnson, Contact Mechanics, eq. 3.42a).
double hertz_sink_m(double r, double depth, double a) {
    const double s = r / a;
    if (s <= 1.0) return depth - depth * s * s / 2.0;
    return depth / std::numbers::pi * ((2.0 - s * s) * std::asin(1.0 / s) + std::sqrt(s * s - 1.0));
}

// Surface of an incompressible layer bonded to its base under Hertz's pressure, by its Hankel integral
// (kernel W of the bonded layer, kappa = 3 - 4 nu = 1). Scaled to 1 under the axis.
double layer_sink(double r, double a, double thickness) {
    const auto integrate = [&](double at) {
        double sum = 0.0;
        const double dk = 2.0;  // 1/m; the integrand's shortest wave is 2 pi / (60 mm + a), 50 times longer
        for (double k = 0.5 * dk; k < 100.0 / a; k += dk) {
            const double x = k * thickness;
            const double e2 = std::exp(-2.0 * x);
            const double w =
                x > 40.0 ? 1.0 : ((1.0 - e2 * e2) - 4.0 * x * e2) / ((1.0 + e2 * e2) + (4.0 * x * x + 2.0) * e2);
            const double ka = k * a;
            const double pressure = (std::sin(ka) - ka * std::cos(ka)) / (ka * ka * ka);
            sum += pressure * ::j0(k * at) * w * dk;
        }
        return sum;
    };
    static double at_zero_for = 0.0;
    static double at_zero = 0.0;
    if (at_zero_for != a) at_zero = integrate(0.0);
    at_zero_for = a;
    return integrate(r) / at_zero;
}

}  // namespace

TEST_CASE("surface: contact radius inverts the depth of a sphere") {
    for (const double depth : {1e-5, 1e-3, 4e-3, 7e-3, 0.02}) {
        const double a = sphere_contact_radius_m(depth, 4e-3);
        CHECK(a < 4e-3);
        CHECK(0.5 * a * std::log((4e-3 + a) / (4e-3 - a)) == close_to(depth).epsilon(1e-9));
    }
    CHECK(sphere_contact_radius_m(0.0, 4e-3) == 0.0);
    CHECK(sphere_contact_radius_m(1e-6, 4e-3) == close_to(std::sqrt(4e-9)).epsilon(1e-3));  // Hertz
}

TEST_CASE("surface: a shallow dent is Hertz's, inside and outside the contact") {
    const double R = 4e-3;
    const double depth = 4e-6;
    const double a = sphere_contact_radius_m(depth, R);
    for (const double s : {0.0, 0.3, 0.99, 1.01, 1.5, 3.0, 10.0}) {
        CAPTURE(s);
        CHECK(half_space_sink_m(s * a, depth, a, R) == close_to(hertz_sink_m(s * a, depth, a)).epsilon(2e-3));
    }
}

TEST_CASE("surface: continuous at the contact's edge, falling, zero beyond its reach") {
    for (const double depth : {0.5e-3, 2e-3, 4e-3, 7e-3}) {
        const SurfaceCurve curve = surface_curve(depth, 4e-3, 25e-3);
        CAPTURE(depth);
        const double a = curve.contact_radius_m;
        CHECK(half_space_sink_m(a * (1 + 1e-9), depth, a, 4e-3) ==
              close_to(half_space_sink_m(a * (1 - 1e-9), depth, a, 4e-3)).epsilon(1e-2));
        CHECK(sink_at_m(curve, 0.0) == depth);
        for (double r = 0.0; r < curve.reach_m; r += 1e-4) CHECK(sink_at_m(curve, r + 1e-4) <= sink_at_m(curve, r));
        CHECK(sink_at_m(curve, curve.reach_m) == 0.0);
        CHECK(sink_at_m(curve, 1.0) == 0.0);
        CHECK(sink_at_m(curve, std::nan("")) == 0.0);
    }
    const SurfaceCurve none = surface_curve(0.0, 4e-3, 25e-3);
    for (const double u : none.sink_m) CHECK(u == 0.0);
    CHECK(surface_curve(0.1, 4e-3, 25e-3).sink_m[0] == 25e-3);  // bounded by the layer
}

TEST_CASE("surface: within 7.5 % of the depth of the exact bonded layer") {
    // phantom: 25 mm thick, sphere of 4 mm; Hertz's pressure, so shallow depths only
    double worst = 0.0;
    for (const double depth : {0.5e-3, 1e-3, 2e-3}) {
        const SurfaceCurve curve = surface_curve(depth, 4e-3, 25e-3);
        for (double r = 0.0; r < 60e-3; r += 3e-3) {
            const double exact = layer_sink(r, curve.contact_radius_m, 25e-3);
            worst = std::max(worst, std::abs(sink_at_m(curve, r) / depth - exact));
        }
    }
    MESSAGE("worst difference, share of the depth: ", worst);
    CHECK(worst < 0.075);
}
