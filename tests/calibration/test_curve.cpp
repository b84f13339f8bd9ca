#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <vector>

#include "calibration/curve.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::calibration;
using namespace palpa::test;

namespace {

Curve parametric(CurveModel model, double a_N, double b, double offset_N = 0.0) {
    Curve curve;
    curve.model = model;
    curve.a_N = a_N;
    curve.b = b;
    curve.offset_N = offset_N;
    return curve;
}

// A cubic through seeded random knots, from even to very uneven.
Curve random_cubic(std::mt19937_64& random) {
    std::uniform_real_distribution<double> step(0.01, 1.0);
    const int n = 2 + static_cast<int>(random() % 12);
    std::vector<double> level{0.01 * step(random)};
    std::vector<double> force_N{0.05 * step(random)};
    for (int i = 1; i < n; ++i) {
        level.push_back(level.back() + step(random));
        force_N.push_back(force_N.back() + std::pow(step(random), 3.0));
    }
    return monotone_cubic(level, force_N);
}

std::vector<Curve> curves() {
    std::vector<Curve> all{parametric(CurveModel::exponential, 0.1008, 4.2081),
                           parametric(CurveModel::exponential_offset, 0.1, 3.0, 0.05),
                           parametric(CurveModel::exponential_offset, -2.0, -3.0, 2.1),
                           parametric(CurveModel::power, 3.0, 1.7), parametric(CurveModel::power, 3.0, 0.6)};
    std::mt19937_64 random(5);
    for (int i = 0; i < 40; ++i) all.push_back(random_cubic(random));
    return all;
}

}  // namespace

TEST_CASE("curve: slope is the derivative of the value") {
    for (const Curve& curve : curves()) {
        CAPTURE(name_of(curve.model));
        for (double x = 0.0137; x < 2.0; x += 0.0331) {
            constexpr double h = 1e-6;  // truncation h^2, round-off 1e-16/h: 1e-9 of the value
            const double difference = (value_N(curve, x + h) - value_N(curve, x - h)) / (2.0 * h);
            const double tolerance = 1e-6 * (std::abs(difference) + value_N(curve, x)) + 2e-4 * std::abs(difference);
            CAPTURE(x);
            CHECK(std::abs(slope_N_per_level(curve, x) - difference) < tolerance);
        }
    }
}

TEST_CASE("hard case 4: the inverse of every model gives the level back to 1e-12") {
    for (const Curve& curve : curves()) {
        CAPTURE(name_of(curve.model));
        const double end = curve.knot_level.empty() ? 1.0 : 1.2 * curve.knot_level.back();
        for (int i = 1; i <= 500; ++i) {
            const double x = end * i / 500.0;
            const double F = value_N(curve, x);
            CAPTURE(x);
            CHECK(F > 0.0);
            // a force is known to 2e-16 of itself, which the slope turns into a level
            const double conditioning = 4e-16 * F / slope_N_per_level(curve, x);
            CHECK(std::abs(level_at(curve, F) - x) < 1e-12 + conditioning);
        }
    }
}

TEST_CASE("curve: a cubic goes through its knots, rises between them and goes on beyond them") {
    std::mt19937_64 random(11);
    for (int trial = 0; trial < 100; ++trial) {
        const Curve curve = random_cubic(random);
        CAPTURE(trial);
        for (std::size_t i = 0; i < curve.knot_level.size(); ++i) {
            CHECK(value_N(curve, curve.knot_level[i]) == close_to(curve.knot_N[i]).epsilon(1e-14));
        }
        const double end = curve.knot_level.back() + 0.5;
        double before = value_N(curve, 0.0);
        CHECK(before > 0.0);
        for (int i = 1; i <= 2000; ++i) {
            const double F = value_N(curve, end * i / 2000.0);
            CHECK(F > before);
            before = F;
        }
        for (const double x : {curve.knot_level.front(), curve.knot_level.back()}) {
            CHECK(value_N(curve, x + 1e-9) - value_N(curve, x - 1e-9) < 1e-6);
        }
    }
}

TEST_CASE("curve: forces that a model never reaches give the nearest end") {
    const double inf = INFINITY;
    CHECK(level_at(parametric(CurveModel::exponential, 0.1, 4.0), 0.0) == -inf);
    CHECK(level_at(parametric(CurveModel::exponential_offset, 0.1, 3.0, 0.5), 0.4) == -inf);
    CHECK(level_at(parametric(CurveModel::exponential_offset, -2.0, -3.0, 2.1), 2.2) == inf);
    CHECK(level_at(parametric(CurveModel::power, 3.0, 2.0), -1.0) == 0.0);
    CHECK(level_at(monotone_cubic({0.1, 1.0}, {0.1, 2.0}), 0.0) == -inf);
}
