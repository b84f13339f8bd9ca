#pragma once
// Medians and spreads that a few wild values do not change.

#include <vector>

namespace palpa::stiffnessmaps {

// Returns the q quantile of the values, one of them (QuantileType::nearest); 0 if there is none.
double quantile(std::vector<double> values, double q);
inline double median(std::vector<double> values) { return quantile(std::move(values), 0.5); }

// Returns 1.4826 times the median distance from the median: the standard deviation of the values, if they are normal
// but for a few.
double robust_deviation(std::vector<double> values);

// Marks single values that stand out from a sequence: farther outside the range of their two neighbours than `limit`. A
// value on a slope, a kink or a step never does.
std::vector<bool> lone_outliers(const std::vector<double>& values, double limit);

// The robust standard deviation of white noise on sequences that are smooth but for kinks, from their fourth
// differences, which vanish on cubics and have sqrt(70) times the noise.
void add_fourth_differences(const std::vector<double>& values, std::vector<double>& differences);
double noise_of_fourth_differences(std::vector<double> differences);

}  // namespace palpa::stiffnessmaps
