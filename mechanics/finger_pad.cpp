// The finger pad as an elastic half-space.

#include <algorithm>
#include <cmath>
#include <numbers>

#include "mechanics/finger.h"
#include "mechanics/layer.h"

namespace palpa::mechanics {
namespace {

using Eigen::Index;

constexpr double kFar = 6.0;  // widths of a rectangle, from where on it is a point, to 0.1 %

// Half the distance to the neighbours on both sides: the node's tributary stretch.
struct PadStretch {
    Eigen::VectorXd below;
    Eigen::VectorXd above;
};

PadStretch tributary(const Eigen::VectorXd& at_m) {
    const Index n = at_m.size();
    PadStretch out{Eigen::VectorXd::Zero(n), Eigen::VectorXd::Zero(n)};
    for (Index i = 0; i + 1 < n; ++i) out.above(i) = out.below(i + 1) = 0.5 * (at_m(i + 1) - at_m(i));
    return out;
}

// The antiderivative of 1/r over x and y.
double corner_term(double x, double y) {
    if (x == 0.0 || y == 0.0) return 0.0;
    return x * std::asinh(y / std::abs(x)) + y * std::asinh(x / std::abs(y));
}

}  // namespace

Eigen::MatrixXd half_space_kernel_per_m(const SurfaceGrid& grid) {
    const Index n_x = grid.x.at_m.size();
    const Index n_y = grid.y.at_m.size();
    const PadStretch along_x = tributary(grid.x.at_m);
    const PadStretch along_y = tributary(grid.y.at_m);
    Eigen::MatrixXd K(n_x * n_y, n_x * n_y);
    for (Index j = 0; j < K.cols(); ++j) {
        const Index jx = j % n_x;
        const Index jy = j / n_x;
        const double area_m2 = (along_x.below(jx) + along_x.above(jx)) * (along_y.below(jy) + along_y.above(jy));
        const double far_m =
            kFar * std::max(along_x.below(jx) + along_x.above(jx), along_y.below(jy) + along_y.above(jy));
        for (Index i = 0; i < K.rows(); ++i) {
            const double dx = grid.x.at_m(jx) - grid.x.at_m(i % n_x);
            const double dy = grid.y.at_m(jy) - grid.y.at_m(i / n_x);
            if (std::max(std::abs(dx), std::abs(dy)) > far_m) {
                K(i, j) = 1.0 / (std::numbers::pi * std::hypot(dx, dy));
                continue;
            }
            const double left = dx - along_x.below(jx);
            const double right = dx + along_x.above(jx);
            const double low = dy - along_y.below(jy);
            const double high = dy + along_y.above(jy);
            const double integral =
                corner_term(right, high) - corner_term(left, high) - corner_term(right, low) + corner_term(left, low);
            K(i, j) = integral / (std::numbers::pi * area_m2);
        }
    }
    for (Index j = 0; j < K.cols(); ++j)
        for (Index i = j + 1; i < K.rows(); ++i) K(i, j) = K(j, i) = 0.5 * (K(i, j) + K(j, i));
    return K;
}

double pad_modulus_Pa(const PadLaw& pad, double force_N) {
    return plane_strain_modulus_Pa(pad.young_Pa + pad.rise_Pa_per_N * std::max(0.0, force_N), pad.poisson);
}

PadLaw scaled(const PadLaw& pad, double scale) { return {pad.young_Pa / scale, pad.rise_Pa_per_N, pad.poisson}; }

}  // namespace palpa::mechanics
