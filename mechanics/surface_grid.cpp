#include "mechanics/surface_grid.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {

using Eigen::Index;

GridAxis grid_axis(const Eigen::VectorXd& at_m) {
    GridAxis axis{at_m, {}};
    const Index count = std::min<Index>(4, at_m.size());
    axis.inverse.setOnes(count, at_m.size() - count + 1);
    for (Index first = 0; first < axis.inverse.cols(); ++first)
        for (Index k = 0; k < count; ++k)
            for (Index m = 0; m < count; ++m)
                if (m != k) axis.inverse(k, first) /= at_m(first + k) - at_m(first + m);
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
    Stencil out;
    out.count = static_cast<int>(axis.inverse.rows());
    out.first = std::clamp(cell_of(axis, at_m) - 1, 0, static_cast<int>(n) - out.count);
    for (int k = 0; k < out.count; ++k) {
        double weight = axis.inverse(k, out.first);
        for (int m = 0; m < out.count; ++m)
            if (m != k) weight *= at_m - axis.at_m(out.first + m);
        out.weight[k] = weight;
    }
    return out;
}

}  // namespace palpa::mechanics
