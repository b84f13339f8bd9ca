#include <doctest/doctest.h>

#include "mechanics/error.h"
#include "mechanics/rolling.h"
#include "mechanics/rolling_mesh.h"
#include "tests/close_to.h"
#include "tests/mechanics/rolling_block.h"

using namespace palpa::mechanics;
using namespace palpa::test;

TEST_CASE("rolling: coordinates pass through the ends of every zone and rise") {
    const Eigen::VectorXd x =
        zoned_coordinates_m(0.1, {{0.02, 0.03, 0.002}, {0.025, 0.05, 0.001}, {-1.0, 0.005, 0.003}}, 1.3, 0.02);
    for (const double end : {0.0, 0.005, 0.02, 0.025, 0.05, 0.1}) CHECK((x.array() - end).abs().minCoeff() < 1e-12);
    for (Eigen::Index i = 1; i < x.size(); ++i) {
        CHECK(x(i) > x(i - 1));
        if (x(i - 1) >= 0.0249 && x(i) <= 0.0501) CHECK(x(i) - x(i - 1) <= 0.001 + 1e-12);
    }
}

TEST_CASE("rolling: taken apart and put together is one mesh of the whole block, within 4 % of the greatest force") {
    Roller roller(rolling_block({ball(0.02, 0.025, 0.005)}));
    const double greatest_N = roller.at(0.02, 0.025).normal_N;
    for (const auto& place :
         {std::pair{0.02, 0.025}, {0.0245, 0.025}, {0.038, 0.02}, {0.048, 0.025}, {0.0, 0.025}, {0.049, 0.002}}) {
        const double x = place.first, y = place.second;
        CAPTURE(x);
        const auto one =
            press_on_one_mesh(roller.model, roller.mesh.contact_m, roller.mesh.cells_across, x, y, kDepths_m);
        for (std::size_t k = 0; k < 2; ++k) {
            const double apart_N = roller.at(x, y, k).normal_N;
            MESSAGE("taken apart ", apart_N, " N, one mesh ", one[k].normal_N, " N");
            CHECK(std::abs(apart_N - one[k].normal_N) < 0.04 * greatest_N);
        }
    }
}

TEST_CASE("rolling: stiffer over each ball in the order of size, force rises with depth") {
    Roller roller(rolling_block({ball(0.0125, 0.0125, 0.006), ball(0.0375, 0.0375, 0.004)}));
    const double plain_N = roller.at(0.0375, 0.0125).normal_N;
    const double small_N = roller.at(0.0375, 0.0375).normal_N;
    const double large_N = roller.at(0.0125, 0.0125).normal_N;
    CHECK(large_N > 1.05 * small_N);
    CHECK(small_N > 1.05 * plain_N);
    CHECK(roller.at(0.0125, 0.0125, 0).normal_N < large_N);
}

TEST_CASE("rolling: two balls pressed at mirrored places give mirrored answers") {
    Roller roller(rolling_block({ball(0.0125, 0.025, 0.005), ball(0.0375, 0.025, 0.005)}));
    for (const double x : {0.004, 0.0101, 0.0133, 0.02}) {
        const RollingForce left = roller.at(x, 0.021);
        const RollingForce right = roller.at(0.05 - x, 0.029);
        CHECK(right.normal_N == close_to(left.normal_N).epsilon(1e-8));
        CHECK(right.tangential_x_N == close_to(-left.tangential_x_N).epsilon(1e-6));
        CHECK(right.tangential_y_N == close_to(-left.tangential_y_N).epsilon(1e-6));
    }
}

TEST_CASE(
    "rolling: the tangential force of the pressure is the slope of the energy within 5 %; it rises on approach and "
    "falls behind") {
    Roller roller(rolling_block({ball(0.025, 0.025, 0.006)}),
                  3e-4);  // the sum over the rim of the contact needs small nodes
    const double h_m = 2e-4;
    const auto slope_N = [&](double x) {
        return (roller.at(x + h_m, 0.025).energy_J - roller.at(x - h_m, 0.025).energy_J) / (2.0 * h_m);
    };
    double greatest_N = 0.0;
    for (double x = 0.017; x < 0.025; x += 0.001) greatest_N = std::max(greatest_N, slope_N(x));
    for (double x = 0.017; x <= 0.0331; x += 0.001) {
        CAPTURE(x);
        CHECK(std::abs(roller.at(x, 0.025).tangential_x_N - slope_N(x)) < 0.05 * greatest_N);
    }
    CHECK(slope_N(0.021) > 0.5 * greatest_N);
    CHECK(slope_N(0.029) < -0.5 * greatest_N);
    CHECK(std::abs(slope_N(0.025)) < 0.02 * greatest_N);
}

TEST_CASE("rolling, hard case 21: no ripple where nodes pass under the tool") {
    Roller roller(rolling_block({}));
    std::vector<double> force_N;
    for (int i = 0; i <= 20; ++i) force_N.push_back(roller.at(0.022 + 0.1 * i * roller.mesh.contact_m, 0.025).normal_N);
    for (std::size_t i = 1; i + 1 < force_N.size(); ++i) {
        CHECK(std::abs(force_N[i - 1] - 2.0 * force_N[i] + force_N[i + 1]) < 2e-5 * force_N[i]);
    }
}

TEST_CASE("rolling: what cannot be computed is told with numbers") {
    CHECK_THROWS_WITH_AS(choose_rolling_mesh(rolling_block({ball(0.02, 0.025, 0.005), ball(0.023, 0.025, 0.005)})),
                         doctest::Contains("overlap"), LoadError);
    CHECK_THROWS_WITH_AS(choose_rolling_mesh(rolling_block({ball(0.001, 0.025, 0.005)})),
                         doctest::Contains("reaches out"), LoadError);
    RollingModel deep = rolling_block({});
    deep.greatest_depth_m = 0.013;
    CHECK_THROWS_WITH_AS(choose_rolling_mesh(deep), doctest::Contains("less than the thickness"), LoadError);
    RollingModel incompressible = rolling_block({});
    incompressible.tissue.poisson = 0.5;
    CHECK_THROWS_AS(choose_rolling_mesh(incompressible), MaterialError);
    Roller roller(rolling_block({}));
    CHECK_THROWS_WITH_AS(roller.at(-0.004, 0.02), doctest::Contains("off the tissue"), LoadError);
}
