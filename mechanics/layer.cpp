#include "mechanics/layer.h"

#include <algorithm>
#include <array>
#include <cmath>
#include <math.h>  // jn, j0: POSIX; std::cyl_bessel_j is missing from libc++
#include <numbers>

namespace palpa::mechanics {
namespace {

constexpr double kPi = std::numbers::pi;

double peak_pressure_Pa(const ParabolicPatch& patch) {
    return 2.0 * patch.force_N / (kPi * patch.radius_m * patch.radius_m);
}

// Gauss's hypergeometric series. Wherever it is used c - a - b = 2, so that it converges up to z = 1.
double hypergeometric(double a, double b, double c, double z) {
    double term = 1.0;
    double sum = 1.0;
    for (int n = 0; n < 2000000 && std::abs(term) > 1e-18 * std::abs(sum); ++n) {
        term *= (a + n) * (b + n) / ((c + n) * (1.0 + n)) * z;
        sum += term;
    }
    return sum;
}

// W(x) - 1, with all exponentials scaled by exp(-2x) so that they do not overflow.
double layer_factor_minus_1(double x, double poisson) {
    const double kap = 3.0 - 4.0 * poisson;
    const double e2 = std::exp(-2.0 * x);
    const double e4 = e2 * e2;
    const double top = kap * (1.0 - e4) - 4.0 * x * e2;
    const double bottom = kap * (1.0 + e4) + (4.0 * x * x + 1.0 + kap * kap) * e2;
    return (top - bottom) / bottom;
}

// J2(t)/t^2, which is 1/8 at 0.
double j2_over_square(double t) { return t < 1e-3 ? 0.125 - t * t / 96.0 : ::jn(2, t) / (t * t); }

// int_0^(40/h) f(k) dk by eight-point Gauss, on panels no longer than 1/(4 h) and than 1/longest_m.
template <class Function>
double integrate_wavenumbers(double thickness_m, double longest_m, Function&& f) {
    constexpr std::array<double, 4> kPoint{0.1834346424956498, 0.5255324099163290, 0.7966664774136267,
                                           0.9602898564975363};
    constexpr std::array<double, 4> kWeight{0.3626837833783620, 0.3137066458778873, 0.2223810344533745,
                                            0.1012285362903763};
    const double end = 40.0 / thickness_m;
    const double width = std::min(0.25 / thickness_m, 1.0 / longest_m);
    const auto n = static_cast<int>(std::ceil(end / width));
    const double half = 0.5 * end / n;
    double sum = 0.0;
    for (int i = 0; i < n; ++i) {
        const double middle = (2 * i + 1) * half;
        for (std::size_t k = 0; k < 4; ++k)
            sum += half * kWeight[k] * (f(middle - half * kPoint[k]) + f(middle + half * kPoint[k]));
    }
    return sum;
}

double compliance_factor(const Layer& layer) { return 2.0 / plane_strain_modulus_Pa(layer.young_Pa, layer.poisson); }

}  // namespace

double half_space_depression_m(const Layer& layer, const ParabolicPatch& patch, double r_m) {
    const double a = patch.radius_m;
    const double r = std::abs(r_m);
    const double integral = r <= a ? a / 3.0 * hypergeometric(0.5, -1.5, 1.0, r * r / (a * a))
                                   : a * a / (8.0 * r) * hypergeometric(0.5, 0.5, 3.0, a * a / (r * r));
    return compliance_factor(layer) * 2.0 * peak_pressure_Pa(patch) * integral;
}

double layer_depression_m(const Layer& layer, const ParabolicPatch& patch, double r_m) {
    const double a = patch.radius_m;
    const double integral = integrate_wavenumbers(layer.thickness_m, std::max(a, std::abs(r_m)), [&](double k) {
        return a * a * j2_over_square(k * a) * ::j0(k * r_m) *
               layer_factor_minus_1(k * layer.thickness_m, layer.poisson);
    });
    return half_space_depression_m(layer, patch, r_m) +
           compliance_factor(layer) * 2.0 * peak_pressure_Pa(patch) * integral;
}

double half_space_mean_depression_m(const Layer& layer, const ParabolicPatch& patch) {
    // int_0^inf J2(t)^2/t^4 dt = Gamma(4) Gamma(1/2) / (16 Gamma(5/2)^2 Gamma(9/2))
    const double integral =
        std::tgamma(4.0) * std::tgamma(0.5) / (16.0 * std::tgamma(2.5) * std::tgamma(2.5) * std::tgamma(4.5));
    const double P = peak_pressure_Pa(patch);
    return 2.0 * kPi / patch.force_N * compliance_factor(layer) * 4.0 * P * P * std::pow(patch.radius_m, 3) * integral;
}

double layer_mean_depression_m(const Layer& layer, const ParabolicPatch& patch) {
    const double a = patch.radius_m;
    const double P = peak_pressure_Pa(patch);
    const double integral = integrate_wavenumbers(layer.thickness_m, a, [&](double k) {
        const double pbar = 2.0 * P * a * a * j2_over_square(k * a);
        return pbar * pbar * layer_factor_minus_1(k * layer.thickness_m, layer.poisson);
    });
    return half_space_mean_depression_m(layer, patch) + 2.0 * kPi / patch.force_N * compliance_factor(layer) * integral;
}

double hertz_force_N(double plane_modulus_Pa, double radius_m, double depth_m) {
    return 4.0 / 3.0 * plane_modulus_Pa * std::sqrt(radius_m) * std::pow(depth_m, 1.5);
}

double hertz_contact_radius_m(double radius_m, double depth_m) { return std::sqrt(radius_m * depth_m); }

double dimitriadis_force_N(double young_Pa, double radius_m, double depth_m, double thickness_m) {
    const double x = std::sqrt(radius_m * depth_m) / thickness_m;
    const double series = 1.0 + x * (1.133 + x * (1.283 + x * (0.769 + x * 0.0975)));
    return hertz_force_N(plane_strain_modulus_Pa(young_Pa, 0.5), radius_m, depth_m) * series;
}

double punch_force_N(double plane_modulus_Pa, double punch_radius_m, double depth_m) {
    return 2.0 * plane_modulus_Pa * punch_radius_m * depth_m;
}

double boussinesq_depression_m(double plane_modulus_Pa, double force_N, double r_m) {
    return force_N / (kPi * plane_modulus_Pa * r_m);
}

}  // namespace palpa::mechanics
