#pragma once
// What the sources of elements at large strains share. Only they include this.

#include <Eigen/Core>
#include <Eigen/Geometry>

#include "mechanics/large_elements.h"

namespace palpa::mechanics::cell_sums {

using Eigen::Matrix3d;
using Eigen::Vector3d;

template <int N>
using Corners = Eigen::Matrix<double, 3, N>;
template <int N>
using CellMatrix = Eigen::Matrix<double, 3 * N, 3 * N>;
template <int N>
using CellVector = Eigen::Matrix<double, 3 * N, 1>;

template <int N>
CellVector<N> flat(const Corners<N>& values) {
    return Eigen::Map<const CellVector<N>>(values.data());
}

inline Matrix3d cofactor(const Matrix3d& F) {
    Matrix3d out;
    out << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
    return out;
}

inline Matrix3d cross_matrix(const Vector3d& v) {
    Matrix3d out;
    out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return out;
}

template <int N>
double volume_of(const CellRest<N>& rest) {
    double sum = 0.0;
    for (const double v : rest.volume_m3) sum += v;
    return sum;
}

// Writes the blocks on and below the diagonal of left * right^T, of which only these are needed.
template <int N, int Columns, int B = 0>
void write_lower_product(const Eigen::Matrix<double, 3 * N, Columns>& left,
                         const Eigen::Matrix<double, 3 * N, Columns>& right, CellMatrix<N>& K) {
    constexpr int kRows = 3 * (N - B);
    K.template block<kRows, 3>(3 * B, 3 * B) =
        left.template bottomRows<kRows>().lazyProduct(right.template middleRows<3>(3 * B).transpose());
    if constexpr (B + 1 < N) write_lower_product<N, Columns, B + 1>(left, right, K);
}

// Adds shape(a, b) 1 to the blocks on and below the diagonal, and copies what is below to above.
template <int N>
void add_shape_and_mirror(const Eigen::Matrix<double, N, N>& shape, CellMatrix<N>& K) {
    for (int b = 0; b < N; ++b) {
        for (int a = b; a < N; ++a) K.template block<3, 3>(3 * a, 3 * b).diagonal().array() += shape(a, b);
    }
    K.template triangularView<Eigen::StrictlyUpper>() = K.transpose();
}

// A cell of law corotational: large_elements.h.
template <int N>
void corotational_cell(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume, const Corners<N>& x_m,
                       Wanted wanted, LargeCell<N>& out);

}  // namespace palpa::mechanics::cell_sums
