#include <cmath>
#include <doctest/doctest.h>
#include <limits>

#include "stiffnessmaps/compare.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/stiffnessmaps/test_maps.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

const auto plane = [](double x, double y, double d) { return d * (300.0 + 4000.0 * x + 2000.0 * y); };

Map placed(Map map, double x_m, double y_m) {
    map.origin_m[0] += x_m;
    map.origin_m[1] += y_m;
    return map;
}

}  // namespace

TEST_CASE("compare: a map against itself differs by nothing") {
    const Map map = map_of(20, 15, kPaperDepths_m, plane);
    const MapDifference d = compare_maps(map, "a", map, "b");
    CHECK(d.all.n == map.normal_N.size());
    CHECK(d.all.greatest_N < 1e-6);
    CHECK(d.correlation == close_to(1.0));
    CHECK(d.grid_of == "a");
}

TEST_CASE("compare: bias, median, RMS and the greatest difference with its place") {
    const Map a = map_of(20, 15, kPaperDepths_m, plane);
    Map b = a;
    for (float& force : b.normal_N) force += 0.25f;
    b.normal_N[2 * b.n_cells() + 4 * b.n_x + 7] += 3.0f;
    const MapDifference d = compare_maps(a, "a", b, "b");
    const auto n = static_cast<double>(d.all.n);
    CHECK(d.all.median_N == close_to(0.25).epsilon(1e-4));
    CHECK(d.all.greatest_N >
          0.9);  // the curve over depth is made to rise, so a single spike is shared with its neighbours
    CHECK(d.all.at_x_m == close_to(a.x_of(7)));
    CHECK(d.all.at_y_m == close_to(a.y_of(4)));
    CHECK(d.all.bias_N == close_to(0.25 + 3.0 / n).epsilon(1e-3));
    CHECK(d.depths.size() == kPaperDepths_m.size());
    Map half = a;  // half of all places differ by 0.6 N
    for (std::size_t i = 0; i < half.normal_N.size(); i += 2) half.normal_N[i] += 0.6f;
    REQUIRE(half.n_x % 2 == 0);
    CHECK(compare_maps(a, "a", half, "half").all.median_N == close_to(0.3).epsilon(1e-3));
}

TEST_CASE("compare: on the coarser grid, the common area and the common depths") {
    const Map fine = map_of(41, 31, {1e-3, 2e-3, 3e-3, 4e-3}, plane);
    Map coarse = map_of(8, 8, {2e-3, 4e-3, 6e-3}, [](double, double, double) { return 0.0; });
    coarse.spacing_m[0] = coarse.spacing_m[1] = 3.7e-3;
    coarse = placed(coarse, 25e-3, -10e-3);
    for (std::size_t at = 0; at < coarse.normal_N.size(); ++at) {
        const std::size_t cell = at % coarse.n_cells();
        coarse.normal_N[at] = static_cast<float>(plane(coarse.x_of(cell % coarse.n_x), coarse.y_of(cell / coarse.n_x),
                                                       coarse.depths_m[at / coarse.n_cells()]));
    }
    for (const bool swapped : {false, true}) {
        const MapDifference d =
            swapped ? compare_maps(coarse, "coarse", fine, "fine") : compare_maps(fine, "fine", coarse, "coarse");
        CHECK(d.grid_of == (swapped ? "a" : "b"));
        CHECK(d.depths_of == (swapped ? "a" : "b"));
        CHECK(d.a.spacing_m[0] == close_to(3.7e-3));
        CHECK(d.a.n_depths() == 2);
        CHECK(d.a.n_x < 8);
        CHECK(d.a.x_of(d.a.n_x - 1) <= fine.x_of(40) + 0.5e-3 + 1e-9);
        CHECK(d.all.n > 20);
        CHECK(d.all.median_N < 1e-5);  // a plane is interpolated exactly
    }
}

TEST_CASE("compare: the deepest layer counts where its depth differs by rounding, in both orders") {
    const Map a = map_of(12, 10, {1e-3, 2.9937299e-3}, plane);
    const Map b = map_of(12, 10, {1e-3, 2.99373e-3}, plane);
    CHECK(compare_maps(a, "a", b, "b").all.n == 2 * a.n_cells());
    CHECK(compare_maps(b, "b", a, "a").all.n == 2 * a.n_cells());
}

TEST_CASE("compare: what one of them has not measured is left out; nothing in common is refused") {
    const Map a = map_of(12, 10, kPaperDepths_m, plane);
    Map holes = a;
    for (std::size_t k = 0; k < a.n_depths(); ++k)
        holes.normal_N[k * a.n_cells() + 5] = std::numeric_limits<float>::quiet_NaN();
    CHECK(compare_maps(a, "a", holes, "b").all.n == (a.n_cells() - 1) * a.n_depths());
    const Map away = placed(a, 0.5, 0.0);
    const std::string said = message_of([&] { compare_maps(a, "a.map", away, "b.map"); });
    CHECK(contains(
        said,
        "b.map: found a map of x 500 to 511, y 0 to 9 mm, expected one that overlaps a.map, x 0 to 11, y 0 to 9 mm"));
    Map left = a;
    Map right = a;
    for (std::size_t at = 0; at < a.normal_N.size(); ++at) {
        (at % a.n_x < 6 ? right : left).normal_N[at] = std::numeric_limits<float>::quiet_NaN();
    }
    CHECK(contains(message_of([&] { compare_maps(left, "a.map", right, "b.map"); }),
                   "no place and depth where both maps were measured"));
}
