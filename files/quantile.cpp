#include "files/quantile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace palpa::files {
namespace {

// The index of the value just below the quantile, and the share of the way from that value to the next.
struct Rank {
    std::size_t below = 0;
    double rest = 0.0;
};

Rank rank_of(std::size_t n, double share, QuantileType type) {
    assert(n > 0 && share >= 0.0 && share <= 1.0);
    const double at = share * static_cast<double>(n - 1);
    const auto floor = [](double rank) { return static_cast<std::size_t>(rank); };
    switch (type) {
        case QuantileType::between:
            return {floor(at), at - std::floor(at)};
        case QuantileType::nearest:
            return {floor(at + 0.5)};
        case QuantileType::lower:
            return {floor(at)};
        case QuantileType::reached:
            return {floor(std::max(1.0, std::ceil(share * static_cast<double>(n)))) - 1};
    }
    return {};
}

}  // namespace

double sorted_quantile(std::span<const double> sorted, double share, QuantileType type) {
    const Rank rank = rank_of(sorted.size(), share, type);
    const double value = sorted[rank.below];
    return rank.rest > 0.0 ? value + rank.rest * (sorted[rank.below + 1] - value) : value;
}

double reordered_quantile(std::span<double> values, double share, QuantileType type) {
    const Rank rank = rank_of(values.size(), share, type);
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(rank.below);
    std::nth_element(values.begin(), at, values.end());
    return rank.rest > 0.0 ? *at + rank.rest * (*std::min_element(at + 1, values.end()) - *at) : *at;
}

double quantile(std::vector<double> values, double share, QuantileType type) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    return values.empty() ? std::numeric_limits<double>::quiet_NaN() : reordered_quantile(values, share, type);
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

double upper_median(std::vector<double> values) { return quantile(std::move(values), 0.5, QuantileType::nearest); }

}  // namespace palpa::files
