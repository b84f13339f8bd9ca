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
