#include <doctest/doctest.h>

#include "scene/meter.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::scene;
using namespace palpa::test;

TEST_CASE("meter: quantiles are good to 3 %") {
    Meter meter;
    for (int i = 1; i <= 100000; ++i) meter.add_ns(i);
    CHECK(meter.quantile_ns(0.5) == close_to(50000).epsilon(0.03));
    CHECK(meter.quantile_ns(0.99) == close_to(99000).epsilon(0.03));
    CHECK(meter.quantile_ns(1.0) <= 100000);
    CHECK(meter.worst_ns() == 100000);
    CHECK(meter.timed() == 100000);
    CHECK(meter.calls() == 0);
    CHECK(Meter{}.quantile_ns(0.5) == 0.0);
    Meter odd;
    odd.add_ns(0.0);
    odd.add_ns(1e30);
    CHECK(odd.timed() == 2);
}
