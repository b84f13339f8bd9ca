#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

#include "study/bootstrap.h"
#include "study/random.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::study;
using namespace palpa::test;

namespace {

People people(int n, int items, double spread, std::uint64_t seed) {
    Random random(seed);
    People out;
    for (int i = 0; i < n; ++i) {
        const double p = std::clamp(0.6 + spread * random.normal(), 0.0, 1.0);
        Contribution one{0, items};
        for (int k = 0; k < items; ++k) one.k += random.uniform() < p ? 1 : 0;
        out.emplace_back(one);
    }
    return out;
}

double width(const Interval& ci) { return ci.high - ci.low; }

}  // namespace

TEST_CASE("bootstrap: repeats from its seed") {
    const auto all = people(20, 3, 0.2, 5);
    const Interval a = bootstrap_share(all, {500, 7, 0.95});
    const Interval b = bootstrap_share(all, {500, 7, 0.95});
    CHECK(a.low == b.low);
    CHECK(a.high == b.high);
}

TEST_CASE("bootstrap: the width is that of a mean over people") {
    // k alike for all but chance: standard error of the share from the spread of the people
    const auto all = people(400, 3, 0.0, 6);
    double mean = 0.0, square = 0.0;
    for (const auto& one : all) {
        const double share = static_cast<double>(one->k) / 3.0;
        mean += share / 400.0;
        square += share * share / 400.0;
    }
    const double error = std::sqrt((square - mean * mean) / 400.0);
    // 4,000 resamples: quantiles good to some 3 % of the error
    CHECK(width(bootstrap_share(all, {4000, 1, 0.95})) == close_to(2.0 * 1.96 * error).epsilon(0.06));
}

TEST_CASE("bootstrap: clusters widen, pairs narrow") {
    const auto clustered = people(20, 30, 0.35, 9);
    std::int64_t k = 0;
    for (const auto& one : clustered) k += one->k;
    CHECK(width(bootstrap_share(clustered, {})) > 1.5 * width(wilson({k, 600}, z_of_level(0.95))));

    auto better = clustered;
    for (auto& one : better) one->k = std::min<std::int64_t>(one->n, one->k + 3);
    const Interval within = bootstrap_difference(better, clustered, Average::pooled, {});
    People a(better), b(20);
    a.resize(40);
    b.insert(b.end(), clustered.begin(), clustered.end());
    const Interval between = bootstrap_difference(a, b, Average::pooled, {});
    CHECK(width(within) < 0.3 * width(between));
    CHECK(within.low > 0.0);
}

TEST_CASE("bootstrap: one participant says nothing, and neither do people who are all the same") {
    const People one{Contribution{2, 3}, Contribution{0, 0}, std::nullopt};
    CHECK(std::isnan(bootstrap_share(one, {}).low));
    CHECK(std::isnan(bootstrap_difference(one, one, Average::pooled, {}).high));
    const People same{Contribution{1, 1}, Contribution{1, 1}};
    CHECK(std::isnan(bootstrap_share(same, {}).low));
    CHECK(std::isnan(bootstrap_difference(same, same, Average::pooled, {}).low));
}

TEST_CASE("bootstrap: people without marks belong to the design and widen the interval of those who mark") {
    People marked = people(10, 4, 0.2, 11);
    const Interval alone = bootstrap_share(marked, {});
    for (int i = 0; i < 10; ++i) marked.emplace_back(Contribution{0, 0});
    const Interval with_silent = bootstrap_share(marked, {});
    CHECK(with_silent.low < alone.high);
    CHECK(width(with_silent) != width(alone));
    const People absent(20);
    CHECK(std::isnan(bootstrap_share(absent, {}).low));
}

TEST_CASE("bootstrap: a difference of means of people's shares counts everybody alike, one of pooled shares does not") {
    // nine people with little to count who find as much under both, and one with much who does not
    People a, b;
    for (int i = 0; i < 9; ++i) {
        a.emplace_back(Contribution{1 + i % 3, 4});
        b.emplace_back(Contribution{1 + (i + 1) % 3, 4});
    }
    a.emplace_back(Contribution{90, 100});
    b.emplace_back(Contribution{20, 100});
    const auto middle = [](const Interval& ci) { return 0.5 * (ci.low + ci.high); };
    const Interval of_people = bootstrap_difference(a, b, Average::people, {4000, 1, 0.95});
    CHECK(middle(of_people) == close_to(0.07).epsilon(0.3));  // 0.7 of one of ten people
    CHECK(middle(bootstrap_difference(a, b, Average::pooled, {4000, 1, 0.95})) > 0.15);
}

TEST_CASE("bootstrap: few people have wider intervals than plain percentiles") {
    // of five people the plain percentiles are about 1.96 sqrt(4/5) = 1.75 standard errors wide, Student's t 2.78
    const People five{Contribution{20, 100}, Contribution{35, 100}, Contribution{50, 100}, Contribution{65, 100},
                      Contribution{80, 100}};
    const double error = std::sqrt((0.09 + 0.0225) * 2.0 / 4.0 / 5.0);
    CHECK(width(bootstrap_share(five, {20000, 1, 0.95})) > 2.0 * 2.2 * error);
}

TEST_CASE("bootstrap: many people, drawn by kinds, have the interval of the normal approximation") {
    const auto all = people(20000, 3, 0.0, 11);
    double mean = 0.0, square = 0.0;
    for (const auto& one : all) {
        const double share = static_cast<double>(one->k) / 3.0;
        mean += share / 20000.0;
        square += share * share / 20000.0;
    }
    const double arm = 1.96 * std::sqrt((square - mean * mean) / 20000.0);
    const Interval ci = bootstrap_share(all, {4000, 1, 0.95});
    // 4,000 resamples: quantiles good to some 3 % of the arm
    CHECK(ci.low == close_to(mean - arm).epsilon(0.1 * arm / mean));
    CHECK(ci.high == close_to(mean + arm).epsilon(0.1 * arm / mean));
    // the same people twice: every difference is 0, which says nothing about others
    CHECK(std::isnan(bootstrap_difference(all, all, Average::pooled, {200, 1, 0.95}).low));
    // other people: the difference has both variances
    const auto others = people(20000, 3, 0.0, 12);
    People a(all), b(20000);
    a.resize(40000);
    b.insert(b.end(), others.begin(), others.end());
    const Interval between = bootstrap_difference(a, b, Average::pooled, {4000, 1, 0.95});
    CHECK(0.5 * (between.high - between.low) == close_to(std::sqrt(2.0) * arm).epsilon(0.1));
}

TEST_CASE("bootstrap: how many resamples put ten of them beyond each limit, more for fewer people") {
    CHECK(resamples_needed(0.95, 1'000'000) == close_to(410.0));  // 10 / 0.025, and a little for Student's t
    CHECK(resamples_needed(0.99, 1'000'000) == close_to(2100.0));
    for (const std::size_t people : {10u, 20u, 50u, 1000u}) CHECK(resamples_needed(0.95, people) <= 2000.0);
    CHECK(resamples_needed(0.999, 12) > 1e6);
    CHECK(resamples_needed(0.999, 12) > resamples_needed(0.999, 50));
}
