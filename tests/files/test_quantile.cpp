#include <cmath>
#include <doctest/doctest.h>

#include "files/quantile.h"

using namespace palpa::files;

TEST_CASE("quantile: numpy's values, ends, one value, none, and what has no order") {
    const std::vector<double> values{7.0, 1.0, 4.0, 2.0};
    CHECK(quantile(values, 0.0) == 1.0);
    CHECK(quantile(values, 0.25) == doctest::Approx(1.75));  // numpy.quantile
    CHECK(quantile(values, 0.9) == doctest::Approx(6.1));
    CHECK(quantile(values, 1.0) == 7.0);
    CHECK(median(values) == 3.0);
    CHECK(median({5.0, 1.0, 3.0}) == 3.0);
    CHECK(quantile({8.0}, 0.7) == 8.0);
    CHECK(std::isnan(median({})));
    CHECK(std::isnan(median({NAN, INFINITY})));
    CHECK(median({NAN, 3.0, INFINITY, 1.0, 2.0, -INFINITY}) == 2.0);
}
