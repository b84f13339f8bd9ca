// Virtual rolling with a cylinder, and virtual sliding with friction (rolling.h).

#include <cmath>
#include <doctest/doctest.h>
#include <utility>

#include "mechanics/error.h"
#include "tests/close_to.h"
#include "tests/mechanics/rolling_block.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

RollingModel rough(RollingModel model, double mu) {
    model.friction = mu;
    return model;
}

RollingModel cylinder(RollingModel model, double length_m) {
    model.shape = IndenterShape::cylinder;
    model.length_m = length_m;
    return model;
}

// Beside the ball, near a side, half over a side, in a corner.
using Places = std::vector<std::pair<double, double>>;
const Places kPlaces{{0.0245, 0.024}, {0.048, 0.025}, {0.0, 0.025}, {0.049, 0.003}};

void compare_with_one_mesh(Roller& roller, const Places& places, double most) {
    const double greatest_N = roller.at(0.02, 0.025).normal_N;
    for (const auto& place : places) {
        const double x = place.first, y = place.second;
        CAPTURE(x);
        const auto one =
            press_on_one_mesh(roller.model, roller.mesh.contact_m, roller.mesh.cells_across, x, y, kDepths_m);
        for (std::size_t k = 0; k < 2; ++k) {
            const RollingForce apart = roller.at(x, y, k);
            MESSAGE("normal ", apart.normal_N, " / ", one[k].normal_N, " N, along x ", apart.tangential_x_N, " / ",
                    one[k].tangential_x_N, " N, along y ", apart.tangential_y_N, " / ", one[k].tangential_y_N, " N");
            CHECK(std::abs(apart.normal_N - one[k].normal_N) < most * greatest_N);
            CHECK(std::abs(apart.tangential_x_N - one[k].tangential_x_N) < most * greatest_N);
            CHECK(std::abs(apart.tangential_y_N - one[k].tangential_y_N) < most * greatest_N);
        }
    }
}

}  // namespace

TEST_CASE("sliding: taken apart and put together is one mesh of the whole block, within 4 % of the greatest force") {
    Roller roller(rough(rolling_block({ball(0.02, 0.025, 0.005)}), 0.5));
    compare_with_one_mesh(roller, kPlaces, 0.04);
}

TEST_CASE("cylinder: taken apart and put together is one mesh of the whole block, within 4 % of the greatest force") {
    Roller roller(cylinder(rolling_block({ball(0.02, 0.025, 0.005)}), 0.006));
    compare_with_one_mesh(roller, {kPlaces[0], kPlaces[3]}, 0.04);
    Roller slid(rough(roller.model, 0.5));
    compare_with_one_mesh(slid, kPlaces, 0.04);
}

TEST_CASE("sliding: as the coefficient goes to nothing it is rolling, and rolling stores nothing for it") {
    Roller rolled(rolling_block({ball(0.02, 0.025, 0.005)}));
    CHECK(rolled.tables.contact.along_x.empty());
    for (const PairTable& part : rolled.tables.parts) CHECK(part.along_y.empty());
    Roller slid(rough(rolled.model, 1e-7));
    for (std::size_t i = 0; i < rolled.tables.contact.value.size(); ++i) {
        CHECK(slid.tables.contact.value[i] == close_to(rolled.tables.contact.value[i]).epsilon(1e-12));
    }
    for (const double x : {0.0, 0.017, 0.023}) {
        const RollingForce a = rolled.at(x, 0.025);
        const RollingForce b = slid.at(x, 0.025);
        CHECK(b.normal_N == close_to(a.normal_N).epsilon(1e-6));
        CHECK(std::abs(b.tangential_x_N - a.tangential_x_N) < 1e-6 * a.normal_N);
        CHECK(std::abs(b.tangential_y_N - a.tangential_y_N) < 1e-6 * a.normal_N);
    }
}

TEST_CASE("sliding: a mirrored phantom gives mirrored answers, a transposed one exchanges x and y") {
    const double mu = 0.4;
    Roller roller(rough(rolling_block({ball(0.015, 0.020, 0.005)}), mu));
    Roller over_y(rough(rolling_block({ball(0.015, 0.030, 0.005)}), mu));
    Roller transposed(rough(rolling_block({ball(0.020, 0.015, 0.005)}), mu));
    Roller over_x(rough(rolling_block({ball(0.035, 0.020, 0.005)}), mu));
    for (const auto& place : {std::pair{0.013, 0.022}, {0.001, 0.018}, {0.030, 0.049}}) {
        const double x = place.first, y = place.second;
        CAPTURE(x);
        const RollingForce f = roller.at(x, y);
        CHECK(over_y.at(x, 0.05 - y).normal_N == close_to(f.normal_N).epsilon(1e-8));
        CHECK(over_y.at(x, 0.05 - y).tangential_x_N == close_to(f.tangential_x_N).epsilon(1e-7));
        CHECK(transposed.at(y, x).tangential_y_N == close_to(f.tangential_x_N).epsilon(1e-7));
        CHECK(transposed.at(y, x).tangential_x_N == close_to(f.tangential_y_N).epsilon(1e-7));
        // towards -x over the block mirrored in x
        over_x.at(0.05 - x, y);
        Contact back;
        slide_steadily(over_x.work.patch, {{IndenterShape::sphere, 0.003}, {0.05 - x, y, kDepths_m[1]}},
                       {{-1.0, 0.0}, mu}, over_x.work.slide, back);
        CHECK(back.tool[0].normal_N == close_to(f.normal_N).epsilon(1e-8));
        CHECK(back.tool[0].tangential_x_N == close_to(-f.tangential_x_N).epsilon(1e-7));
    }
}

TEST_CASE("sliding: mu N and a few per cent in the middle of a plain block; more before a ball than behind it") {
    const double mu = 0.3;
    Roller roller(rough(rolling_block({ball(0.025, 0.025, 0.006)}), mu));
    const auto above_friction_N = [&](double x) {
        const RollingForce f = roller.at(x, 0.025);
        return f.tangential_x_N - mu * f.normal_N;
    };
    CHECK(above_friction_N(0.021) > 0.02 * roller.at(0.021, 0.025).normal_N);
    CHECK(above_friction_N(0.029) < -0.02 * roller.at(0.029, 0.025).normal_N);
    Roller plain(rough(rolling_block({}), mu));
    const RollingForce middle = plain.at(0.025, 0.025);
    CHECK(middle.tangential_x_N == close_to(mu * middle.normal_N).epsilon(0.05));
    CHECK(middle.tangential_y_N == close_to(middle.tangential_x_N).epsilon(1e-9));
}

TEST_CASE("cylinder: symmetric, stronger the longer, resists along y too, and rolls without ripple") {
    Roller roller(cylinder(rolling_block({}), 0.006));
    const RollingForce middle = roller.at(0.025, 0.025);
    CHECK(std::abs(middle.tangential_x_N) < 1e-9 * middle.normal_N);
    CHECK(roller.at(0.010, 0.025).normal_N == close_to(roller.at(0.040, 0.025).normal_N).epsilon(1e-8));
    CHECK(roller.at(0.025, 0.008).normal_N == close_to(roller.at(0.025, 0.042).normal_N).epsilon(1e-8));
    Roller longer(cylinder(rolling_block({}), 0.012));
    const double ratio = longer.at(0.025, 0.025).normal_N / middle.normal_N;
    CHECK(ratio > 1.5);
    CHECK(ratio < 2.0);
    std::vector<double> force_N;
    for (int i = 0; i <= 20; ++i) {
        const double off_m = 0.1 * i * roller.mesh.contact_m;
        force_N.push_back(roller.at(0.022 + off_m, 0.021 + off_m).normal_N);
    }
    for (std::size_t i = 1; i + 1 < force_N.size(); ++i) {
        CHECK(std::abs(force_N[i - 1] - 2.0 * force_N[i] + force_N[i + 1]) < 2e-5 * force_N[i]);
    }
}

TEST_CASE("cylinder: its lattice ends where it does and stays bounded; half the coarseness is half the spacing") {
    for (const double length_m : {0.0005, 0.005, 0.0131, 0.04}) {
        RollingModel model = cylinder(rolling_block({}), length_m);
        const double h_m = choose_rolling_mesh(model).contact_m;
        const double rows = length_m / h_m;
        CHECK(rows == close_to(std::round(rows)).epsilon(1e-12));
        CHECK(rows * 2.0 * model.radius_m / h_m < 720.0);  // 600, and what rounding to whole cells adds
        CHECK(choose_rolling_mesh(model, 0.5).contact_m == close_to(0.5 * h_m).epsilon(0.35));
    }
    CHECK_THROWS_WITH_AS(choose_rolling_mesh(cylinder(rolling_block({}), 0.0)), doctest::Contains("length"), LoadError);
    CHECK_THROWS_WITH_AS(choose_rolling_mesh(cylinder(rolling_block({}), 1e-5)), doctest::Contains("at least"),
                         LoadError);
    CHECK_THROWS_WITH_AS(choose_rolling_mesh(rough(rolling_block({}), -0.1)), doctest::Contains("friction"), LoadError);
}
