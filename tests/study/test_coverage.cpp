#include <cmath>
#include <doctest/doctest.h>
#include <numbers>

#include "study/coverage.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::test;

TEST_CASE("coverage: the area of a press is that of its disc, and levels are thirds of the depth") {
    Coverage c = make_coverage(0.0, 0.0, 0.12, 0.12, 0.006);
    CHECK(c.n_x == 120);
    cover(0.06, 0.06, 0.03, 0.0025, c);
    const double disc = std::numbers::pi * 0.03 * 0.03 / (0.12 * 0.12);
    CoverageShares shares = shares_of(c);
    CHECK(shares.at_least[1] == close_to(disc).epsilon(0.02));
    CHECK(shares.at_least[2] == close_to(shares.at_least[1]));  // 2.5 of 6 mm is medium
    CHECK(shares.at_least[3] == 0.0);
    CHECK(shares.at_least[0] == close_to(1.0 - shares.at_least[1]));
    CHECK(deepest_near(c, 0.06, 0.06, 0.001) == close_to(0.0025));
    CHECK(deepest_near(c, 0.01, 0.01, 0.001) == 0.0);
    cover(0.0607, 0.0607, 0.0, 0.005, c);  // no radius: the cell that holds it
    CHECK(shares_of(c).at_least[3] == close_to(1.0 / (120 * 120)));
    cover(0.0607, 0.0607, 0.03, 0.001, c);  // lighter than before changes nothing
    CHECK(deepest_near(c, 0.0607, 0.0607, 0.001) == close_to(0.005));
}

TEST_CASE("coverage: presses beside it, without depth, or not numbers leave it alone") {
    Coverage c = make_coverage(0.0, 0.0, 0.01, 0.02, 0.006);
    cover(0.005, 0.01, 0.002, 0.0, c);
    cover(NAN, 0.01, 0.002, 0.001, c);
    cover(0.005, 0.01, NAN, 0.001, c);
    cover(5.0, 5.0, 0.002, 0.001, c);
    CHECK(shares_of(c).at_least[0] == close_to(1.0));
    CHECK(make_coverage(0.0, 0.0, 100.0, 1.0, 0.006).n_x == 512);
}

TEST_CASE("coverage: shares of all or nothing are exactly 1 or 0, whatever the number of cells") {
    for (const double width_m : {0.01, 0.049, 0.093, 0.12}) {
        Coverage c = make_coverage(0.0, 0.0, width_m, 0.061, 0.006);
        CHECK(shares_of(c).at_least[0] == 1.0);
        cover(0.5 * width_m, 0.03, 1.0, 0.005, c);
        CHECK(shares_of(c).at_least[0] == 0.0);
        for (int level = 1; level < kPalpationLevels; ++level) CHECK(shares_of(c).at_least[level] == 1.0);
    }
}

TEST_CASE("coverage: a press beside a rod, though within half its length of its middle, is not on it") {
    const Target rod{"D1", 0.06, 0.06, 0.013, 0.063, 0.5 * std::numbers::pi};  // along y
    const auto depth_after = [&](double x_m, double y_m) {
        Coverage c = make_coverage(0.0, 0.0, 0.12, 0.12, 0.006);
        cover(x_m, y_m, 0.002, 0.003, c);
        return deepest_on(c, rod).depth_m;
    };
    CHECK(depth_after(0.085, 0.06) == 0.0);
    CHECK(depth_after(0.06, 0.085) == close_to(0.003));
    CHECK(depth_after(0.06, 0.0945) == 0.0);  // beyond its end
    CHECK(depth_after(0.066, 0.04) == close_to(0.003));
    Coverage c = make_coverage(0.0, 0.0, 0.12, 0.12, 0.006);
    cover(0.0303, 0.0303, 0.0, 0.004, c);
    CHECK(deepest_on(c, {"point", 0.0304, 0.0304, 0.0, 0.0, 0.0}).depth_m ==
          close_to(0.004));  // the cell that holds it
}

TEST_CASE("coverage: the deepest press on a target says whether the tissue is known deeper there") {
    const Target target{"A", 0.06, 0.06, 0.02, 0.02, 0.0};
    Coverage c = make_coverage(0.0, 0.0, 0.12, 0.12, 0.004);
    CHECK_FALSE(deepest_on(c, target).beyond);
    cover(0.06, 0.06, 0.002, 0.0033, c);
    CHECK_FALSE(deepest_on(c, target).beyond);
    cover(0.06, 0.06, 0.002, 0.0033, c, true);  // as deep as the place is known, and held there
    CHECK(deepest_on(c, target).beyond);
    CHECK(deepest_on(c, target).depth_m == close_to(0.0033));
    cover(0.06, 0.06, 0.002, 0.002, c);  // lighter than before changes nothing
    cover(0.03, 0.03, 0.002, 0.003, c);  // nor what is not on the target
    CHECK(deepest_on(c, target).beyond);
    cover(0.062, 0.06, 0.002, 0.0036, c);  // known deeper
    CHECK_FALSE(deepest_on(c, target).beyond);
    CHECK(deepest_on(c, target).depth_m == close_to(0.0036));
}
