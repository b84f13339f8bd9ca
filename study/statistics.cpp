#include "study/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

namespace palpa::study {
namespace {

double square(double x) { return x * x; }

bool possible(const Proportion& x) { return x.n >= 1 && x.k >= 0 && x.k <= x.n; }

double two_sided_p(double z) { return std::erfc(z / std::numbers::sqrt2); }

double log_probability(std::int64_t k, std::int64_t n, double chance) {
    const auto x = static_cast<double>(k);
    const auto m = static_cast<double>(n);
    const double ways = std::lgamma(m + 1.0) - std::lgamma(x + 1.0) - std::lgamma(m - x + 1.0);
    // 0 log 0 is 0 here
    const double hits = k == 0 ? 0.0 : x * std::log(chance);
    const double misses = k == n ? 0.0 : (m - x) * std::log1p(-chance);
    return ways + hits + misses;
}

// Lentz's way through the continued fraction of DLMF 8.17.22, for x below (a + 1)/(a + b + 2).
double beta_fraction(double a, double b, double x) {
    constexpr double kTiny = 1e-300;
    constexpr int kMost = 100000;
    double c = 1.0;
    double d = 1.0 - (a + b) * x / (a + 1.0);
    d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
    double product = d;
    for (int m = 1; m <= kMost; ++m) {
        const double two_m = 2.0 * m;
        const double even = m * (b - m) * x / ((a + two_m - 1.0) * (a + two_m));
        const double odd = -(a + m) * (a + b + m) * x / ((a + two_m) * (a + two_m + 1.0));
        double change = 1.0;
        for (const double term : {even, odd}) {
            d = 1.0 + term * d;
            c = 1.0 + term / c;
            d = 1.0 / (std::abs(d) < kTiny ? kTiny : d);
            if (std::abs(c) < kTiny) c = kTiny;
            change = c * d;
            product *= change;
        }
        if (std::abs(change - 1.0) < 1e-16) break;
    }
    return product;
}

// The least x in [low, high] with not below(x), by bisection to the last bit.
template <class Below>
double bisect(double low, double high, const Below& below) {
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        (below(middle) ? low : high) = middle;
    }
    return high;
}

}  // namespace

double normal_quantile(double p) {
    assert(p > 0.0 && p < 1.0);
    if (p > 0.5) return -normal_quantile(1.0 - p);
    // Abramowitz & Stegun 26.2.23 is good to 5e-4; Halley's steps on erfc do the rest
    const double t = std::sqrt(-2.0 * std::log(p));
    double x = (2.515517 + t * (0.802853 + t * 0.010328)) / (1.0 + t * (1.432788 + t * (0.189269 + t * 0.001308))) - t;
    for (int i = 0; i < 4; ++i) {
        const double density = std::exp(-0.5 * x * x) / std::sqrt(2.0 * std::numbers::pi);
        const double error = (0.5 * std::erfc(-x / std::numbers::sqrt2) - p) / density;
        x -= error / (1.0 + 0.5 * x * error);
    }
    return x;
}

double z_of_level(double level) { return -normal_quantile(0.5 * (1.0 - level)); }

Interval wilson(const Proportion& x, double z) {
    assert(possible(x));
    const auto n = static_cast<double>(x.n);
    const double p = x.p();
    const double scale = 1.0 + z * z / n;
    const double middle = p + z * z / (2.0 * n);
    const double arm = z * std::sqrt(p * (1.0 - p) / n + z * z / (4.0 * n * n));
    return {x.k == 0 ? 0.0 : (middle - arm) / scale, x.k == x.n ? 1.0 : (middle + arm) / scale};
}

Interval newcombe(const Proportion& a, const Proportion& b, double z) {
    const Interval of_a = wilson(a, z);
    const Interval of_b = wilson(b, z);
    const double delta = a.p() - b.p();
    return {delta - std::hypot(a.p() - of_a.low, of_b.high - b.p()),
            delta + std::hypot(of_a.high - a.p(), b.p() - of_b.low)};
}

double combined_interval(const Proportion& a, const Proportion& b, double z) {
    const bool a_lower = a.p() <= b.p();
    const Proportion& lower = a_lower ? a : b;
    const Proportion& upper = a_lower ? b : a;
    return std::hypot(wilson(lower, z).high - lower.p(), wilson(upper, z).low - upper.p());
}

double combined_p(const Proportion& a, const Proportion& b) {
    const double delta = std::abs(a.p() - b.p());
    if (delta == 0.0) return 1.0;
    constexpr double kBeyond = 1e3;  // of such a z, p is 0
    // the interval widens with z
    return two_sided_p(bisect(0.0, kBeyond, [&](double z) { return combined_interval(a, b, z) < delta; }));
}

Interval newcombe_paired(const PairedCounts& counts, double z) {
    const auto n = static_cast<double>(counts.n());
    const Proportion a{counts.both + counts.only_a, counts.n()};
    const Proportion b{counts.both + counts.only_b, counts.n()};
    const auto cell = [](std::int64_t count) { return static_cast<double>(count); };
    double cross = cell(counts.both) * cell(counts.neither) - cell(counts.only_a) * cell(counts.only_b);
    if (cross > 0.0) cross = std::max(0.0, cross - 0.5 * n);
    const double margins = cell(a.k) * cell(a.n - a.k) * cell(b.k) * cell(b.n - b.k);
    const double phi = margins > 0.0 ? cross / std::sqrt(margins) : 0.0;
    const Interval of_a = wilson(a, z);
    const Interval of_b = wilson(b, z);
    const auto arm = [&](double u, double v) { return std::sqrt(std::max(0.0, u * u - 2.0 * phi * u * v + v * v)); };
    const double delta = (cell(counts.only_a) - cell(counts.only_b)) / n;
    return {delta - arm(a.p() - of_a.low, of_b.high - b.p()), delta + arm(of_a.high - a.p(), b.p() - of_b.low)};
}

double mcnemar_p(const PairedCounts& counts) {
    const std::int64_t differ = counts.only_a + counts.only_b;
    return differ == 0 ? 1.0 : exact_binomial_p({counts.only_a, differ}, 0.5);
}

double exact_binomial_p(const Proportion& x, double chance) {
    assert(possible(x) && chance > 0.0 && chance < 1.0);
    const double seen = log_probability(x.k, x.n, chance) + std::log1p(1e-7);
    double sum = 0.0;
    for (std::int64_t k = 0; k <= x.n; ++k) {
        const double log_p = log_probability(k, x.n, chance);
        if (log_p <= seen) sum += std::exp(log_p);
    }
    return std::min(1.0, sum);
}

double incomplete_beta(double a, double b, double x) {
    if (x <= 0.0) return 0.0;
    if (x >= 1.0) return 1.0;
    const double log_front =
        std::lgamma(a + b) - std::lgamma(a) - std::lgamma(b) + a * std::log(x) + b * std::log1p(-x);
    if (x > (a + 1.0) / (a + b + 2.0)) return 1.0 - std::exp(log_front) / b * beta_fraction(b, a, 1.0 - x);
    return std::exp(log_front) / a * beta_fraction(a, b, x);
}

double student_p(double t, double df) {
    if (std::isinf(t)) return 0.0;
    return incomplete_beta(0.5 * df, 0.5, df / (df + t * t));
}

double student_quantile(double level, double df) {
    double high = 1.0;
    while (student_p(high, df) > 1.0 - level) high *= 2.0;
    return bisect(0.0, high, [&](double t) { return student_p(t, df) > 1.0 - level; });
}

TTest t_test(std::span<const double> values, double chance, double level) {
    assert(values.size() >= 2);
    const auto n = static_cast<double>(values.size());
    TTest test;
    test.df = n - 1.0;
    test.mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0.0;
    for (const double value : values) squares += square(value - test.mean);
    const double error = std::sqrt(squares / test.df / n);
    const double off = test.mean - chance;
    test.t = off == 0.0 ? 0.0 : off / error;  // all alike: infinite
    test.p = student_p(test.t, test.df);
    const double arm = student_quantile(level, test.df) * error;
    test.ci = {test.mean - arm, test.mean + arm};
    return test;
}

std::vector<double> holm(std::span<const double> p) {
    std::vector<std::size_t> order(p.size());
    std::iota(order.begin(), order.end(), std::size_t{0});
    std::stable_sort(order.begin(), order.end(), [&](std::size_t i, std::size_t j) { return p[i] < p[j]; });
    std::vector<double> adjusted(p.size());
    double greatest = 0.0;
    for (std::size_t rank = 0; rank < order.size(); ++rank) {
        greatest = std::max(greatest, static_cast<double>(p.size() - rank) * p[order[rank]]);
        adjusted[order[rank]] = std::min(1.0, greatest);
    }
    return adjusted;
}

}  // namespace palpa::study
