#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>

#include "parts/proxy.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::parts;
using namespace palpa::test;
using palpa::test::close_to;

namespace {

constexpr double kPitch_m = 1e-3;
const Slice kSide{{0, 2}, 0};

mechanics::Voxels room(int n) { return mechanics::empty_voxels({n, 1, n}, {kPitch_m, {}}); }

void fill_box(mechanics::Voxels& voxels, int x0, int x1, int z0, int z1) {
    for (int z = z0; z < z1; ++z) mechanics::set_line(0, z, {{x0, x1, 0}}, voxels);
}

bool in_material(const mechanics::Voxels& voxels, const std::array<double, 2>& p_m) {
    return filled_at(voxels, kSide, static_cast<int>(std::floor(p_m[0] / kPitch_m)),
                     static_cast<int>(std::floor(p_m[1] / kPitch_m)));
}

}  // namespace

TEST_CASE("proxy: it stays on the surface under a pen that goes in, slides along it and comes off with the pen") {
    mechanics::Voxels voxels = room(40);
    fill_box(voxels, 5, 35, 0, 10);
    std::array<double, 2> proxy{10e-3, 30e-3};
    follow_pen(voxels, kSide, {10e-3, 4e-3}, proxy);
    CHECK(proxy[0] == close_to(10e-3));
    CHECK(proxy[1] == close_to(10e-3).epsilon(1e-5));
    CHECK(rests_on(voxels, kSide, 1, -1, proxy));
    follow_pen(voxels, kSide, {25e-3, 2e-3}, proxy);
    CHECK(proxy[0] == close_to(25e-3));
    CHECK(rests_on(voxels, kSide, 1, -1, proxy));
    follow_pen(voxels, kSide, {25e-3, 20e-3}, proxy);
    CHECK(proxy[1] == close_to(20e-3));
    CHECK_FALSE(rests_on(voxels, kSide, 1, -1, proxy));
}

TEST_CASE("proxy: a wall one voxel thin holds a pen at any speed and in any direction, also at corners") {
    mechanics::Voxels voxels = room(64);
    // a closed box of walls one voxel thin
    for (int z = 10; z < 54; ++z) {
        if (z == 10 || z == 53) {
            mechanics::set_line(0, z, {{10, 54, 0}}, voxels);
        } else {
            mechanics::set_line(0, z, {{10, 11, 0}, {53, 54, 0}}, voxels);
        }
    }
    std::mt19937 random(3);  // seed 3
    std::uniform_real_distribution<double> anywhere(-1.0, 1.1);
    std::array<double, 2> proxy{30e-3, 30e-3};
    for (int i = 0; i < 20000; ++i) {
        follow_pen(voxels, kSide, {anywhere(random), anywhere(random)}, proxy);
        REQUIRE_FALSE(in_material(voxels, proxy));
        REQUIRE((proxy[0] > 11e-3 && proxy[0] < 53e-3 && proxy[1] > 11e-3 && proxy[1] < 53e-3));
    }
    follow_pen(voxels, kSide, {1.0, 1.0}, proxy);  // into the corner
    CHECK(proxy[0] == close_to(53e-3).epsilon(1e-5));
    CHECK(proxy[1] == close_to(53e-3).epsilon(1e-5));
}

TEST_CASE("proxy: voxels that touch along an edge only let nothing through between them") {
    mechanics::Voxels voxels = room(40);
    for (int z = 0; z < 40; ++z) mechanics::set_line(0, z, {{z, z + 1, 0}}, voxels);  // a diagonal
    std::mt19937 random(5);                                                           // seed 5
    std::uniform_real_distribution<double> anywhere(0.0, 40e-3);
    std::array<double, 2> proxy{30.5e-3, 5.5e-3};
    for (int i = 0; i < 20000; ++i) {
        follow_pen(voxels, kSide, {anywhere(random), anywhere(random)}, proxy);
        REQUIRE(proxy[0] > proxy[1]);
    }
}

TEST_CASE("proxy: pens that are no numbers, far away, and a proxy that begins in the material") {
    mechanics::Voxels voxels = room(20);
    fill_box(voxels, 0, 20, 0, 10);
    std::array<double, 2> proxy{5e-3, 15e-3};
    follow_pen(voxels, kSide, {std::numeric_limits<double>::quiet_NaN(), 0.0}, proxy);
    CHECK(proxy[1] == close_to(15e-3));
    follow_pen(voxels, kSide, {5e-3, -1e300}, proxy);
    CHECK(proxy[1] == close_to(10e-3).epsilon(1e-5));
    std::array<double, 2> inside{5e-3, 5e-3};
    follow_pen(voxels, kSide, {5e-3, 15e-3}, inside);
    CHECK(inside[1] == close_to(5e-3));
}
