#include <cmath>
#include <doctest/doctest.h>
#include <vector>

#include "files/distributions.h"
#include "study/binomial_draw.h"

using namespace palpa::study;

TEST_CASE("binomial draw: counts come as often as the distribution says") {
    constexpr std::uint64_t kSeed = 17;
    CAPTURE(kSeed);
    Random random(kSeed);
    constexpr int kDraws = 100'000;
    for (const std::pair<int, double>& one : {std::pair{20, 0.1}, {60, 0.3}, {400, 0.05}, {400, 0.7}, {5000, 0.5}}) {
        const int n = one.first;
        const double chance = one.second;
        CAPTURE(n);
        CAPTURE(chance);
        std::vector<int> times(static_cast<std::size_t>(n) + 1);
        for (int i = 0; i < kDraws; ++i) ++times[static_cast<std::size_t>(binomial_draw(n, chance, random))];
        double chi2 = 0.0;
        int cells = 0;
        for (int k = 0; k <= n; ++k) {
            const double expected = kDraws * palpa::files::binomial_probability(k, n, chance);
            if (expected < 10.0) continue;
            const double off = times[static_cast<std::size_t>(k)] - expected;
            chi2 += off * off / expected;
            ++cells;
        }
        CAPTURE(chi2);
        CAPTURE(cells);
        CHECK(std::abs(chi2 - cells) < 4.5 * std::sqrt(2.0 * cells));  // of its mean, in standard deviations
    }
    CHECK(binomial_draw(50, 0.0, random) == 0);
    CHECK(binomial_draw(50, 1.0, random) == 50);
    CHECK(binomial_draw(0, 0.5, random) == 0);
}
