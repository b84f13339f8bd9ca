#include "mechanics/surface_grid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {

using Eigen::Index;

namespace {

Index width_of_bend(Index n) { return std::min<Index>(2 * kSplineReach + 1, n); }

// The first of the values that the second derivative at coordinate i is taken from.
Index first_of_bend(Index i, Index n) { return std::clamp<Index>(i - kSplineReach, 0, n - width_of_bend(n)); }

// Second derivatives of the spline at all coordinates per value at each: n x n. Continuity of the slope at coordinate i:
//   h_(i-1)/6 M_(i-1) + (h_(i-1) + h_i)/3 M_i + h_i/6 M_(i+1) = (u_(i+1) - u_i)/h_i - (u_i - u_(i-1))/h_(i-1)
Eigen::MatrixXd bends(const Eigen::VectorXd& at_m) {
    const Index n = at_m.size();
    if (n < 3) return Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd A = Eigen::MatrixXd::Zero(n, n);
    Eigen::MatrixXd B = Eigen::MatrixXd::Zero(n, n);
    for (Index i = 1; i + 1 < n; ++i) {
        const double before = at_m(i) - at_m(i - 1);
        const double after = at_m(i + 1) - at_m(i);
        A.row(i).segment<3>(i - 1) << before / 6.0, (before + after) / 3.0, after / 6.0;
        B.row(i).segment<3>(i - 1) << 1.0 / before, -1.0 / before - 1.0 / after, 1.0 / after;
    }
    A(0, 0) = A(n - 1, n - 1) = 1.0;
    A(0, 1) = A(n - 1, n - 2) = -1.0;
    return A.partialPivLu().solve(B);
}

void add_bend(const GridAxis& axis, Index i, double factor, Stencil& out) {
    const Index first = first_of_bend(i, axis.at_m.size());
    for (Index k = 0; k < axis.bend_per_m2.rows(); ++k)
        out.weight[first + k - out.first] += factor * axis.bend_per_m2(k, i);
}

}  // namespace

GridAxis grid_axis(const Eigen::VectorXd& at_m) {
    const Index n = at_m.size();
    GridAxis axis{at_m, Eigen::MatrixXd::Zero(width_of_bend(n), n)};
    const Eigen::MatrixXd bend = bends(at_m);
    for (Index i = 0; i < n; ++i)
        axis.bend_per_m2.col(i) = bend.row(i).segment(first_of_bend(i, n), width_of_bend(n)).transpose();
    return axis;
}

SurfaceGrid surface_grid(const Compliance& compliance) {
    const Index n = compliance.n_touch;
    const auto x = compliance.position_m.row(0).head(n);
    const auto y = compliance.position_m.row(1).head(n);
    Index n_x = n > 0 ? 1 : 0;
    while (n_x < n && x(n_x) > x(n_x - 1)) ++n_x;
    const Index n_y = n_x > 0 ? n / n_x : 0;
    bool regular = n_x >= 2 && n_y >= 2 && n_x * n_y == n;
    const double tolerance_m = regular ? 1e-9 * (x(n_x - 1) - x(0)) : 0.0;
    for (Index k = 0; regular && k < n; ++k) {
        const Index row = k / n_x * n_x;
        regular = std::abs(x(k) - x(k % n_x)) <= tolerance_m && std::abs(y(k) - y(row)) <= tolerance_m &&
                  (k < n_x || y(k) > y(k - n_x));
    }
    if (!regular) {
        throw LoadError(text("surface grid: the ", n,
                             " touch nodes are not a grid of rectangles, numbered x fastest, "
                             "with at least two nodes along x and y"));
    }
    Eigen::VectorXd y_m(n_y);
    for (Index j = 0; j < n_y; ++j) y_m(j) = y(j * n_x);
    return {grid_axis(x.head(n_x).transpose()), grid_axis(y_m)};
}

int cell_of(const GridAxis& axis, double place_m) {
    const double* first = axis.at_m.data();
    const double* above = std::upper_bound(first, first + axis.at_m.size(), place_m);
    return static_cast<int>(std::clamp<Index>(above - first - 1, 0, axis.at_m.size() - 2));
}

Stencil stencil_at(const GridAxis& axis, double place_m) {
    const Index n = axis.at_m.size();
    const double at_m = std::clamp(place_m, axis.at_m(0), axis.at_m(n - 1));
    const int cell = cell_of(axis, at_m);
    Stencil out;
    out.first = static_cast<int>(first_of_bend(cell, n));
    out.count = static_cast<int>(first_of_bend(cell + 1, n) + width_of_bend(n)) - out.first;
    const double h = axis.at_m(cell + 1) - axis.at_m(cell);
    const double b = (at_m - axis.at_m(cell)) / h;
    const double a = 1.0 - b;
    out.weight[cell - out.first] = a;
    out.weight[cell + 1 - out.first] = b;
    add_bend(axis, cell, (a * a * a - a) * h * h / 6.0, out);
    add_bend(axis, cell + 1, (b * b * b - b) * h * h / 6.0, out);
    return out;
}

}  // namespace palpa::mechanics
