#pragma once
// How noisy a map is, and how much smoothing the avatar's laws need because of it.

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

// Returns the standard deviation of white noise in the normal force, N: the map's own noise_N, or else the estimate.
double normal_noise_N(const Map& map);
// Returns whether that is known: an estimate needs 8 second differences of neighbours. Otherwise it counts as 0.
bool knows_noise(const Map& map);

// Estimates it from second differences along x and y (median absolute value / (0.6745 sqrt(6)), robust against the
// edges of nodules). Returns 0 if the map is too small.
double estimated_noise_N(const Map& map);

// Returns the smallest Gaussian sigma (m) for which noise of `noise_N` leaves sd(df) <= gate_N / 3 in the energy force:
//   sd(df) = s_ref s_E sqrt(3 dx dy / (16 pi)) / sigma^3,  s_E = noise sqrt(sum of squared trapezoid weights)
// Valid where sigma is larger than the pitch; 0 for a map without noise.
double smoothing_sigma_m(const Map& map, double noise_N, double reference_m, double gate_N);

// Returns the sigma of a scene that does not set one: the sigma above for recordings, 0 for simulated and analytic
// maps.
double default_smoothing_m(const Map& map, double noise_N, double reference_m, double gate_N);

// Returns the error of linear interpolation along x and y at twice the pitch, N: the 95th percentile of the difference
// between a cell and the mean of its two neighbours. At the map's own pitch a smooth map is about four times better.
double coarse_grid_error_N(const Map& map);

}  // namespace palpa::stiffnessmaps
