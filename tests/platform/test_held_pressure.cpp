#include <doctest/doctest.h>
#include <initializer_list>

#include "platform/held_pressure.h"

TEST_CASE("held pressure: the share of the hold time, kept within 0 and 1") {
    struct Case {
        double held_s, hold_s, share;
    };
    for (const Case& c : {Case{-1.0, 2.0, 0.0},
                          {0.0, 2.0, 0.0},
                          {0.5, 2.0, 0.25},
                          {2.0, 2.0, 1.0},
                          {9.0, 2.0, 1.0},
                          {0.0, 0.0, 1.0},
                          {3.0, -1.0, 1.0}}) {
        CAPTURE(c.held_s);
        CAPTURE(c.hold_s);
        CHECK(palpa::platform::held_share(c.held_s, c.hold_s) == c.share);
    }
}

TEST_CASE("held pressure: grid points begin after the last one that was done, a minute back at most") {
    CHECK(palpa::platform::first_grid_point(100, 103) == 101);
    CHECK(palpa::platform::first_grid_point(103, 103) == 104);
    CHECK(palpa::platform::first_grid_point(0, 1'000'000) == 1'000'000 - 60 * 240 + 1);
    CHECK(palpa::platform::last_grid_point(-0.001) == -1);
    CHECK(palpa::platform::grid_time_s(240) == 1.0);
}
