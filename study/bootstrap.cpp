#include "study/bootstrap.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "files/distributions.h"
#include "files/quantile.h"
#include "study/random.h"

namespace palpa::study {
namespace {

constexpr Interval kUnknown{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

// Sums of doubles: the counts are below 2^53, and are converted once.
struct Sums {
    double k = 0.0, n = 0.0;
    void operator+=(const Sums& other) {
        k += other.k;
        n += other.n;
    }
    double share() const { return k / n; }
};

Sums sums_of(const std::optional<Contribution>& one) {
    return one ? Sums{static_cast<double>(one->k), static_cast<double>(one->n)} : Sums{};
}

// Returns how many have something to count.
std::size_t counted(const People& people) {
    return static_cast<std::size_t>(
        std::count_if(people.begin(), people.end(), [](const auto& one) { return one && one->n > 0; }));
}

// Efron's acceleration of a share: how skewed the people are, from e_i = k_i - share n_i.
double acceleration(const std::vector<Sums>& people) {
    Sums all;
    for (const Sums& one : people) all += one;
    double squares = 0.0, cubes = 0.0;
    for (const Sums& one : people) {
        const double e = one.k - all.share() * one.n;
        squares += e * e;
        cubes += e * e * e;
    }
    return squares > 0.0 ? cubes / (6.0 * std::pow(squares, 1.5)) : 0.0;
}

Interval limits(std::vector<double>& values, std::size_t people, std::size_t strata, double skew, double level) {
    if (values.empty() || people <= strata) return kUnknown;
    std::sort(values.begin(), values.end());
    constexpr double kRounding = 1e-12;
    if (values.back() - values.front() < kRounding) return kUnknown;
    const auto m = static_cast<double>(people), df = static_cast<double>(people - strata);
    const double z = files::student_quantile(level, df) * std::sqrt(m / df);
    constexpr double kMostSkew = 0.5;  // far from 1, where a limit would run away; reached below four people only
    const double az = std::clamp(skew * z, -kMostSkew, kMostSkew);
    return {files::sorted_quantile(values, files::normal_probability(-z / (1.0 + az))),
            files::sorted_quantile(values, files::normal_probability(z / (1.0 - az)))};
}

}  // namespace

Interval bootstrap_share(const People& people, const BootstrapOptions& options) {
    if (counted(people) < 2) return kUnknown;
    std::vector<Sums> in;
    for (const auto& one : people) {
        if (one) in.push_back(sums_of(one));
    }
    Random random(options.seed);
    std::vector<double> values;
    for (int r = 0; r < options.resamples; ++r) {
        Sums sums;
        for (std::size_t i = 0; i < in.size(); ++i) sums += in[random.below(static_cast<std::uint32_t>(in.size()))];
        if (sums.n > 0.0) values.push_back(sums.share());
    }
    return limits(values, in.size(), 1, acceleration(in), options.level);
}

Interval bootstrap_difference(const People& a, const People& b, const BootstrapOptions& options) {
    assert(a.size() == b.size());
    if (counted(a) < 2 || counted(b) < 2) return kUnknown;
    struct Pair {
        Sums a, b;
    };
    std::array<std::vector<Pair>, 3> strata;  // both, only a, only b
    std::size_t people = 0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (!a[i] && !b[i]) continue;
        strata[!b[i] ? 1 : !a[i] ? 2 : 0].push_back({sums_of(a[i]), sums_of(b[i])});
        ++people;
    }
    const auto used = std::count_if(strata.begin(), strata.end(), [](const auto& one) { return !one.empty(); });
    Random random(options.seed);
    std::vector<double> values;
    for (int r = 0; r < options.resamples; ++r) {
        Sums of_a, of_b;
        for (const auto& stratum : strata) {
            for (std::size_t i = 0; i < stratum.size(); ++i) {
                const Pair& one = stratum[random.below(static_cast<std::uint32_t>(stratum.size()))];
                of_a += one.a;
                of_b += one.b;
            }
        }
        if (of_a.n > 0.0 && of_b.n > 0.0) values.push_back(of_a.share() - of_b.share());
    }
    return limits(values, people, static_cast<std::size_t>(used), 0.0, options.level);
}

}  // namespace palpa::study
