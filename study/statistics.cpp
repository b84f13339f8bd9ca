#include "study/statistics.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <numbers>
#include <numeric>

#include "files/distributions.h"

namespace palpa::study {
namespace {

double square(double x) { return x * x; }

bool possible(const Proportion& x) { return x.n >= 1 && x.k >= 0 && x.k <= x.n; }

double two_sided_p(double z) { return std::erfc(z / std::numbers::sqrt2); }

// Returns the least x in [low, high] for which below(x) is false, by bisection to the last bit.
template <class Below>
double bisect(double low, double high, const Below& below) {
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        if (middle <= low || middle >= high) break;
        (below(middle) ? low : high) = middle;
    }
    return high;
}

// Returns the least k in [low, high] for which holds(k) is true, high + 1 if there is none. holds() must be false up to a
// k and true from then on.
template <class Holds>
std::int64_t first_that(std::int64_t low, std::int64_t high, const Holds& holds) {
    for (++high; low < high;) {
        const std::int64_t middle = low + (high - low) / 2;
        if (holds(middle)) {
            high = middle;
        } else {
            low = middle + 1;
        }
    }
    return low;
}

// The probability of all counts of n that are at most as likely as `seen`: those below the mode and those above it, since
// the probability rises up to the mode and falls from there.
double two_tails(std::int64_t n, double chance, double seen) {
    const auto probability = [&](std::int64_t k) { return files::binomial_probability(k, n, chance); };
    const auto mode = std::min(n, static_cast<std::int64_t>(static_cast<double>(n + 1) * chance));
    if (probability(mode) <= seen) return 1.0;
    const std::int64_t below = first_that(0, mode, [&](std::int64_t k) { return probability(k) > seen; }) - 1;
    const std::int64_t above = first_that(mode, n, [&](std::int64_t k) { return probability(k) <= seen; });
    const double low = below < 0 ? 0.0 : files::binomial_at_most(below, n, chance);
    const double high = above > n ? 0.0 : files::binomial_at_most(n - above, n, 1.0 - chance);
    return std::min(1.0, low + high);
}

// Student's t test from the number of values, their mean and the sum of their squared deviations.
TTest t_of_squares(double n, double mean, double squares, double chance, double level) {
    TTest test;
    test.df = n - 1.0;
    test.mean = mean;
    if (squares <= 1e-24 * n * square(mean)) {  // rounding of equal values
        constexpr double kNotKnown = std::numeric_limits<double>::quiet_NaN();
        test.t = test.p = kNotKnown;
        test.ci = {kNotKnown, kNotKnown};
        return test;
    }
    const double error = std::sqrt(squares / test.df / n);
    test.t = (mean - chance) / error;
    test.p = files::student_p(test.t, test.df);
    const double arm = files::student_quantile(level, test.df) * error;
    test.ci = {mean - arm, mean + arm};
    return test;
}

}  // namespace

double z_of_level(double level) { return -files::normal_quantile(0.5 * (1.0 - level)); }

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
    constexpr double kBeyond = 1e3;  // z for which p is 0
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
    const double seen = files::binomial_probability(x.k, x.n, chance) * (1.0 + 1e-7);
    constexpr std::int64_t kMostSummed = 10'000;
    if (x.n > kMostSummed) return two_tails(x.n, chance, seen);
    double sum = 0.0;
    for (std::int64_t k = 0; k <= x.n; ++k) {
        const double p = files::binomial_probability(k, x.n, chance);
        if (p <= seen) sum += p;
    }
    return std::min(1.0, sum);
}

TTest t_test(std::span<const double> values, double chance, double level) {
    assert(values.size() >= 2);
    const auto n = static_cast<double>(values.size());
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / n;
    double squares = 0.0;
    for (const double value : values) squares += square(value - mean);
    return t_of_squares(n, mean, squares, chance, level);
}

TTest t_test_of_answers(const Proportion& x, double chance, double level) {
    assert(possible(x) && x.n >= 2);
    const auto n = static_cast<double>(x.n);
    return t_of_squares(n, x.p(), n * x.p() * (1.0 - x.p()), chance, level);
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
