#include <cmath>
#include <doctest/doctest.h>

#include "mechanics/error.h"
#include "mechanics/sphere_press.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

SpherePress small_press() {
    SpherePressBlock block;
    block.material = {Law::neo_hookean, 5e3, 30e3};
    return make_sphere_press(block, 6e-3);
}

}  // namespace

TEST_CASE("sphere on a soft block: the force is the slope of the elastic energy") {
    const SpherePress press = small_press();
    SpherePressWork work = make_work(press);
    for (int k = 1; k <= 8; ++k) REQUIRE(converge_at(press, 0.5e-3 * k, work).valid);
    // within one set of nodes in contact
    constexpr double kHalf_m = 1e-7;
    const SpherePressAnswer middle = converge_at(press, 4e-3, work);
    REQUIRE(converge_at(press, 4e-3 + kHalf_m, work).valid);
    const double above_J = energy_J(press.body, work.u_m);
    const double above_N = converge_at(press, 4e-3 + kHalf_m, work).force_N;
    REQUIRE(converge_at(press, 4e-3 - kHalf_m, work).valid);
    const double below_J = energy_J(press.body, work.u_m);
    const double below_N = converge_at(press, 4e-3 - kHalf_m, work).force_N;
    CHECK(middle.force_N == close_to(4.0 * (above_J - below_J) / (2.0 * kHalf_m)).epsilon(1e-5));
    CHECK(middle.slope_N_per_m == close_to((above_N - below_N) / (2.0 * kHalf_m)).epsilon(5e-2));
    CHECK(middle.force_N > 0.05);
}

TEST_CASE("sphere on a soft block: no node is inside the sphere, none is pulled, and the curve rises") {
    const SpherePress press = small_press();
    SpherePressWork work = make_work(press);
    double before_N = 0.0;
    for (int k = 1; k <= 24; ++k) {
        const double depth_m = 0.25e-3 * k;
        const SpherePressAnswer answer = converge_at(press, depth_m, work);
        REQUIRE(answer.valid);
        CHECK(answer.force_N > before_N);
        before_N = answer.force_N;
        CHECK(work.p_N.minCoeff() >= 0.0);
        const Eigen::Vector3d centre_m(0.0, 0.0, press.block.size_m[2] + press.block.radius_m - depth_m);
        for (const int node : press.touch) {
            const Eigen::Vector3d x_m = press.body.mesh.nodes_m.col(node) + work.u_m.col(node);
            CHECK((x_m - centre_m).norm() > press.block.radius_m - 1e-10);
        }
    }
}

TEST_CASE("sphere on a soft block: one step per tick follows a finger, and repeated at one depth it converges") {
    const SpherePress press = small_press();
    SpherePressWork exact = make_work(press);
    SpherePressWork steps = make_work(press);
    double worst = 0.0;
    for (int k = 1; k <= 100; ++k) {  // 5 mm/s at 100 Hz
        const double depth_m = 0.05e-3 * k;
        const double exact_N = converge_at(press, depth_m, exact).force_N;
        worst = std::max(worst, std::abs(step_to(press, depth_m, steps).force_N - exact_N));
    }
    const double greatest_N = converge_at(press, 5e-3, exact).force_N;
    CHECK(worst < 0.01 * greatest_N);
    for (int i = 0; i < 12; ++i) step_to(press, 5e-3, steps);
    CHECK(step_to(press, 5e-3, steps).force_N == close_to(greatest_N).epsilon(1e-8));
}

TEST_CASE("sphere on a soft block: a step allocates nothing; what is not finite and a jump change nothing for good") {
    const SpherePress press = small_press();
    SpherePressWork work = make_work(press);
    converge_at(press, 2e-3, work);
    const long before = allocation_count();
    const SpherePressAnswer answer = step_to(press, 2.05e-3, work);
    CHECK(allocation_count() == before);
    CHECK_FALSE(step_to(press, NAN, work).valid);
    CHECK(step_to(press, 2.05e-3, work).force_N == close_to(answer.force_N).epsilon(1e-3));
    for (int i = 0; i < 30; ++i) CHECK(std::isfinite(step_to(press, i % 2 == 0 ? 6e-3 : 0.0, work).force_N));
    CHECK(converge_at(press, 0.0, work).force_N == close_to(0.0));
}

TEST_CASE("sphere on a soft block: what cannot be pressed is refused") {
    SpherePressBlock block;
    CHECK_THROWS_AS(make_sphere_press(block, 13e-3), LoadError);
    block.radius_m = 30e-3;
    CHECK_THROWS_AS(make_sphere_press(block, 5e-3), LoadError);
}
