#pragma once
// A surface whose touch nodes form a grid of rectangles, and the interpolation of nodal values between them.

#include <Eigen/Core>

#include "mechanics/compliance.h"

namespace palpa::mechanics {

// The coordinates along one axis, ascending. Between them values are interpolated by a cubic spline, whose second
// derivative at both ends is that of the next coordinate (a line if there are two coordinates only). What a value does to
// the spline falls by 0.27 per coordinate; it is left out beyond kSplineReach of them, which keeps values continuous and
// lets slopes jump by less than 1e-3 of what they would without the spline.
inline constexpr int kSplineReach = 5;
struct GridAxis {
    Eigen::VectorXd at_m;
    // Second derivative at each coordinate: weights of the values from first_of_bend() on.
    Eigen::MatrixXd bend_per_m2;
};

// Touch node i + n_x j stands at (x.at_m[i], y.at_m[j]).
struct SurfaceGrid {
    GridAxis x;
    GridAxis y;
};

// Part of an axis, and the weights that its values have at one place; they add up to 1. A place beside the axis takes
// the weights of its end.
struct Stencil {
    int first = 0;
    int count = 0;
    double weight[2 * kSplineReach + 2] = {};
};

GridAxis grid_axis(const Eigen::VectorXd& at_m);

// Throws LoadError if the touch nodes of the compliance are not such a grid, numbered x fastest (hex_box() and
// request_rectangle() give one), or have fewer than two coordinates along an axis.
SurfaceGrid surface_grid(const Compliance& compliance);

// Returns the cell that holds a place: at_m[i] <= x < at_m[i + 1], or the first or last cell. The place is finite.
int cell_of(const GridAxis& axis, double place_m);
Stencil stencil_at(const GridAxis& axis, double place_m);

}  // namespace palpa::mechanics
