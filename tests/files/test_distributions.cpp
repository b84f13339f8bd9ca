#include <cmath>
#include <doctest/doctest.h>
#include <initializer_list>
#include <limits>
#include <numbers>

#include "files/distributions.h"
#include "tests/close_to.h"

using namespace palpa::files;
using namespace palpa::test;

TEST_CASE("distributions: quantiles of the normal distribution") {
    CHECK(normal_quantile(0.5) == close_to(0.0));
    CHECK(normal_quantile(0.9) == close_to(1.2815515655446004).epsilon(1e-14));
    CHECK(normal_quantile(0.025) == close_to(-1.959963984540054).epsilon(1e-15));
    for (const double p : {1e-300, 1e-12, 1e-6, 0.01, 0.3, 0.77, 0.999}) {
        CAPTURE(p);
        CHECK(0.5 * std::erfc(-normal_quantile(p) / std::sqrt(2.0)) == close_to(p).epsilon(1e-12));
    }
}

TEST_CASE("distributions: Student's t where it has a closed form") {
    for (const double t : {0.1, 1.0, 2.5, 40.0}) {
        CAPTURE(t);
        CHECK(student_p(t, 1.0) == close_to(1.0 - 2.0 / std::numbers::pi * std::atan(t)).epsilon(1e-11));
        CHECK(student_p(t, 2.0) == close_to(1.0 - t / std::sqrt(2.0 + t * t)).epsilon(1e-10));
        CHECK(student_p(-t, 7.0) == student_p(t, 7.0));
    }
    CHECK(student_p(1e100, 1.0) == close_to(2.0 / std::numbers::pi * 1e-100).epsilon(1e-12));
    CHECK(student_p(1e200, 1.0) < 1e-199);  // its square overflows
    CHECK(student_p(std::numeric_limits<double>::infinity(), 3.0) == 0.0);
    CHECK(std::isnan(student_p(std::numeric_limits<double>::quiet_NaN(), 3.0)));
}

TEST_CASE("distributions: quantiles of Student's t as tabulated, and as the inverse of its p value") {
    // 97.5 %: any table of Student's t
    CHECK(student_quantile(0.95, 1.0) == close_to(12.706).epsilon(1e-4));
    CHECK(student_quantile(0.95, 2.0) == close_to(4.303).epsilon(1e-4));
    CHECK(student_quantile(0.95, 30.0) == close_to(2.042).epsilon(2e-4));
    CHECK(student_quantile(0.95, 40.0) == close_to(2.021).epsilon(1e-4));
    for (const double level : {0.01, 0.9, 0.999999}) {
        for (const double df : {1.0, 7.0, 1e4}) {
            CAPTURE(level);
            CAPTURE(df);
            CHECK(student_p(student_quantile(level, df), df) == close_to(1.0 - level).epsilon(1e-10));
        }
    }
}

TEST_CASE("distributions: binomial probabilities by hand, and no exception where they vanish") {
    CHECK(binomial_probability(8, 10, 0.5) == close_to(45.0 / 1024.0).epsilon(1e-14));
    CHECK(binomial_probability(2, 3, 0.25) == close_to(0.140625).epsilon(1e-14));
    CHECK(binomial_probability(0, 3, 0.25) == close_to(0.421875).epsilon(1e-14));
    CHECK(binomial_probability(3, 3, 0.25) == close_to(0.015625).epsilon(1e-14));
    CHECK(binomial_probability(0, 0, 0.25) == 1.0);
    CHECK(binomial_probability(100000, 100000, 0.1) == 0.0);
    double sum = 0.0;
    for (int k = 0; k <= 1000; ++k) sum += binomial_probability(k, 1000, 0.3);
    CHECK(sum == close_to(1.0).epsilon(1e-12));
}

TEST_CASE("distributions: chi-squared and F where they have a closed form or belong to t") {
    for (const double x : {0.1, 1.0, 3.841458820694124, 20.0}) {
        CAPTURE(x);
        CHECK(chi_squared_p(x, 1.0) == close_to(std::erfc(std::sqrt(0.5 * x))).epsilon(1e-12));
        CHECK(chi_squared_p(x, 2.0) == close_to(std::exp(-0.5 * x)).epsilon(1e-12));
        CHECK(f_distribution_p(x, 1.0, 7.5) == close_to(student_p(std::sqrt(x), 7.5)).epsilon(1e-12));
        CHECK(f_distribution_p(x, 2.0, 5.0) == close_to(std::pow(1.0 + 0.4 * x, -2.5)).epsilon(1e-12));
        CHECK(f_distribution_p(x, 3.0, std::numeric_limits<double>::infinity()) == chi_squared_p(3.0 * x, 3.0));
    }
    CHECK(chi_squared_p(0.0, 1.0) == 1.0);
    CHECK(f_distribution_p(-1.0, 1.0, 2.0) == 1.0);
    CHECK(std::isnan(chi_squared_p(std::nan(""), 1.0)));
    CHECK(std::isnan(f_distribution_p(std::nan(""), 1.0, 2.0)));
    CHECK(f_distribution_p(std::numeric_limits<double>::infinity(), 1.0, 2.0) == 0.0);
}
