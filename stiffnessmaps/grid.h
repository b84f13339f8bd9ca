#pragma once
// Operations on a row-major grid of n_y rows of n_x cells; NaN = missing.

#include <cstddef>
#include <limits>
#include <vector>

namespace palpa::stiffnessmaps {

inline constexpr double kMissing = std::numeric_limits<double>::quiet_NaN();

struct GridShape {
    std::size_t n_x = 0;
    std::size_t n_y = 0;
    double dx_m = 1.0;
    double dy_m = 1.0;
    std::size_t size() const { return n_x * n_y; }
};

// Gaussian smoothing, normalised over the cells that are not missing; missing cells stay missing. With sigma 0, returns
// a copy.
std::vector<double> smooth(const std::vector<double>& values, const GridShape& shape, double sigma_m);

// Replaces every missing cell by the mean of its neighbours, from the measured cells outwards. A grid without any value
// stays as it is.
void fill_missing(std::vector<double>& values, const GridShape& shape);

// Central differences per metre, one-sided at the borders, 0 along an axis of one cell.
struct Gradient {
    std::vector<double> x;
    std::vector<double> y;
};
Gradient gradient(const std::vector<double>& values, const GridShape& shape);

// Replaces the values by the least-squares non-decreasing sequence (pool adjacent violators; Barlow et al. 1972).
void make_isotonic(std::vector<double>& values);

}  // namespace palpa::stiffnessmaps
