#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/error.h"
#include "mechanics/surface_grid.h"

using namespace palpa::mechanics;

TEST_CASE("surface grid: cubics are interpolated exactly, ends and beyond included") {
    const Eigen::VectorXd at_m = (Eigen::VectorXd(7) << 0.0, 0.3, 0.5, 1.1, 1.2, 2.0, 2.7).finished();
    const GridAxis axis = grid_axis(at_m);
    const auto cubic = [](double x) { return 1.0 + x * (2.0 + x * (-0.7 + 0.3 * x)); };
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
            sum += s.weight[i] * cubic(at_m(s.first + i));
            weights += s.weight[i];
        }
        CHECK(weights == doctest::Approx(1.0).epsilon(1e-12));
        CHECK(sum == doctest::Approx(cubic(std::clamp(x, 0.0, 2.7))).epsilon(1e-11));
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
        CHECK(sum == doctest::Approx(0.25));
    }
}
