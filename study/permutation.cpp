#include "study/permutation.h"

#include <algorithm>
#include <bit>
#include <cassert>
#include <cmath>
#include <cstdint>
#include <map>
#include <numeric>
#include <utility>

#include "study/binomial_draw.h"
#include "study/random.h"

namespace palpa::study {
namespace {

// Sums of the subsets of some values, in ascending order, by the number of values in the subset.
using SubsetSums = std::vector<std::vector<double>>;

SubsetSums subset_sums(std::span<const double> values) {
    SubsetSums sums(values.size() + 1);
    std::vector<double> all{0.0};
    for (const double value : values) {
        const std::size_t half = all.size();
        for (std::size_t i = 0; i < half; ++i) all.push_back(all[i] + value);
    }
    // bit j of an index tells whether value j is in the subset
    for (std::size_t i = 0; i < all.size(); ++i) sums[static_cast<std::size_t>(std::popcount(i))].push_back(all[i]);
    for (auto& of_size : sums) std::sort(of_size.begin(), of_size.end());
    return sums;
}

// Returns how many pairs, one of each list, have a sum that is at least `far` or at most `near_end`.
double count_outside(const std::vector<double>& a, const std::vector<double>& b, double near_end, double far) {
    double count = 0.0;
    std::size_t low = b.size(), high = b.size();  // b[high...] reach `far`, b[0 ... low) stay at `near_end`
    for (const double x : a) {
        while (high > 0 && x + b[high - 1] >= far) --high;
        while (low > 0 && x + b[low - 1] > near_end) --low;
        count += static_cast<double>(b.size() - std::max(high, low)) + static_cast<double>(low);
    }
    return count;
}

double scale_of(std::span<const double> values) {
    double scale = 0.0;
    for (const double value : values) scale += std::abs(value);
    return scale;
}

// How many values there are of each size. Empty unless there are very many values of few sizes, whose signs are then drawn
// by one binomial draw for each size, with the same distribution of the sum.
std::vector<std::pair<double, std::int64_t>> kinds_of(std::span<const double> values) {
    constexpr std::size_t kMany = 2000, kAlike = 20;
    if (values.size() < kMany) return {};
    std::map<double, std::int64_t> kinds;
    for (const double value : values) ++kinds[value];
    if (kAlike * kinds.size() >= values.size()) return {};
    return {kinds.begin(), kinds.end()};
}

// Rounding must not split ties.
double rounding(double scale) { return 1e-10 * scale; }

}  // namespace

Permutation sign_permutation(std::span<const double> differences, std::uint64_t seed) {
    assert(!differences.empty());
    const double scale = scale_of(differences);
    std::vector<double> values;  // those that are 0 change nothing
    for (const double d : differences) {
        if (std::abs(d) > rounding(scale)) values.push_back(std::abs(d));
    }
    const double seen = std::abs(std::accumulate(differences.begin(), differences.end(), 0.0)) - rounding(scale);
    if (values.empty() || seen <= 0.0) return {};
    if (values.size() <= static_cast<std::size_t>(kMostExactPeople)) {
        // the sum with signs is 2 (sum of the positive ones) - scale
        const std::span<const double> all(values);
        const auto flat = [](const SubsetSums& by_size) {
            std::vector<double> out;
            for (const auto& of_size : by_size) out.insert(out.end(), of_size.begin(), of_size.end());
            std::sort(out.begin(), out.end());
            return out;
        };
        const auto first = flat(subset_sums(all.first(all.size() / 2)));
        const auto second = flat(subset_sums(all.subspan(all.size() / 2)));
        const double count = count_outside(first, second, 0.5 * (scale - seen), 0.5 * (scale + seen));
        return {count / std::exp2(static_cast<double>(values.size())), true};
    }
    const auto kinds = kinds_of(values);
    Random random(seed);
    int as_far = 0;
    for (int r = 0; r < kExchanges; ++r) {
        double sum = 0.0;
        for (const auto& [value, number] : kinds)
            sum += value * static_cast<double>(2 * binomial_draw(number, 0.5, random) - number);
        std::uint64_t signs = 0;
        for (std::size_t i = 0; i < values.size() && kinds.empty(); ++i) {
            if (i % 64 == 0) signs = random.bits();
            sum += (signs >> (i % 64)) & 1 ? values[i] : -values[i];
        }
        as_far += std::abs(sum) >= seen;
    }
    return {(1.0 + as_far) / (1.0 + kExchanges), false};
}

Permutation group_permutation(std::span<const double> a, std::span<const double> b, std::uint64_t seed) {
    assert(!a.empty() && !b.empty());
    std::vector<double> values(a.begin(), a.end());
    values.insert(values.end(), b.begin(), b.end());
    // with the mean taken off, the difference of the groups' means is in proportion to the first group's sum
    const double mean = std::accumulate(values.begin(), values.end(), 0.0) / static_cast<double>(values.size());
    for (double& value : values) value -= mean;
    const double scale = scale_of(values);
    const auto in_a = static_cast<std::ptrdiff_t>(a.size());
    const double seen = std::abs(std::accumulate(values.begin(), values.begin() + in_a, 0.0)) - rounding(scale);
    if (seen <= 0.0) return {};
    if (values.size() <= static_cast<std::size_t>(kMostExactPeople)) {
        const std::span<const double> all(values);
        const SubsetSums first = subset_sums(all.first(all.size() / 2));
        const SubsetSums second = subset_sums(all.subspan(all.size() / 2));
        double as_far = 0.0, exchanges = 0.0;
        for (std::size_t size = 0; size < first.size() && size <= a.size(); ++size) {
            if (a.size() - size >= second.size()) continue;
            const auto& rest = second[a.size() - size];
            as_far += count_outside(first[size], rest, -seen, seen);
            exchanges += static_cast<double>(first[size].size()) * static_cast<double>(rest.size());
        }
        return {as_far / exchanges, true};
    }
    Random random(seed);
    int as_far = 0;
    for (int r = 0; r < kExchanges; ++r) {
        random.shuffle(values);
        as_far += std::abs(std::accumulate(values.begin(), values.begin() + in_a, 0.0)) >= seen;
    }
    return {(1.0 + as_far) / (1.0 + kExchanges), false};
}

}  // namespace palpa::study
