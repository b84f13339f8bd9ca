#include <cmath>
#include <doctest/doctest.h>
#include <numeric>
#include <vector>

#include "study/permutation.h"
#include "study/random.h"
#include "tests/close_to.h"

using namespace palpa::study;
using namespace palpa::test;

namespace {

// Counts all 2^n signs one by one.
double by_counting_signs(const std::vector<double>& d) {
    const double seen = std::abs(std::accumulate(d.begin(), d.end(), 0.0));
    int as_far = 0;
    for (unsigned signs = 0; signs < 1u << d.size(); ++signs) {
        double sum = 0.0;
        for (std::size_t i = 0; i < d.size(); ++i) sum += (signs >> i) & 1 ? d[i] : -d[i];
        as_far += std::abs(sum) >= seen - 1e-9;
    }
    return as_far / std::exp2(static_cast<double>(d.size()));
}

// Counts all ways to choose the first group one by one.
double by_counting_groups(const std::vector<double>& a, const std::vector<double>& b) {
    std::vector<double> all = a;
    all.insert(all.end(), b.begin(), b.end());
    const double mean = std::accumulate(all.begin(), all.end(), 0.0) / static_cast<double>(all.size());
    const auto in_a = static_cast<double>(a.size());
    const double seen = std::abs(std::accumulate(a.begin(), a.end(), 0.0) - in_a * mean);
    int as_far = 0, ways = 0;
    for (unsigned chosen = 0; chosen < 1u << all.size(); ++chosen) {
        double sum = 0.0, n = 0.0;
        for (std::size_t i = 0; i < all.size(); ++i) {
            if (!((chosen >> i) & 1)) continue;
            sum += all[i];
            ++n;
        }
        if (n != in_a) continue;
        ++ways;
        as_far += std::abs(sum - in_a * mean) >= seen - 1e-9;
    }
    return static_cast<double>(as_far) / ways;
}

}  // namespace

TEST_CASE("permutation: signs and groups as counted one by one, with many ties") {
    constexpr std::uint64_t kSeed = 31;
    CAPTURE(kSeed);
    Random random(kSeed);
    for (int round = 0; round < 60; ++round) {
        CAPTURE(round);
        std::vector<double> a, b;
        for (std::uint32_t i = 0; i < 2 + random.below(5); ++i) a.push_back(random.below(7) / 3.0 - 1.0);
        for (std::uint32_t i = 0; i < 2 + random.below(5); ++i) b.push_back(random.below(7) / 3.0 - 1.0);
        CHECK(sign_permutation(a, 1).p == close_to(by_counting_signs(a)).epsilon(1e-12));
        CHECK(group_permutation(a, b, 1).p == close_to(by_counting_groups(a, b)).epsilon(1e-12));
    }
}

TEST_CASE("permutation: known answers, and the least p that few people can reach") {
    const std::vector<double> same(5, 0.5), none(5, 0.0);
    CHECK(sign_permutation(same, 1).p == close_to(2.0 / 32.0));
    CHECK(sign_permutation(none, 1).p == 1.0);
    const std::vector<double> low{0.0, 0.1, 0.2}, high{0.8, 0.9, 1.0};
    CHECK(group_permutation(low, high, 1).p == close_to(2.0 / 20.0));
    CHECK(group_permutation(same, same, 1).p == 1.0);
}

TEST_CASE("permutation: above the people that can be counted, drawn exchanges come close to Student's t") {
    constexpr std::uint64_t kSeed = 32;
    CAPTURE(kSeed);
    Random random(kSeed);
    std::vector<double> d;
    for (int i = 0; i < 2 * kMostExactPeople; ++i) d.push_back(0.2 + random.normal());
    const Permutation drawn = sign_permutation(d, 1);
    CHECK_FALSE(drawn.exact);
    const std::vector<double> part(d.begin(), d.begin() + kMostExactPeople);
    CHECK(sign_permutation(part, 1).exact);
    const std::vector<double> half(d.begin() + kMostExactPeople, d.end());
    const Permutation groups = group_permutation(part, half, 1);
    CHECK_FALSE(groups.exact);
    // the normal approximation, within 4 standard errors of the draws and its own error
    const double sum = std::accumulate(d.begin(), d.end(), 0.0);
    const double squares = std::inner_product(d.begin(), d.end(), d.begin(), 0.0);
    CHECK(std::abs(drawn.p - std::erfc(std::abs(sum) / std::sqrt(2.0 * squares))) < 0.02);
}

TEST_CASE("permutation: signs of very many people with few values come close to the normal approximation") {
    constexpr std::uint64_t kSeed = 33;
    CAPTURE(kSeed);
    Random random(kSeed);
    std::vector<double> d;
    for (int i = 0; i < 20000; ++i) d.push_back((static_cast<double>(random.below(7)) - 3.0) / 3.0);
    const double squares = std::inner_product(d.begin(), d.end(), d.begin(), 0.0);
    for (const double z : {0.5, 1.0, 2.0}) {  // the sum is brought there by people who differ by 1
        CAPTURE(z);
        std::vector<double> moved = d;
        double sum = std::accumulate(d.begin(), d.end(), 0.0);
        for (double& one : moved) {
            if (std::abs(sum - z * std::sqrt(squares)) < 1.0) break;
            const bool up = sum < z * std::sqrt(squares);
            if (one != (up ? -1.0 : 1.0)) continue;
            one = -one;
            sum += 2.0 * one;
        }
        // 4 standard errors of the draws, and the steps of the sum
        CHECK(std::abs(sign_permutation(moved, 1).p - std::erfc(std::abs(sum) / std::sqrt(2.0 * squares))) < 0.02);
    }
}
