#include "study/binomial_draw.h"

#include <cassert>
#include <cmath>

namespace palpa::study {
namespace {

// Counts hits by the geometric gaps between them.
std::int64_t by_gaps(std::int64_t n, double chance, Random& random) {
    const double log_miss = std::log1p(-chance);
    std::int64_t hits = 0;
    for (double at = 0.0;; ++hits) {
        at += std::floor(std::log(1.0 - random.uniform()) / log_miss) + 1.0;
        if (at > static_cast<double>(n)) return hits;
    }
}

// Algorithm BTRS with the paper's letters; needs chance <= 0.5 and n * chance >= 10.
std::int64_t by_rejection(std::int64_t count, double p, Random& random) {
    const auto n = static_cast<double>(count);
    const double spread = std::sqrt(n * p * (1.0 - p));
    const double b = 1.15 + 2.53 * spread;
    const double a = -0.0873 + 0.0248 * b + 0.01 * p;
    const double c = n * p + 0.5;
    const double v_r = 0.92 - 4.2 / b;
    const double alpha = (2.83 + 5.1 / b) * spread;
    const double log_odds = std::log(p / (1.0 - p));
    const double m = std::floor((n + 1.0) * p);
    const double h = std::lgamma(m + 1.0) + std::lgamma(n - m + 1.0);
    while (true) {
        const double u = random.uniform() - 0.5;
        const double v = random.uniform();
        const double us = 0.5 - std::abs(u);
        const double k = std::floor((2.0 * a / us + b) * u + c);
        if (us >= 0.07 && v <= v_r) return static_cast<std::int64_t>(k);
        if (!(k >= 0.0 && k <= n)) continue;
        const double accepted = h - std::lgamma(k + 1.0) - std::lgamma(n - k + 1.0) + (k - m) * log_odds;
        if (std::log(v * alpha / (a / (us * us) + b)) <= accepted) return static_cast<std::int64_t>(k);
    }
}

}  // namespace

std::int64_t binomial_draw(std::int64_t n, double chance, Random& random) {
    assert(n >= 0 && chance >= 0.0 && chance <= 1.0);
    if (chance > 0.5) return n - binomial_draw(n, 1.0 - chance, random);
    constexpr double kFewHits = 10.0;
    if (n == 0 || chance == 0.0) return 0;
    if (static_cast<double>(n) * chance < kFewHits) return by_gaps(n, chance, random);
    return by_rejection(n, chance, random);
}

}  // namespace palpa::study
