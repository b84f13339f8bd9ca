#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "stiffnessmaps/grid.h"
#include "stiffnessmaps/import/finish.h"
#include "stiffnessmaps/import/gridding.h"
#include "stiffnessmaps/import/local_plane.h"
#include "stiffnessmaps/import/robust.h"
#include "tests/close_to.h"
#include "tests/stiffnessmaps/test_maps.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

TEST_CASE("gridding: an axis is found with gaps in it, with jitter, and with a stray place beside it") {
    std::vector<double> places;
    for (const int i : {0, 1, 2, 5, 6, 7, 8, 20, 1, 2, 3}) places.push_back(0.3 + 1.5e-3 * i + (i % 2) * 2e-5);
    auto fit = fit_axis(places);
    REQUIRE(fit.has_value());
    CHECK(fit->off == 0);
    CHECK(fit->axis.n == 21);
    CHECK(fit->axis.pitch_m == close_to(1.5e-3).epsilon(0.01));
    places.push_back(0.3 + 1.5e-3 * 4.4);
    fit = fit_axis(places);
    REQUIRE(fit.has_value());
    CHECK(fit->off == 1);
    CHECK(fit->axis.n == 21);
    CHECK_FALSE(index_on(fit->axis, places.back()).has_value());
    CHECK(index_on(fit->axis, 0.3 + 1.5e-3 * 5) == 5u);
    CHECK_FALSE(index_on(fit->axis, 0.3 - 1.5e-3).has_value());
    CHECK(fit_axis({1.0, 1.0})->axis.n == 1);
    CHECK_FALSE(fit_axis({0.0, 1e-3, 2e-3, 1e3}).has_value());
}

TEST_CASE("gridding: measured places that scatter about a grid by a few hundredths of its pitch lie on it") {
    MESSAGE("seed 5");
    std::mt19937_64 random(5);
    std::uniform_real_distribution<double> off_m(-5e-5, 5e-5);
    std::vector<double> places;
    for (int i = 0; i < 300; ++i) places.push_back(2e-3 * (i % 20) + off_m(random));
    const auto fit = fit_axis(places, 4e-4);
    REQUIRE(fit.has_value());
    CHECK(fit->off == 0);
    CHECK(fit->axis.n == 20);
    CHECK(fit->axis.pitch_m == close_to(2e-3).epsilon(1e-3));
    CHECK_FALSE(fit_axis({0.0, 3e-4, 6e-4, 9e-4}, 4e-4).has_value());  // one group, as scattered places make
}

TEST_CASE("gridding: groups of places") {
    std::vector<double> x;
    std::vector<double> y;
    for (int i = 0; i < 50; ++i) {
        x.push_back(1e-3 * (i % 10));
        y.push_back(1e-3 * (i / 10));
    }
    CHECK(neighbour_distance_m(x, y) == close_to(1e-3));
    CHECK(group_count(x, y, 3e-3) == 1);
    x.push_back(1.0);  // one stray place is no grid
    y.push_back(0.0);
    CHECK(group_count(x, y, 3e-3) == 1);
    for (int i = 0; i < 10; ++i) {
        x.push_back(0.1 + 1e-3 * i);
        y.push_back(0.0);
    }
    CHECK(group_count(x, y, 3e-3) == 2);
}

TEST_CASE("gridding: a linear field comes back exactly, and nothing is extrapolated") {
    const unsigned seed = 11;
    MESSAGE("seed ", seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> at(0.0, 1.0);
    Samples samples;
    for (int i = 0; i < 5000; ++i) {
        samples.x_m.push_back(20e-3 * at(random));
        samples.y_m.push_back(10e-3 * at(random));
        samples.depth_m.push_back(3e-3 * at(random));
        samples.force_N.push_back(0.2 + 10.0 * samples.x_m.back() - 20.0 * samples.y_m.back() +
                                  400.0 * samples.depth_m.back());
    }
    GridPlan plan;
    plan.x = {-10e-3, 2e-3, 21};
    plan.y = {0.0, 2e-3, 6};
    plan.depths_m = {1e-3, 2e-3, 4e-3};
    plan.radius_m = 2e-3;
    plan.least = 3;
    const Gridded out = grid_samples(samples, plan);
    std::size_t measured = 0;
    for (std::size_t i = 0; i < out.normal_N.size(); ++i) {
        if (std::isnan(out.normal_N[i])) continue;
        ++measured;
        const std::size_t cell = i % plan.n_cells();
        const double wanted =
            0.2 + 10.0 * plan.x.at(cell % 21) - 20.0 * plan.y.at(cell / 21) + 400.0 * plan.depths_m[i / plan.n_cells()];
        CHECK(std::abs(static_cast<double>(out.normal_N[i]) - wanted) < 1e-6);
        CHECK(plan.x.at(cell % 21) > -1e-3);
        CHECK(plan.x.at(cell % 21) < 21e-3);
    }
    CHECK(measured > 100);
    // no sample is deeper than 3 mm: the layer at 4 mm stays empty
    for (std::size_t cell = 0; cell < plan.n_cells(); ++cell)
        CHECK(std::isnan(out.normal_N[2 * plan.n_cells() + cell]));
}

namespace {

// Lines along x, 1 mm apart, there and back, on which depth rises and falls: place and depth go together along each.
// Force rises by 0.4 N/mm, the tangential force (only on the way there) by 0.12 N/mm.
Samples sliding_samples(double noise_N, unsigned seed) {
    std::mt19937 random(seed);
    std::normal_distribution<double> noise(0.0, 1.0);
    Samples samples;
    double t_s = 0.0;
    for (int line = 0; line <= 30; ++line) {
        for (int i = 0; i <= 500; ++i) {
            t_s += 0.005;
            const double depth_m = 1.55e-3 - 1.5e-3 * std::cos(2.0 * 3.14159265 * t_s);
            samples.x_m.push_back(1e-4 * (line % 2 == 0 ? i : 500 - i));
            samples.y_m.push_back(1e-3 * line);
            samples.depth_m.push_back(depth_m);
            samples.force_N.push_back(400.0 * depth_m + noise_N * noise(random));
            const double back_N = 120.0 * depth_m + noise_N * noise(random);
            samples.tangential_x_N.push_back(static_cast<float>(line % 2 == 0 ? back_N : kMissing));
        }
    }
    return samples;
}

struct WorstOff {
    double normal_N = 0.0;
    double tangential_N = 0.0;
    std::size_t n_normal = 0;
    std::size_t n_tangential = 0;
};

WorstOff worst_off(double noise_N, int layers, unsigned seed) {
    GridPlan plan;
    plan.x = {0.0, 2e-3, 26};
    plan.y = {0.0, 2e-3, 16};
    for (int k = 1; k <= layers; ++k) plan.depths_m.push_back(2.977e-3 * k / layers);
    plan.radius_m = 2e-3;
    plan.least = 3;
    const Gridded out = grid_samples(sliding_samples(noise_N, seed), plan);
    WorstOff worst;
    for (std::size_t i = 0; i < out.normal_N.size(); ++i) {
        const double depth_m = plan.depths_m[i / plan.n_cells()];
        const double normal_N = std::abs(static_cast<double>(out.normal_N[i]) - 400.0 * depth_m);
        const double tangential_N = std::abs(static_cast<double>(out.tangential_x_N[i]) - 120.0 * depth_m);
        worst.n_normal += !std::isnan(normal_N);
        worst.n_tangential += !std::isnan(tangential_N);
        worst.normal_N = std::fmax(worst.normal_N, normal_N);
        worst.tangential_N = std::fmax(worst.tangential_N, tangential_N);
    }
    return worst;
}

}  // namespace

TEST_CASE("gridding: a force linear in depth comes back exactly from lines on which depth and place go together") {
    for (const int layers : {3, 8}) {
        CAPTURE(layers);
        const WorstOff worst = worst_off(0.0, layers, 1);
        CHECK(worst.n_normal > 500);
        CHECK(worst.n_tangential > 250);
        CHECK(worst.normal_N < 1e-6);               // a float of 1 N
        CHECK(worst.tangential_N < 1e-5);           // of forces that are floats
        for (const unsigned seed : {1u, 2u, 3u}) {  // and no slope that only noise made is followed
            const double noise_N = 0.02;
            const WorstOff noisy = worst_off(noise_N, layers, seed);
            CHECK(noisy.normal_N < 2.0 * noise_N);
            CHECK(noisy.tangential_N < 2.0 * noise_N);
        }
    }
}

TEST_CASE(
    "gridding: what samples do not tell of a plane is no slope over the place, and force in proportion to depth") {
    PlaneSums sums;
    for (int i = 0; i < 12; ++i) sums.add(1.0, 0.1 * (i % 4), 0.2, 0.3, 2.6);  // all at one depth, one and a half radii
    CHECK(plane_value(sums, 1.0) == close_to(2.0));
    CHECK_FALSE(one_sided(sums));
    CHECK(one_sided(PlaneSums{}));
    PlaneSums deeper;
    for (int i = 0; i < 12; ++i) deeper.add(1.0, 0.1 * (i % 4), 0.2, 0.6, 2.6);
    CHECK(one_sided(deeper));
    PlaneSums beside;  // off along both axes, by more than half the radius together
    for (int i = 0; i < 12; ++i) beside.add(1.0, 0.4, 0.4, 0.0, 2.6);
    CHECK(one_sided(beside));
    // five samples in general position tell a plane that is not in proportion to depth
    PlaneSums five;
    const double at[5][3] = {{0.5, 0, 0.2}, {-0.4, 0.3, -0.1}, {0, -0.5, 0.3}, {0.1, 0.4, 0.4}, {-0.3, -0.2, -0.4}};
    for (const auto& p : at) five.add(0.7, p[0], p[1], p[2], 1.0 + 0.3 * p[0] - 0.2 * p[1] + 5.0 * p[2]);
    CHECK(plane_value(five, 2.0) == close_to(1.0));
}

TEST_CASE("gridding: the filled copy has no gap, keeps what was measured, and goes on as its neighbours do") {
    Map map = map_of(5, 4, {1e-3, 2e-3, 3e-3}, [](double x, double, double d) { return 500.0 * d * (1.0 + 20.0 * x); });
    const std::vector<float> whole = map.normal_N;
    const float nan = std::numeric_limits<float>::quiet_NaN();
    map.normal_N[20 + 7] = nan;                                            // between two depths of one cell
    map.normal_N[40 + 12] = nan;                                           // its deepest
    for (const std::size_t k : {0u, 20u, 40u}) map.normal_N[k + 2] = nan;  // a whole cell
    const std::vector<float> filled = filled_forces(map);
    for (std::size_t i = 0; i < filled.size(); ++i) {
        CAPTURE(i);
        CHECK(filled[i] == close_to(whole[i]).epsilon(0.03));
        if (!std::isnan(map.normal_N[i])) CHECK(filled[i] == map.normal_N[i]);
    }
}

TEST_CASE("finish: the residual of a map's own numbers is what look-up makes of them") {
    Map map = map_of(5, 4, {1e-3, 2e-3, 3e-3},
                     [](double x, double y, double d) { return 500.0 * d + 30.0 * x + std::sin(4e3 * y + 3e3 * d); });
    map.normal_N[27] = std::numeric_limits<float>::quiet_NaN();
    RecordedPoints recorded;
    for (std::size_t i = 0; i < map.normal_N.size(); ++i) {
        if (std::isnan(map.normal_N[i])) continue;
        const std::size_t cell = i % map.n_cells();
        recorded.add(map.x_of(cell % map.n_x), map.y_of(cell / map.n_x), map.depths_m[i / map.n_cells()],
                     static_cast<double>(map.normal_N[i]));
    }
    const ImportResidual numbers = residual_of_numbers(map);
    const ImportResidual sampled = residual_of(map, recorded);
    CHECK(numbers.n == 59);
    CHECK(numbers.n == sampled.n);
    CHECK(numbers.worst_N > 0.1);
    CHECK(numbers.worst_N == close_to(sampled.worst_N).epsilon(1e-4));
    CHECK(numbers.median_N == close_to(sampled.median_N).epsilon(1e-4));
}

TEST_CASE("robust: medians and deviations that wild values do not move") {
    CHECK(median({3.0, 1.0, 2.0}) == 2.0);
    CHECK(median({}) == 0.0);
    CHECK(median({NAN, 3.0, INFINITY, 1.0, 2.0, -INFINITY}) == 2.0);
    CHECK(quantile({5.0, 1.0, 2.0, 3.0, 4.0}, 1.0) == 5.0);
    std::mt19937 random(5);
    std::normal_distribution<double> normal(2.0, 0.3);
    std::vector<double> values;
    for (int i = 0; i < 5000; ++i) values.push_back(i % 20 == 0 ? 1e6 : normal(random));
    CHECK(robust_deviation(values) == close_to(0.3).epsilon(0.1));
    // a spike on a slope stands out; its neighbours, a kink and a step do not
    CHECK(lone_outliers({0, 0, 0, 1, 2, 9, 4, 5, 6, 6, 6, 0, 0}, 0.5) ==
          std::vector<bool>{false, false, false, false, false, true, false, false, false, false, false, false, false});
    std::vector<double> differences;
    std::vector<double> noisy;
    for (int i = 0; i < 5000; ++i) noisy.push_back(1e-6 * i * i + normal(random));
    add_fourth_differences(noisy, differences);
    CHECK(noise_of_fourth_differences(differences) == close_to(0.3).epsilon(0.05));
}
