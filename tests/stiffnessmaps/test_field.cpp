#include <doctest/doctest.h>
#include <limits>
#include <random>

#include "stiffnessmaps/field.h"
#include "tests/close_to.h"
#include "tests/stiffnessmaps/test_maps.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

const float kNaN = std::numeric_limits<float>::quiet_NaN();

double rising(double x, double y, double d) { return 100.0 * d * (1.0 + 20.0 * x + 5.0 * y) + 3e4 * d * d; }

double depth_of(const Field& field, double x, double y, double force) {
    return depth_at(field, place_at(field, {x, y}), force).depth_m;
}

}  // namespace

TEST_CASE("hard case 5: a noisy map has one depth for each force, rising, round trip 1e-12") {
    constexpr std::uint32_t kSeed = 11;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::normal_distribution<double> noise(0.0, 0.3);
    const Map map =
        map_of(6, 5, kPaperDepths_m, [&](double x, double y, double d) { return rising(x, y, d) + noise(random); });
    const Map raw = map;
    const Field field = make_field(map, {});
    CHECK(field.isotonic_changed > 20);
    CHECK(map.normal_N == raw.normal_N);  // raw values are kept
    std::uniform_real_distribution<double> x(0.0, 5e-3);
    std::uniform_real_distribution<double> y(0.0, 4e-3);
    for (int i = 0; i < 2000; ++i) {
        const Place place = place_at(field, {x(random), y(random)});
        double before_m = 0.0;
        for (double force = 0.0; force < 4.0; force += 0.01) {
            const DepthAnswer answer = depth_at(field, place, force);
            REQUIRE(answer.depth_m >= before_m);
            before_m = answer.depth_m;
            if (answer.saturated) break;
            REQUIRE(std::abs(normal_force_N(field, place, answer.depth_m) - force) < 1e-12);
        }
    }
}

TEST_CASE("hard case 6: below the first and beyond the last depth, outside the grid, continuous everywhere") {
    const Field field = make_field(map_of(6, 5, kPaperDepths_m, rising), {});
    const Place place = place_at(field, {2.2e-3, 1.7e-3});
    CHECK(depth_at(field, place, 0.0).depth_m == 0.0);
    CHECK(depth_at(field, place, -1.0).depth_m == 0.0);
    CHECK(depth_at(field, place, std::nan("")).depth_m == 0.0);
    const double at_2_mm = normal_force_N(field, place, 2e-3);
    CHECK(depth_at(field, place, 0.5 * at_2_mm).depth_m == close_to(1e-3));  // anchored at (0, 0)
    CHECK(depth_at(field, place, at_2_mm * (1 + 1e-9)).depth_m ==
          close_to(depth_at(field, place, at_2_mm * (1 - 1e-9)).depth_m).epsilon(1e-8));
    const DepthAnswer deep = depth_at(field, place, 1e6);
    CHECK(deep.saturated);
    CHECK(deep.depth_m == 7e-3);
    CHECK_FALSE(depth_at(field, place, normal_force_N(field, place, 6.99e-3)).saturated);

    const Place outside = place_at(field, {-1.0, 99.0});
    CHECK_FALSE(outside.inside);
    CHECK(normal_force_N(field, outside, 3e-3) == normal_force_N(field, place_at(field, {0.0, 4e-3}), 3e-3));
    for (double x = -1e-3; x < 6.5e-3; x += 1e-5) {
        CHECK(std::abs(depth_of(field, x, 2e-3, 0.5) - depth_of(field, x + 1e-5, 2e-3, 0.5)) < 2e-5);
    }
    CHECK(place_at(field, {std::nan(""), 0.0}).inside == false);
}

TEST_CASE("hard case 6: cells that were not measured, cells with another greatest depth, a single cell") {
    Map map = map_of(6, 5, kPaperDepths_m, rising);
    const std::size_t cell = 2 * 6 + 3;
    for (std::size_t k = 0; k < map.n_depths(); ++k) map.normal_N[k * map.n_cells() + cell] = kNaN;
    const std::size_t shallow = 1 * 6 + 1;  // stops at 4 mm
    for (std::size_t k = 3; k < map.n_depths(); ++k) map.normal_N[k * map.n_cells() + shallow] = kNaN;
    const Field field = make_field(map, {});

    const Place hole = place_at(field, {3e-3, 2e-3});
    CHECK_FALSE(hole.measured);
    CHECK(std::isfinite(normal_force_N(field, hole, 3e-3)));  // from its neighbours, so that motion stays smooth
    CHECK(normal_force_N(field, hole, 3e-3) == close_to(rising(3e-3, 2e-3, 3e-3)).epsilon(0.05));
    CHECK(place_at(field, {3.6e-3, 2e-3}).measured);

    const Place stops = place_at(field, {1e-3, 1e-3});
    CHECK(stops.measured);
    const DepthAnswer answer = depth_at(field, stops, 1e3);
    CHECK(answer.saturated);
    CHECK(answer.depth_m == close_to(4e-3));
    CHECK(depth_at(field, place_at(field, {1.5e-3, 1e-3}), 1e3).depth_m == close_to(5.5e-3));

    const Field single = make_field(map_of(1, 1, kPaperDepths_m, rising), {});
    CHECK(depth_of(single, 0.0, 0.0, rising(0, 0, 4e-3)) == close_to(4e-3).epsilon(1e-6));
    CHECK(tangential_force_N(single, place_at(single, {0.0, 0.0}), {1.0, 0.0}, 4e-3) == 0.0);
}

TEST_CASE("field: the tangential force is the slope of the energy, uphill only") {
    const Field field = make_field(map_of(40, 30, kPaperDepths_m, rising), {});
    const auto energy_J = [&](const Eigen::Vector2d& p, double depth) {
        const Place place = place_at(field, p);
        double sum = 0.0;  // trapezoid over the piecewise linear force
        const int n = 7000;
        for (int i = 0; i < n; ++i) {
            sum +=
                0.5 * (normal_force_N(field, place, depth * i / n) + normal_force_N(field, place, depth * (i + 1) / n));
        }
        return sum * depth / n;
    };
    for (const double depth : {1e-3, 3.3e-3, 7e-3}) {
        const Eigen::Vector2d p(17.3e-3, 11.6e-3);
        const Eigen::Vector2d g = energy_gradient_N(field, place_at(field, p), depth);
        const double h = 1e-4;
        const double along_x =
            (energy_J(p + Eigen::Vector2d(h, 0), depth) - energy_J(p - Eigen::Vector2d(h, 0), depth)) / (2 * h);
        const double along_y =
            (energy_J(p + Eigen::Vector2d(0, h), depth) - energy_J(p - Eigen::Vector2d(0, h), depth)) / (2 * h);
        CHECK(g.x() == close_to(along_x).epsilon(1e-4));
        CHECK(g.y() == close_to(along_y).epsilon(1e-4));
        const Place place = place_at(field, p);
        CHECK(tangential_force_N(field, place, {1, 0}, depth) == g.x());
        CHECK(tangential_force_N(field, place, {-1, 0}, depth) == 0.0);
        const Eigen::Vector2d u(0.6, 0.8);
        CHECK(tangential_force_N(field, place, u, depth) == close_to(u.dot(g)));
    }
}

TEST_CASE("field: a recorded tangential force is given back for +x uphill, its even part in every direction") {
    Map map = map_of(40, 30, kPaperDepths_m, rising);
    const Field energy = make_field(map, {});
    constexpr double kRolling_N = 0.05;
    for (std::size_t k = 0; k < map.n_depths(); ++k) {
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            map.tangential_x_N.push_back(
                static_cast<float>(energy.slopes[cell * energy.n_layers() + k + 1].energy_x + kRolling_N));
        }
    }
    map.tangential = TangentialKind::recorded;
    const Field field = make_field(map, {});
    const Place place = place_at(field, {12.2e-3, 9.1e-3});
    const double g = energy_gradient_N(field, place, 5e-3).x();
    CHECK(tangential_force_N(field, place, {1, 0}, 5e-3) == close_to(g + kRolling_N).epsilon(1e-5));
    CHECK(tangential_force_N(field, place, {-1, 0}, 5e-3) == close_to(kRolling_N).epsilon(1e-5));
    const TangentialAgreement agreement = tangential_agreement(map, field);
    CHECK(agreement.correlation > 0.99);
    CHECK(agreement.slope == close_to(1.0).epsilon(1e-3));

    FieldOptions as_recorded;
    as_recorded.force = TangentialForce::recorded;
    const Field replica = make_field(map, as_recorded);
    CHECK(tangential_force_N(replica, place, {1, 0}, 5e-3) == close_to(g + kRolling_N).epsilon(1e-5));
    CHECK(tangential_force_N(replica, place, {-1, 0}, 5e-3) == close_to(-g - kRolling_N).epsilon(1e-5));
}
