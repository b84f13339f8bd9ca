#pragma once
// Quantiles of a few values or many, by one named definition.

#include <span>
#include <vector>

namespace palpa::files {

// Hyndman and Fan's type 7 (The American Statistician 50 (1996) 361), the default of numpy and R: linear between the
// values in rising order, the least at share 0, the greatest at share 1, the mean of the middle two at one half of an even
// number. Values that are not finite have no order and are left out; NaN if none is left.
double quantile(std::vector<double> values, double share);
double median(std::vector<double> values);

// The same of finite values in rising order, one at least, without a copy.
double sorted_quantile(std::span<const double> sorted, double share);

}  // namespace palpa::files
