#pragma once
// Quantiles by named definitions.

#include <span>
#include <vector>

namespace palpa::files {

// Which of n values in ascending order, numbered from 0, is the quantile of a share p. Brackets hold the name of the
// definition in numpy's quantile(), and its type by Hyndman and Fan (The American Statistician 50 (1996) 361).
enum class QuantileType {
    between,  // at p (n - 1), linear between two values ("linear", type 7: the default of numpy and R)
    nearest,  // the value nearest to p (n - 1), the upper of two equally near: a median is the upper of the middle two
    lower,    // the last value at or below p (n - 1) ("lower")
    reached   // the first value that at least a share p of all do not exceed ("inverted_cdf", type 1)
};

// Returns the quantile of the finite values; NaN if there is none.
double quantile(std::vector<double> values, double share, QuantileType type = QuantileType::between);
double median(std::vector<double> values);        // the mean of the middle two of an even number
double upper_median(std::vector<double> values);  // the upper of the middle two, so one of the values

// The same without a copy, for at least one value, all finite: sorted_quantile() needs them in ascending order, and
// reordered_quantile() changes their order.
double sorted_quantile(std::span<const double> sorted, double share, QuantileType type = QuantileType::between);
double reordered_quantile(std::span<double> values, double share, QuantileType type = QuantileType::between);

}  // namespace palpa::files
