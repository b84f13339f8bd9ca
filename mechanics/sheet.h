#pragma once
// How a rubber sheet on pins passes their heights on to its top.

#include <Eigen/Core>

#include "mechanics/pin_shape.h"

namespace palpa::mechanics {

// Returns the height of the top at each sample point per height of each pin, n_sample x n_pins; rows add up to 1.
//
// The sheet's underside is bilinear between pins and level beyond the outermost ones; the top is its convolution with
//
//   g(r) = 1/(2 pi h^2) int_0^inf T(x) J0(x r/h) x dx          (free: by Simpson's rule up to x = 40)
//        = 3 h^3 / (2 pi (r^2 + h^2)^(5/2))                    (backed)
//
// summed on a lattice of a sixth of the thickness or the pitch, whichever is less, out to six thicknesses.
Eigen::MatrixXd sheet_forward(const PinGrid& grid, Sheet sheet, double thickness_m, const Eigen::Matrix2Xd& sample_m);

}  // namespace palpa::mechanics
