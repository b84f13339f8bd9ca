#include <doctest/doctest.h>

#include "figures/tic_step.h"
#include "tests/close_to.h"

using palpa::figures::tic_step;

TEST_CASE("tic step: 1, 2 or 5 times a power of ten, never more tics than asked for") {
    struct Case {
        double range, about, step;
    };
    for (const Case& c : {Case{10.0, 10.0, 1.0},
                          {11.0, 10.0, 2.0},
                          {21.0, 10.0, 5.0},
                          {51.0, 10.0, 10.0},
                          {0.03, 4.0, 0.01},
                          {120.0, 6.0, 20.0},
                          {7.0, 0.0, 10.0}}) {
        CAPTURE(c.range);
        CHECK(tic_step(c.range, c.about) == test::close_to(c.step));
    }
    CHECK(tic_step(0.0, 5.0) > 0.0);  // a loop over tics must end
}
