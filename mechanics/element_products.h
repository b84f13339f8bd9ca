#pragma once
// From products of the shape functions' gradients to a cell's stiffness. Only sources of elements include this.

#include <Eigen/Core>

namespace palpa::mechanics {

// Computes a cell's stiffness without the mean-dilatation term from M_ab = int g_a g_b^T dV, 3 x 3 blocks for pairs of
// nodes (elements.h has the formula).
template <class Matrix>
void stiffness_from_products(const Matrix& M, double mu, double lambda, Matrix& K) {
    const int n = static_cast<int>(M.rows()) / 3;
    for (int b = 0; b < n; ++b) {
        for (int a = 0; a < n; ++a) {
            const Eigen::Matrix3d m = M.template block<3, 3>(3 * a, 3 * b);
            K.template block<3, 3>(3 * a, 3 * b) =
                mu * (m.trace() * Eigen::Matrix3d::Identity() + m.transpose()) + lambda * m;
        }
    }
}

}  // namespace palpa::mechanics
