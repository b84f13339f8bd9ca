#pragma once
// Medians and spreads that a few wild values do not move.

#include <vector>

namespace palpa::stiffnessmaps {

// Of the finite values the one nearest to the share q (QuantileType::nearest); 0 if there are none.
double quantile(std::vector<double> values, double q);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

// 1.4826 times the median distance from the median: the standard deviation of what is normal among the
// values.
double robust_deviation(std::vector<double> values);

// Values that stand out alone of a sequence: farther outside the range of the two beside them than `limit`. A
// value on a slope, a kink or a step never does.
std::vector<bool> lone_outliers(const std::vector<double>& values, double limit);

// Robust standard deviation of white noise on sequences that are smooth but for kinks, from their fourth
// differences, which vanish on cubics and have sqrt(70) times the noise.
void add_fourth_differences(const std::vector<double>& values, std::vector<double>& differences);
double noise_of_fourth_differences(std::vector<double> differences);

}  // namespace palpa::stiffnessmaps
