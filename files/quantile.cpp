#include "files/quantile.h"

#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>

namespace palpa::files {

double sorted_quantile(std::span<const double> sorted, double share) {
    assert(!sorted.empty() && share >= 0.0 && share <= 1.0);
    const double at = share * static_cast<double>(sorted.size() - 1);
    const auto below = static_cast<std::size_t>(at);
    const std::size_t above = std::min(below + 1, sorted.size() - 1);
    return sorted[below] + (at - static_cast<double>(below)) * (sorted[above] - sorted[below]);
}

double quantile(std::vector<double> values, double share) {
    std::erase_if(values, [](double v) { return !std::isfinite(v); });
    if (values.empty()) return std::numeric_limits<double>::quiet_NaN();
    std::sort(values.begin(), values.end());
    return sorted_quantile(values, share);
}

double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

}  // namespace palpa::files
