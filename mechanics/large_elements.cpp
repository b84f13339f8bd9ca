#include "mechanics/large_elements.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <Eigen/LU>
#include <cassert>
#include <cmath>
#include <limits>

namespace palpa::mechanics {
namespace {

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

Matrix3d cofactor(const Matrix3d& F) {
    Matrix3d out;
    out << F.col(1).cross(F.col(2)), F.col(2).cross(F.col(0)), F.col(0).cross(F.col(1));
    return out;
}

Matrix3d cross_matrix(const Vector3d& v) {
    Matrix3d out;
    out << 0.0, -v.z(), v.y(), v.z(), 0.0, -v.x(), -v.y(), v.x(), 0.0;
    return out;
}

// One Gauss point of a law W(I, J). Gradient and tangent of the energy are sums over the points of
//   gradient_a = k k_a + c c_a
//   tangent_ab = shape (g_a . g_b) 1 + volume d2J_ab + kk k_a k_b^T + kc (k_a c_b^T + c_a k_b^T) + cc c_a c_b^T
// with k_a = F g_a, c_a = cof F g_a = dJ/dx_a, d2J_ab = [F (g_b x g_a)]_x, and coefficients (weights included):
struct PointTerms {
    double k = 0.0, c = 0.0, shape = 0.0, volume = 0.0, kk = 0.0, kc = 0.0, cc = 0.0;
};

template <int N>
struct PointState {
    Matrix3d F;
    double I = 0.0, J = 0.0;
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
    const double B = std::pow(p.J, -2.0 / 3.0);
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

template <int N>
double volume_of(const CellRest<N>& rest) {
    double sum = 0.0;
    for (const double v : rest.volume_m3) sum += v;
    return sum;
}

template <int N>
void add_terms(const CellRest<N>& rest, const PointStates<N>& points, Wanted wanted, LargeCell<N>& out) {
    constexpr int kColumns = 2 * static_cast<int>(CellRest<N>::kPoints);
    Eigen::Matrix<double, 3 * N, kColumns> basis;
    Eigen::Matrix<double, 3 * N, kColumns> weighted;
    Eigen::Matrix<double, N, N> shape = Eigen::Matrix<double, N, N>::Zero();
    CellMatrix<N>& K = out.tangent_N_per_m;
    if (wanted == Wanted::tangent) K.setZero();
    for (std::size_t g = 0; g < points.size(); ++g) {
        const PointTerms& t = points[g].terms;
        const Matrix3d& F = points[g].F;
        const Corners<N>& G = rest.gradient_per_m[g];
        const Corners<N> k = F * G;
        const Corners<N> c = cofactor(F) * G;
        out.gradient_N += t.k * k + t.c * c;
        if (wanted != Wanted::tangent) continue;
        const auto column = static_cast<Eigen::Index>(2 * g);
        basis.col(column) = flat<N>(k);
        basis.col(column + 1) = flat<N>(c);
        weighted.col(column) = t.kk * flat<N>(k) + t.kc * flat<N>(c);
        weighted.col(column + 1) = t.kc * flat<N>(k) + t.cc * flat<N>(c);
        shape.noalias() += t.shape * (G.transpose() * G);
        for (int b = 0; b < N; ++b) {
            for (int a = 0; a < b; ++a) {
                const Matrix3d d2J = cross_matrix(t.volume * (F * G.col(b).cross(G.col(a))));
                K.template block<3, 3>(3 * a, 3 * b) += d2J;
                K.template block<3, 3>(3 * b, 3 * a) -= d2J;
            }
        }
    }
    if (wanted != Wanted::tangent) return;
    K.noalias() += basis * weighted.transpose();
    for (int b = 0; b < N; ++b) {
        for (int a = 0; a < N; ++a) K.template block<3, 3>(3 * a, 3 * b).diagonal().array() += shape(a, b);
    }
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
        const Corners<N> c = cofactor(p.F) * rest.gradient_per_m[g];
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
    mean_J /= volume_of(rest);
    double energy_J = 0.0;
    for (std::size_t g = 0; g < points.size(); ++g) {
        PointState<N>& p = points[g];
        if (!mean_volume) {
            p.w = energy_density(material, p.I, p.J);
        } else if (p.J > 0.0) {
            const double B = std::pow(p.J, -2.0 / 3.0);
            p.w = split_energy_density(material, B * p.I, mean_J);
            p.slope_k = 2.0 * B;
            p.slope_c = -2.0 / 3.0 * B * p.I / p.J;
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
        points[g].J = points[g].F.determinant();
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

// dR/dF = sum_i 2 / (s_j + s_k) q_i q_i^T with three orthonormal q_i = U T_i V^T, T_i skew. Source: Smith, de Goes &
// Kim, "Analytic Eigensystems for Isotropic Distortion Energies", ACM Trans. Graph. 38(1), 2019, section 4.
struct TwistModes {
    std::array<Matrix3d, 3> q;
    std::array<double, 3> slope;
};

TwistModes twist_modes(const Stretches& stretches) {
    TwistModes out;
    for (int i = 0; i < 3; ++i) {
        const auto at = static_cast<std::size_t>(i);
        const Matrix3d T = std::sqrt(0.5) * cross_matrix(Vector3d::Unit(i));
        out.q[at] = stretches.U * T * stretches.V.transpose();
        // R jumps where two stretches are opposite; there the slope is kept finite, for the line search to deal with
        const double sum = stretches.s((i + 1) % 3) + stretches.s((i + 2) % 3);
        out.slope[at] = 2.0 / std::max(sum, 1e-4);
    }
    return out;
}

template <int N>
void corotational_cell(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume, const Corners<N>& x_m,
                       Wanted wanted, LargeCell<N>& out) {
    constexpr std::size_t kPoints = CellRest<N>::kPoints;
    const double mu = material.mu_Pa;
    const double kappa = mean_volume ? material.kappa_Pa : 0.0;  // of the mean
    const double lambda = mean_volume ? -2.0 * mu / 3.0 : material.kappa_Pa - 2.0 * mu / 3.0;
    const double V = volume_of(rest);
    std::array<Matrix3d, kPoints> F;
    std::array<Stretches, kPoints> stretches;
    double mean_stretch = 0.0;
    out.energy_J = 0.0;
    for (std::size_t g = 0; g < kPoints; ++g) {
        F[g] = x_m * rest.gradient_per_m[g].transpose();
        if (!F[g].allFinite()) {
            out.energy_J = std::numeric_limits<double>::infinity();
            return;
        }
        stretches[g] = stretches_of(F[g]);
        const Vector3d strain = stretches[g].s.array() - 1.0;
        const double weight = rest.volume_m3[g];
        out.energy_J += weight * (mu * strain.squaredNorm() + 0.5 * lambda * strain.sum() * strain.sum());
        mean_stretch += weight * strain.sum() / V;
    }
    out.energy_J += 0.5 * V * kappa * mean_stretch * mean_stretch;
    if (wanted == Wanted::energy) return;

    constexpr int kColumns = 4 * static_cast<int>(CellRest<N>::kPoints);
    Eigen::Matrix<double, 3 * N, kColumns> basis;
    Eigen::Matrix<double, kColumns, 1> weights;
    Eigen::Matrix<double, N, N> shape = Eigen::Matrix<double, N, N>::Zero();
    CellVector<N> mean = CellVector<N>::Zero();  // V dtbar/dx
    out.gradient_N.setZero();
    for (std::size_t g = 0; g < kPoints; ++g) {
        const Corners<N>& G = rest.gradient_per_m[g];
        const double weight = rest.volume_m3[g];
        const Matrix3d R = stretches[g].rotation();
        const double pressure = lambda * (stretches[g].s.sum() - 3.0) + kappa * mean_stretch;
        out.gradient_N += weight * (2.0 * mu * (F[g] - R) + pressure * R) * G;
        if (wanted != Wanted::tangent) continue;
        const auto column = static_cast<Eigen::Index>(4 * g);
        const TwistModes modes = twist_modes(stretches[g]);
        for (int i = 0; i < 3; ++i) {
            const auto at = static_cast<std::size_t>(i);
            basis.col(column + i) = flat<N>(modes.q[at] * G);
            weights(column + i) = weight * (pressure - 2.0 * mu) * modes.slope[at];
        }
        basis.col(column + 3) = flat<N>(R * G);
        weights(column + 3) = weight * lambda;
        mean += weight * basis.col(column + 3);
        shape.noalias() += 2.0 * mu * weight * (G.transpose() * G);
    }
    if (wanted != Wanted::tangent) return;
    CellMatrix<N>& K = out.tangent_N_per_m;
    K.noalias() = basis * weights.asDiagonal() * basis.transpose();
    K.noalias() += (kappa / V * mean) * mean.transpose();
    for (int b = 0; b < N; ++b) {
        for (int a = 0; a < N; ++a) K.template block<3, 3>(3 * a, 3 * b).diagonal().array() += shape(a, b);
    }
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
