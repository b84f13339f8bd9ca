#include "mechanics/large_hex8i.h"

#include <limits>

#include "mechanics/large_cell_sums.h"

namespace palpa::mechanics {
namespace {

using namespace cell_sums;
using Rows3 = Eigen::Matrix<double, 3, 24>;

}  // namespace

IncompatibleRest incompatible_rest_of(const Hex& corners_m, const Material& material) {
    IncompatibleRest rest;
    rest.stiffness_N_per_m = hex8i_stiffness_N_per_m(corners_m, material);
    rest.gradient_per_m = hex_middle(corners_m).gradient_per_m;
    rest.corners_m = corners_m.colwise() - corners_m.rowwise().mean();
    return rest;
}

// In the cell's own frame, where all vectors are turned by R^T: y_a = x_a - xbar, z_a = dx_a, p = K d. A displacement
// turns R by w = W z (polar_of(), with A = R^T dF = sum_a z_a g_a^T), so that d d_a = z_a + y_a x w. With
// m = sum y_a x p_a and n = inverse m the gradient is p_a - n x g_a, and the tangent, for displacements z' and z, the
// symmetric part of
//
//   d d'^T K d d  + 2 sum_a w' . (p_a x z_a) + sum_a (w' . p_a)(w . y_a) - (p_a . y_a)(w' . w)
//                 + sum_a w' . (z_a x N g_a) + tr(A') n . w - n . (A' w) - w' . N S w,       N = [n]_x
//
// The last four terms are n . (G dw), with G = inverse^-1, from the change of w itself.
namespace {

struct Turned {
    Hex y, p;
    Vector3d n;
    Polar polar;
};

// The tangent in the cell's frame.
HexMatrix turned_tangent(const IncompatibleRest& rest, const Turned& t) {
    Rows3 W, half;  // half: the tangent holds W^T half and its transpose
    Eigen::Matrix<double, 24, 3> arms;
    Matrix3d turn = Matrix3d::Zero();
    const Matrix3d N = cross_matrix(t.n);
    for (int a = 0; a < 8; ++a) {
        const Vector3d g = rest.gradient_per_m.col(a);
        const Vector3d p = t.p.col(a);
        const Vector3d y = t.y.col(a);
        W.middleCols<3>(3 * a) = t.polar.inverse * cross_matrix(g);
        arms.middleRows<3>(3 * a) = cross_matrix(y);
        half.middleCols<3>(3 * a) =
            cross_matrix(p) + 0.5 * (t.n * g.transpose() - g * t.n.transpose() - cross_matrix(N * g));
        turn += p * y.transpose() - p.dot(y) * Matrix3d::Identity();
    }
    const HexMatrix& K = rest.stiffness_N_per_m;
    const Eigen::Matrix<double, 24, 3> pulled = K * arms;
    const Matrix3d square = arms.transpose() * pulled + turn - N * t.polar.S;
    half += pulled.transpose() + 0.25 * (square + square.transpose()) * W;
    const HexMatrix product = W.transpose() * half;
    return K + product + product.transpose();
}

}  // namespace

void incompatible_cell(const IncompatibleRest& rest, const Hex& x_m, Wanted wanted, LargeCell<8>& out) {
    const Matrix3d F = x_m * rest.gradient_per_m.transpose();
    out.energy_J = std::numeric_limits<double>::infinity();
    if (!F.allFinite() || !x_m.allFinite()) return;
    Turned t;
    t.polar = polar_of(F);
    const Matrix3d& R = t.polar.R;
    t.y = R.transpose() * (x_m.colwise() - x_m.rowwise().mean());
    const Hex d = t.y - rest.corners_m;
    Eigen::Map<CellVector<8>>(t.p.data()).noalias() = rest.stiffness_N_per_m * flat<8>(d);
    out.energy_J = 0.5 * t.p.cwiseProduct(d).sum();
    if (wanted == Wanted::energy) return;
    Vector3d moment = Vector3d::Zero();
    for (int a = 0; a < 8; ++a) moment += Vector3d(t.y.col(a)).cross(Vector3d(t.p.col(a)));
    t.n = t.polar.inverse * moment;
    out.gradient_N = R * (t.p - cross_matrix(t.n) * rest.gradient_per_m);
    if (wanted != Wanted::tangent) return;
    const HexMatrix L = turned_tangent(rest, t);
    for (int b = 0; b < 8; ++b) {
        for (int a = 0; a < 8; ++a)
            out.tangent_N_per_m.block<3, 3>(3 * a, 3 * b) = R * L.block<3, 3>(3 * a, 3 * b) * R.transpose();
    }
}

}  // namespace palpa::mechanics
