#pragma once
// How noisy a map is, and how much smoothing the avatar's laws need because of it.

#include "stiffnessmaps/map.h"

namespace palpa::stiffnessmaps {

// Standard deviation of white noise in the normal force (N): what the map says of itself, or else the estimate.
double normal_noise_N(const Map& map);

// The same from second differences along x and y (median absolute value / (0.6745 sqrt(6)), robust against edges
// of nodules). 0 if the map is too small.
double estimated_noise_N(const Map& map);

// Smallest Gaussian sigma (m) for which noise of `noise_N` leaves sd(df) <= gate_N / 3 in the energy force:
//   sd(df) = s_ref s_E sqrt(3 dx dy / (16 pi)) / sigma^3,  s_E = noise sqrt(sum of squared trapezoid weights)
// Valid where sigma is larger than the pitch; 0 for a map without noise.
double smoothing_sigma_m(const Map& map, double noise_N, double reference_m, double gate_N);

// What a scene gets that does not ask otherwise: the sigma above for recordings, 0 for maps without noise of
// measurement.
double default_smoothing_m(const Map& map, double noise_N, double reference_m, double gate_N);

// How wrong linear interpolation along x and y would be at twice the pitch: 95th percentile of the difference
// between a cell and the mean of its two neighbours (N). At the map's own pitch a smooth map is about four
// times better.
double coarse_grid_error_N(const Map& map);

}  // namespace palpa::stiffnessmaps
