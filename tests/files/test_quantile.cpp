#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <initializer_list>
#include <vector>

#include "files/quantile.h"
#include "tests/close_to.h"

using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("quantile: numpy's values, ends, one value, none, and what has no order") {
    const std::vector<double> values{7.0, 1.0, 4.0, 2.0};
    CHECK(quantile(values, 0.0) == 1.0);
    CHECK(quantile(values, 0.25) == close_to(1.75));  // numpy.quantile
    CHECK(quantile(values, 0.9) == close_to(6.1));
    CHECK(quantile(values, 1.0) == 7.0);
    CHECK(median(values) == 3.0);
    CHECK(median({5.0, 1.0, 3.0}) == 3.0);
    CHECK(quantile({8.0}, 0.7) == 8.0);
    CHECK(std::isnan(median({})));
    CHECK(std::isnan(median({NAN, INFINITY})));
    CHECK(median({NAN, 3.0, INFINITY, 1.0, 2.0, -INFINITY}) == 2.0);
}

TEST_CASE("quantile: the types, as numpy computes them") {
    using enum QuantileType;
    const std::vector<double> even{10.0, 20.0, 30.0, 40.0};
    struct Case {
        double share;
        double between_, nearest_, lower_, reached_;
    };
    for (const Case& c : {Case{0.0, 10.0, 10.0, 10.0, 10.0},
                          {0.25, 17.5, 20.0, 10.0, 10.0},
                          {0.26, 17.8, 20.0, 10.0, 20.0},
                          {0.5, 25.0, 30.0, 20.0, 20.0},
                          {0.9, 37.0, 40.0, 30.0, 40.0},
                          {1.0, 40.0, 40.0, 40.0, 40.0}}) {
        CAPTURE(c.share);
        CHECK(quantile(even, c.share, between) == close_to(c.between_).epsilon(1e-14));
        CHECK(quantile(even, c.share, nearest) == c.nearest_);
        CHECK(quantile(even, c.share, lower) == c.lower_);
        CHECK(quantile(even, c.share, reached) == c.reached_);
    }
    CHECK(upper_median(even) == 30.0);
    CHECK(upper_median({3.0, NAN, 1.0, 2.0}) == 2.0);
    CHECK(std::isnan(upper_median({})));
}

TEST_CASE("quantile: sorted, reordered and copied values give the same") {
    std::vector<double> values;
    for (int i = 0; i < 97; ++i) values.push_back(static_cast<double>(i * 61 % 97));
    std::vector<double> sorted = values;
    std::sort(sorted.begin(), sorted.end());
    using enum QuantileType;
    for (const QuantileType type : {between, nearest, lower, reached}) {
        for (int k = 0; k <= 40; ++k) {
            const double share = k / 40.0;
            CAPTURE(share);
            std::vector<double> mine = values;
            const double expected = sorted_quantile(sorted, share, type);
            CHECK(reordered_quantile(mine, share, type) == expected);
            CHECK(quantile(values, share, type) == expected);
        }
    }
}
