#pragma once
// Quantiles of a few values or many, by definitions that have names.

#include <span>
#include <vector>

namespace palpa::files {

// Which of n values in rising order, numbered from 0, is the quantile of a share p. In brackets the name that numpy's
// quantile() has for it, and the type of Hyndman and Fan (The American Statistician 50 (1996) 361).
enum class QuantileType {
    between,  // at p (n - 1), linear between two values ("linear", type 7: the default of numpy and R)
    nearest,  // the value nearest to p (n - 1), the upper of two equally near: a median is the upper of the middle two
    lower,    // the last value at or below p (n - 1) ("lower")
    reached   // the first value that a share p of all does not exceed ("inverted_cdf", type 1)
};

// Of the values that are finite: others have no order. NaN if none is.
double quantile(std::vector<double> values, double share, QuantileType type = QuantileType::between);
double median(std::vector<double> values);        // the mean of the middle two of an even number
double upper_median(std::vector<double> values);  // the upper of them: one of the values

// The same of finite values, one at least, without a copy: in rising order, or in any order and in another one afterwards.
double sorted_quantile(std::span<const double> sorted, double share, QuantileType type = QuantileType::between);
double reordered_quantile(std::span<double> values, double share, QuantileType type = QuantileType::between);

}  // namespace palpa::files
