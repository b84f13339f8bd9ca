#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "stiffnessmaps/import/finish.h"
#include "stiffnessmaps/import/gridding.h"
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
        CHECK(std::abs(static_cast<double>(out.normal_N[i]) - wanted) < 4e-3);
        CHECK(plan.x.at(cell % 21) > -1e-3);
        CHECK(plan.x.at(cell % 21) < 21e-3);
    }
    CHECK(measured > 100);
    // no sample is deeper than 3 mm: the layer at 4 mm stays empty
    for (std::size_t cell = 0; cell < plan.n_cells(); ++cell)
        CHECK(std::isnan(out.normal_N[2 * plan.n_cells() + cell]));
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
