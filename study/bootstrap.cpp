#include "study/bootstrap.h"

#include <algorithm>
#include <array>
#include <cassert>
#include <cmath>
#include <limits>

#include "files/quantile.h"
#include "study/random.h"

namespace palpa::study {
namespace {

constexpr Interval kUnknown{std::numeric_limits<double>::quiet_NaN(), std::numeric_limits<double>::quiet_NaN()};

double share(double k, double n) { return k / n; }

Interval percentiles(std::vector<double>& values, double level) {
    if (values.empty()) return kUnknown;
    std::sort(values.begin(), values.end());
    const double tail = 0.5 * (1.0 - level);
    return {files::sorted_quantile(values, tail), files::sorted_quantile(values, 1.0 - tail)};
}

}  // namespace

Interval bootstrap_share(std::span<const Contribution> people, const BootstrapOptions& options) {
    std::vector<Contribution> in;
    for (const Contribution& one : people) {
        if (one.n > 0) in.push_back(one);
    }
    if (in.size() < 2) return kUnknown;
    Random random(options.seed);
    std::vector<double> values;
    for (int r = 0; r < options.resamples; ++r) {
        double k = 0.0, n = 0.0;
        for (std::size_t i = 0; i < in.size(); ++i) {
            const Contribution& one = in[random.below(static_cast<std::uint32_t>(in.size()))];
            k += static_cast<double>(one.k);
            n += static_cast<double>(one.n);
        }
        values.push_back(share(k, n));
    }
    return percentiles(values, options.level);
}

Interval bootstrap_difference(std::span<const Contribution> a, std::span<const Contribution> b,
                              const BootstrapOptions& options) {
    assert(a.size() == b.size());
    std::array<std::vector<std::size_t>, 3> strata;  // both, only a, only b
    for (std::size_t i = 0; i < a.size(); ++i) {
        if (a[i].n > 0 && b[i].n > 0) strata[0].push_back(i);
        if (a[i].n > 0 && b[i].n == 0) strata[1].push_back(i);
        if (a[i].n == 0 && b[i].n > 0) strata[2].push_back(i);
    }
    if (strata[0].size() + strata[1].size() < 2 || strata[0].size() + strata[2].size() < 2) return kUnknown;
    Random random(options.seed);
    std::vector<double> values;
    for (int r = 0; r < options.resamples; ++r) {
        double k_a = 0.0, n_a = 0.0, k_b = 0.0, n_b = 0.0;
        for (const auto& stratum : strata) {
            for (std::size_t i = 0; i < stratum.size(); ++i) {
                const std::size_t one = stratum[random.below(static_cast<std::uint32_t>(stratum.size()))];
                k_a += static_cast<double>(a[one].k);
                n_a += static_cast<double>(a[one].n);
                k_b += static_cast<double>(b[one].k);
                n_b += static_cast<double>(b[one].n);
            }
        }
        values.push_back(share(k_a, n_a) - share(k_b, n_b));
    }
    return percentiles(values, options.level);
}

}  // namespace palpa::study
