#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/error.h"
#include "mechanics/surface_grid.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

TEST_CASE("surface grid: parabolas are interpolated exactly, ends and beyond included") {
    const Eigen::VectorXd at_m = (Eigen::VectorXd(7) << 0.0, 0.3, 0.5, 1.1, 1.2, 2.0, 2.7).finished();
    const GridAxis axis = grid_axis(at_m);
    const auto parabola = [](double x) { return 1.0 + x * (2.0 - 0.7 * x); };
    const unsigned seed = 1;
    CAPTURE(seed);
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> anywhere(-1.0, 4.0);
    for (int k = 0; k < 200; ++k) {
        const double x = anywhere(random);
        CAPTURE(x);
        const Stencil s = stencil_at(axis, x);
        double sum = 0.0;
        double weights = 0.0;
        for (int i = 0; i < s.count; ++i) {
            sum += s.weight[i] * parabola(at_m(s.first + i));
            weights += s.weight[i];
        }
        CHECK(weights == close_to(1.0).epsilon(1e-12));
        CHECK(sum == close_to(parabola(std::clamp(x, 0.0, 2.7))).epsilon(1e-9));
    }
    CHECK(cell_of(axis, -5.0) == 0);
    CHECK(cell_of(axis, 0.3) == 1);
    CHECK(cell_of(axis, 9.0) == 5);
}

TEST_CASE("surface grid: two and three coordinates") {
    for (const Eigen::Index n : {2, 3}) {
        const GridAxis axis = grid_axis(Eigen::VectorXd::LinSpaced(n, 0.0, 1.0));
        const Stencil s = stencil_at(axis, 0.25);
        double sum = 0.0;
        for (int i = 0; i < s.count; ++i) sum += s.weight[i] * axis.at_m(s.first + i);
        CHECK(s.count == n);
        CHECK(sum == close_to(0.25));
    }
}

TEST_CASE("surface grid: the slope has no jump at the coordinates") {
    const Eigen::VectorXd at_m = (Eigen::VectorXd(6) << 0.0, 0.4, 0.5, 1.3, 1.9, 2.2).finished();
    const Eigen::VectorXd value = (Eigen::VectorXd(6) << 1.0, -0.3, 2.0, 0.7, 0.9, -1.0).finished();
    const GridAxis axis = grid_axis(at_m);
    const auto at = [&](double x) {
        const Stencil s = stencil_at(axis, x);
        double sum = 0.0;
        for (int i = 0; i < s.count; ++i) sum += s.weight[i] * value(s.first + i);
        return sum;
    };
    constexpr double kStep = 1e-6;
    for (Eigen::Index i = 1; i < 5; ++i) {
        CHECK(at(at_m(i)) == close_to(value(i)).epsilon(1e-12));
        const double before = (at(at_m(i)) - at(at_m(i) - kStep)) / kStep;
        const double after = (at(at_m(i) + kStep) - at(at_m(i))) / kStep;
        CHECK(after == close_to(before).epsilon(1e-3));
    }
}

TEST_CASE("surface grid: what is left out far away is less than a thousandth") {
    const GridAxis axis = grid_axis(Eigen::VectorXd::LinSpaced(40, 0.0, 39.0));
    for (const double x : {17.3, 20.5, 1.2, 38.9}) {
        const Stencil s = stencil_at(axis, x);
        double sum = 0.0;
        for (int i = 0; i < s.count; ++i) sum += s.weight[i] * std::sin(0.5 * (s.first + i));
        CHECK(std::abs(sum - std::sin(0.5 * x)) < 2.5e-3);
        CHECK(s.count <= 2 * kSplineReach + 2);
    }
}
