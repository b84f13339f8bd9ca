#include <algorithm>
#include <cmath>
#include <doctest/doctest.h>

#include "study/bootstrap.h"
#include "study/random.h"

using namespace palpa;
using namespace palpa::study;

namespace {

std::vector<Contribution> people(int n, int items, double spread, std::uint64_t seed) {
    Random random(seed);
    std::vector<Contribution> out;
    for (int i = 0; i < n; ++i) {
        const double p = std::clamp(0.6 + spread * random.normal(), 0.0, 1.0);
        Contribution one{0, items};
        for (int k = 0; k < items; ++k) one.k += random.uniform() < p ? 1 : 0;
        out.push_back(one);
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
    for (const Contribution& one : all) {
        const double share = static_cast<double>(one.k) / 3.0;
        mean += share / 400.0;
        square += share * share / 400.0;
    }
    const double error = std::sqrt((square - mean * mean) / 400.0);
    // 4,000 resamples: quantiles good to some 3 % of the error
    CHECK(width(bootstrap_share(all, {4000, 1, 0.95})) == doctest::Approx(2.0 * 1.96 * error).epsilon(0.06));
}

TEST_CASE("bootstrap: clusters widen, pairs narrow") {
    const auto clustered = people(20, 30, 0.35, 9);
    std::int64_t k = 0;
    for (const Contribution& one : clustered) k += one.k;
    CHECK(width(bootstrap_share(clustered, {})) > 1.5 * width(wilson({k, 600}, z_of_level(0.95))));

    auto better = clustered;
    for (Contribution& one : better) one.k = std::min<std::int64_t>(one.n, one.k + 3);
    const Interval within = bootstrap_difference(better, clustered, {});
    std::vector<Contribution> a(better), b(20);
    a.resize(40);
    b.insert(b.end(), clustered.begin(), clustered.end());
    const Interval between = bootstrap_difference(a, b, {});
    CHECK(width(within) < 0.3 * width(between));
    CHECK(within.low > 0.0);
}

TEST_CASE("bootstrap: one participant says nothing") {
    const Contribution one[] = {{2, 3}, {0, 0}};
    CHECK(std::isnan(bootstrap_share(one, {}).low));
    CHECK(std::isnan(bootstrap_difference(one, one, {}).high));
}

TEST_CASE("bootstrap: many people, drawn by kinds, have the interval of the normal approximation") {
    const auto all = people(20000, 3, 0.0, 11);
    double mean = 0.0, square = 0.0;
    for (const Contribution& one : all) {
        const double share = static_cast<double>(one.k) / 3.0;
        mean += share / 20000.0;
        square += share * share / 20000.0;
    }
    const double arm = 1.96 * std::sqrt((square - mean * mean) / 20000.0);
    const Interval ci = bootstrap_share(all, {4000, 1, 0.95});
    // 4,000 resamples: quantiles good to some 3 % of the arm
    CHECK(ci.low == doctest::Approx(mean - arm).epsilon(0.1 * arm / mean));
    CHECK(ci.high == doctest::Approx(mean + arm).epsilon(0.1 * arm / mean));
    // the same people twice: every difference is 0
    const Interval none = bootstrap_difference(all, all, {200, 1, 0.95});
    CHECK(none.low == 0.0);
    CHECK(none.high == 0.0);
}
