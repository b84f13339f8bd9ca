#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "stiffnessmaps/grid.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

TEST_CASE("grid: isotonic regression is non-decreasing, keeps the sum, and is the closest such sequence") {
    std::vector<double> values{1, 3, 2, 4, 3, 3, 9};
    make_isotonic(values);
    const std::vector<double> expected{1, 2.5, 2.5, 10.0 / 3, 10.0 / 3, 10.0 / 3, 9};
    for (std::size_t i = 0; i < values.size(); ++i) CHECK(values[i] == close_to(expected[i]));

    constexpr std::uint32_t kSeed = 5;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::normal_distribution<double> noise;
    for (int trial = 0; trial < 200; ++trial) {
        std::vector<double> raw(8);
        for (double& v : raw) v = noise(random);
        std::vector<double> fit = raw;
        make_isotonic(fit);
        CHECK(std::is_sorted(fit.begin(), fit.end()));
        const auto distance = [&](const std::vector<double>& other) {
            double sum = 0.0;
            for (std::size_t i = 0; i < raw.size(); ++i) sum += (raw[i] - other[i]) * (raw[i] - other[i]);
            return sum;
        };
        for (int k = 0; k < 50; ++k) {
            std::vector<double> other = fit;
            for (double& v : other) v += 0.1 * noise(random);
            std::sort(other.begin(), other.end());
            CHECK(distance(fit) <= distance(other) + 1e-12);
        }
    }
}

TEST_CASE("grid: smoothing keeps a constant, missing cells stay missing and weigh nothing") {
    const GridShape shape{9, 7, 1.0, 2.0};
    std::vector<double> values(shape.size(), 5.0);
    values[10] = NAN;
    const auto out = smooth(values, shape, 1.5);
    for (std::size_t i = 0; i < out.size(); ++i) {
        if (i == 10) {
            CHECK(std::isnan(out[i]));
        } else {
            CHECK(out[i] == close_to(5.0).epsilon(1e-14));
        }
    }
    CHECK(smooth(std::vector<double>{1.0, 2.0}, {2, 1, 1.0, 1.0}, 0.0) == std::vector<double>{1.0, 2.0});
}

TEST_CASE("grid: filling reaches every cell and stays between its neighbours") {
    const GridShape shape{20, 10, 1.0, 1.0};
    std::vector<double> values(shape.size(), NAN);
    values[0] = 1.0;
    values[199] = 3.0;
    fill_missing(values, shape);
    for (const double v : values) {
        CHECK(v >= 1.0);
        CHECK(v <= 3.0);
    }
}

TEST_CASE("grid: gradient of a plane is exact, also at borders and on a single row") {
    const GridShape shape{5, 4, 0.5, 2.0};
    std::vector<double> values;
    for (int j = 0; j < 4; ++j) {
        for (int i = 0; i < 5; ++i) values.push_back(3.0 * 0.5 * i - 7.0 * 2.0 * j);
    }
    const Gradient g = gradient(values, shape);
    for (std::size_t i = 0; i < values.size(); ++i) {
        CHECK(g.x[i] == close_to(3.0));
        CHECK(g.y[i] == close_to(-7.0));
    }
    const Gradient one = gradient({1.0}, {1, 1, 1.0, 1.0});
    CHECK(one.x[0] == 0.0);
    CHECK(one.y[0] == 0.0);
}
