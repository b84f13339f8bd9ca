#include "mechanics/large_elements.h"

#include <Eigen/Cholesky>
#include <Eigen/Eigenvalues>
#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <limits>

#include "mechanics/large_cell_sums.h"

namespace palpa::mechanics {
namespace {

using namespace cell_sums;

// One Gauss point of a law W(I, J). Gradient and tangent of the energy are sums over the points of
//   gradient_a = k k_a + c c_a
//   tangent_ab = shape (g_a . g_b) 1 + volume d2J_ab + kk k_a k_b^T + kc (k_a c_b^T + c_a k_b^T) + cc c_a c_b^T
// with k_a = F g_a, c_a = cof F g_a = dJ/dx_a, d2J_ab = [F (g_b x g_a)]_x, and coefficients (weights included):
struct PointTerms {
    double k = 0.0, c = 0.0, shape = 0.0, volume = 0.0, kk = 0.0, kc = 0.0, cc = 0.0;
};

template <int N>
struct PointState {
    Matrix3d F, cofactor;
    double I = 0.0, J = 0.0;
    double B = 0.0;  // J^(-2/3), with the mean volume only
    EnergyDensity w;
    double slope_k = 0.0, slope_c = 0.0;  // dA/dx_a = slope_k k_a + slope_c c_a, with the mean volume only
    PointTerms terms;
};

template <int N>
using PointStates = std::array<PointState<N>, CellRest<N>::kPoints>;

PointTerms full_terms(const EnergyDensity& w, double weight) {
    return {2.0 * weight * w.I,  weight * w.J,        2.0 * weight * w.I, weight * w.J,
            4.0 * weight * w.II, 2.0 * weight * w.IJ, weight * w.JJ};
}

// The terms of A = J^(-2/3) I and of the mean volume; pressure_Pa is the mean of dW/dJbar.
template <int N>
PointTerms mean_terms(const PointState<N>& p, double weight, double pressure_Pa) {
    const double B = p.B;
    const double first = weight * p.w.I;
    const double second = weight * p.w.II;
    PointTerms t;
    t.k = first * p.slope_k;
    t.c = first * p.slope_c + weight * pressure_Pa;
    t.shape = 2.0 * first * B;
    t.volume = weight * pressure_Pa - 2.0 / 3.0 * first * B * p.I / p.J;
    t.kk = second * p.slope_k * p.slope_k;
    t.kc = second * p.slope_k * p.slope_c - 4.0 / 3.0 * first * B / p.J;
    t.cc = second * p.slope_c * p.slope_c + 10.0 / 9.0 * first * B * p.I / (p.J * p.J);
    return t;
}

constexpr double kZeroShare = 1e-10;  // of the mean diagonal: an eigenvalue of this size is none

// Adds the gradient of all points, and writes their tangent.
template <int N>
void add_terms(const CellRest<N>& rest, const PointStates<N>& points, Wanted wanted, LargeCell<N>& out) {
    constexpr int kColumns = 2 * static_cast<int>(CellRest<N>::kPoints);
    Eigen::Matrix<double, 3 * N, kColumns> basis;
    Eigen::Matrix<double, 3 * N, kColumns> weighted;
    Eigen::Matrix<double, N, N> shape = Eigen::Matrix<double, N, N>::Zero();
    Eigen::Matrix<double, 3, N*(N - 1) / 2> d2J = Eigen::Matrix<double, 3, N*(N - 1) / 2>::Zero();
    for (std::size_t g = 0; g < points.size(); ++g) {
        const PointTerms& t = points[g].terms;
        const Corners<N>& G = rest.gradient_per_m[g];
        const Corners<N> k = points[g].F * G;
        const Corners<N> c = points[g].cofactor * G;
        out.gradient_N += t.k * k + t.c * c;
        if (wanted != Wanted::tangent) continue;
        const auto column = static_cast<Eigen::Index>(2 * g);
        basis.col(column) = flat<N>(k);
        basis.col(column + 1) = flat<N>(c);
        weighted.col(column) = t.kk * flat<N>(k) + t.kc * flat<N>(c);
        weighted.col(column + 1) = t.kc * flat<N>(k) + t.cc * flat<N>(c);
        shape.noalias() += t.shape * G.transpose().lazyProduct(G);
        // F (g_b x g_a) = F [g_b]_x g_a, pair by pair
        for (int b = 0, pair = 0; b < N; ++b) {
            const Matrix3d turned = t.volume * points[g].F * cross_matrix(G.col(b));
            for (int a = b + 1; a < N; ++a, ++pair) d2J.col(pair) += turned * G.col(a);
        }
    }
    if (wanted != Wanted::tangent) return;
    CellMatrix<N>& K = out.tangent_N_per_m;
    write_lower_product<N, kColumns>(basis, weighted, K);
    for (int b = 0, pair = 0; b < N; ++b) {
        for (int a = b + 1; a < N; ++a, ++pair) K.template block<3, 3>(3 * a, 3 * b) += cross_matrix(d2J.col(pair));
    }
    add_shape_and_mirror<N>(shape, K);
}

// The part of the tangent that couples all points by the mean volume: m v^T + v m^T + q v v^T, with v = dJbar/dx.
template <int N>
void add_mean_volume(const CellRest<N>& rest, const PointStates<N>& points, CellMatrix<N>& K) {
    CellVector<N> m = CellVector<N>::Zero();
    CellVector<N> v = CellVector<N>::Zero();
    double q = 0.0;
    for (std::size_t g = 0; g < points.size(); ++g) {
        const PointState<N>& p = points[g];
        const Corners<N> k = p.F * rest.gradient_per_m[g];
        const Corners<N> c = p.cofactor * rest.gradient_per_m[g];
        const double weight = rest.volume_m3[g];
        m += weight * p.w.IJ * (p.slope_k * flat<N>(k) + p.slope_c * flat<N>(c));
        v += weight * flat<N>(c);
        q += weight * p.w.JJ;
    }
    v /= volume_of(rest);
    const CellVector<N> half = m + 0.5 * q * v;
    K.noalias() += half * v.transpose() + v * half.transpose();
}

// Fills the points' energy densities and returns the energy, which is infinite if one of them is.
template <int N>
double energies(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume, PointStates<N>& points) {
    double mean_J = 0.0;
    for (std::size_t g = 0; g < points.size(); ++g) mean_J += rest.volume_m3[g] * points[g].J;
    const VolumeChange mean = volume_change(mean_J / volume_of(rest));
    double energy_J = 0.0;
    for (std::size_t g = 0; g < points.size(); ++g) {
        PointState<N>& p = points[g];
        if (!mean_volume) {
            p.w = energy_density(material, p.I, p.J);
        } else if (p.J > 0.0) {
            const double root = std::cbrt(p.J);
            p.B = 1.0 / (root * root);
            p.w = split_energy_density(material, p.B * p.I, mean);
            p.slope_k = 2.0 * p.B;
            p.slope_c = -2.0 / 3.0 * p.B * p.I / p.J;
        } else {
            return std::numeric_limits<double>::infinity();
        }
        energy_J += rest.volume_m3[g] * p.w.W_Pa;
    }
    return energy_J;
}

template <int N>
void isotropic_cell(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume, const Corners<N>& x_m,
                    Wanted wanted, LargeCell<N>& out) {
    PointStates<N> points;
    for (std::size_t g = 0; g < points.size(); ++g) {
        points[g].F = x_m * rest.gradient_per_m[g].transpose();
        points[g].I = points[g].F.squaredNorm();
        points[g].cofactor = cofactor(points[g].F);
        points[g].J = points[g].F.col(0).dot(points[g].cofactor.col(0));
    }
    out.energy_J = energies<N>(rest, material, mean_volume, points);
    if (wanted == Wanted::energy || !std::isfinite(out.energy_J)) return;
    double pressure_Pa = 0.0;
    for (std::size_t g = 0; g < points.size(); ++g) pressure_Pa += rest.volume_m3[g] * points[g].w.J;
    pressure_Pa /= volume_of(rest);
    for (std::size_t g = 0; g < points.size(); ++g) {
        const double weight = rest.volume_m3[g];
        points[g].terms = mean_volume ? mean_terms<N>(points[g], weight, pressure_Pa) : full_terms(points[g].w, weight);
    }
    out.gradient_N.setZero();
    add_terms<N>(rest, points, wanted, out);
    if (mean_volume && wanted == Wanted::tangent) add_mean_volume<N>(rest, points, out.tangent_N_per_m);
}

Voigt voigt_of(const Matrix3d& tensor, double shear) {
    Voigt out;
    out << tensor(0, 0), tensor(1, 1), tensor(2, 2), shear * tensor(0, 1), shear * tensor(1, 2), shear * tensor(0, 2);
    return out;
}

}  // namespace

CellRest<8> rest_of(const Hex& corners_m) {
    CellRest<8> rest;
    for (int g = 0; g < 8; ++g) {
        const HexPoint point = hex_point(corners_m, g);
        rest.gradient_per_m[static_cast<std::size_t>(g)] = point.gradient_per_m;
        rest.volume_m3[static_cast<std::size_t>(g)] = point.volume_m3;
    }
    return rest;
}

CellRest<4> rest_of(const Tet& corners_m) {
    CellRest<4> rest;
    rest.volume_m3[0] = tet_gradients_per_m(corners_m, rest.gradient_per_m[0]);
    return rest;
}

template <int N>
void large_cell(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume, const Corners<N>& x_m,
                Wanted wanted, LargeCell<N>& out) {
    assert(N == 8 || !mean_volume);
    if (material.law == Law::corotational)
        corotational_cell<N>(rest, material, mean_volume, x_m, wanted, out);
    else
        isotropic_cell<N>(rest, material, mean_volume, x_m, wanted, out);
}

template <int N>
void make_positive(CellMatrix<N>& tangent_N_per_m) {
    // most cells need nothing, and Cholesky's method finds that out in a tenth of the time
    CellMatrix<N> raised = tangent_N_per_m;
    raised.diagonal().array() += kZeroShare * raised.trace() / static_cast<double>(raised.rows());
    if (Eigen::LLT<CellMatrix<N>>(raised).info() == Eigen::Success) return;
    const Eigen::SelfAdjointEigenSolver<CellMatrix<N>> eigen(tangent_N_per_m);
    if (eigen.eigenvalues()(0) >= 0.0) return;
    tangent_N_per_m =
        eigen.eigenvectors() * eigen.eigenvalues().cwiseMax(0.0).asDiagonal() * eigen.eigenvectors().transpose();
}

template <int N>
LargeFields large_fields(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume,
                         const Corners<N>& x_m) {
    const double V = volume_of(rest);
    std::array<Matrix3d, CellRest<N>::kPoints> F;
    double mean_J = 0.0;
    for (std::size_t g = 0; g < F.size(); ++g) {
        F[g] = x_m * rest.gradient_per_m[g].transpose();
        mean_J += rest.volume_m3[g] * F[g].determinant() / V;
    }
    LargeFields out;
    for (std::size_t g = 0; g < F.size(); ++g) {
        const double share = rest.volume_m3[g] / V;
        const Matrix3d strain = 0.5 * (F[g].transpose() * F[g] - Matrix3d::Identity());
        out.strain += share * voigt_of(strain, 2.0);
        const double J = F[g].determinant();
        if (mean_volume) F[g] *= std::cbrt(mean_J / J);
        const bool inside_out = !(J > 0.0 && mean_J > 0.0);
        if (inside_out)
            out.stress_Pa.setConstant(std::numeric_limits<double>::quiet_NaN());
        else
            out.stress_Pa += share * voigt_of(cauchy_stress_Pa(material, F[g]), 1.0);
    }
    return out;
}

template void large_cell<8>(const CellRest<8>&, const LargeMaterial&, bool, const Hex&, Wanted, LargeCell<8>&);
template void large_cell<4>(const CellRest<4>&, const LargeMaterial&, bool, const Tet&, Wanted, LargeCell<4>&);
template void make_positive<8>(HexMatrix&);
template void make_positive<4>(TetMatrix&);
template LargeFields large_fields<8>(const CellRest<8>&, const LargeMaterial&, bool, const Hex&);
template LargeFields large_fields<4>(const CellRest<4>&, const LargeMaterial&, bool, const Tet&);

}  // namespace palpa::mechanics
