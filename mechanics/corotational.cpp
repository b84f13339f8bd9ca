#include <cmath>
#include <limits>

#include "mechanics/large_cell_sums.h"

namespace palpa::mechanics::cell_sums {
namespace {

template <int N>
struct CorotationalPoints {
    static constexpr std::size_t kPoints = CellRest<N>::kPoints;
    std::array<Matrix3d, kPoints> F;
    std::array<Polar, kPoints> polar;
    double mean_stretch = 0.0;  // mean of tr S - 3
};

// Lame's first modulus at the points, and the bulk modulus of the mean.
struct Moduli {
    double mu_Pa = 0.0, lambda_Pa = 0.0, mean_Pa = 0.0;
};

Moduli moduli_of(const LargeMaterial& m, bool mean_volume) {
    return mean_volume ? Moduli{m.mu_Pa, -2.0 * m.mu_Pa / 3.0, m.kappa_Pa}
                       : Moduli{m.mu_Pa, m.kappa_Pa - 2.0 * m.mu_Pa / 3.0, 0.0};
}

// Fills the points and returns the energy, infinite if a place is not finite.
template <int N>
double corotational_energy(const CellRest<N>& rest, const Moduli& m, const Corners<N>& x_m,
                           CorotationalPoints<N>& points) {
    const double V = volume_of(rest);
    double energy_J = 0.0;
    for (std::size_t g = 0; g < points.kPoints; ++g) {
        points.F[g] = x_m * rest.gradient_per_m[g].transpose();
        if (!points.F[g].allFinite()) return std::numeric_limits<double>::infinity();
        points.polar[g] = polar_of(points.F[g]);
        const double stretch = points.polar[g].S.trace() - 3.0;
        const double shape = (points.polar[g].S - Matrix3d::Identity()).squaredNorm();
        energy_J += rest.volume_m3[g] * (m.mu_Pa * shape + 0.5 * m.lambda_Pa * stretch * stretch);
        points.mean_stretch += rest.volume_m3[g] * stretch / V;
    }
    return energy_J + 0.5 * V * m.mean_Pa * points.mean_stretch * points.mean_stretch;
}

}  // namespace

// With the terms of polar_of(), w depends on x by axl(R^T dF) = sum_a [g_a]_x R^T dx_a: three columns R (e_i x g_a) a point.
template <int N>
void corotational_cell(const CellRest<N>& rest, const LargeMaterial& material, bool mean_volume, const Corners<N>& x_m,
                       Wanted wanted, LargeCell<N>& out) {
    const Moduli m = moduli_of(material, mean_volume);
    CorotationalPoints<N> points;
    out.energy_J = corotational_energy<N>(rest, m, x_m, points);
    if (wanted == Wanted::energy || !std::isfinite(out.energy_J)) return;
    constexpr int kColumns = 4 * static_cast<int>(CellRest<N>::kPoints) + 1;  // the last: the mean stretch
    Eigen::Matrix<double, 3 * N, kColumns> basis;
    Eigen::Matrix<double, 3 * N, kColumns> weighted;
    Eigen::Matrix<double, N, N> shape = Eigen::Matrix<double, N, N>::Zero();
    CellVector<N> mean = CellVector<N>::Zero();  // V dtbar/dx
    out.gradient_N.setZero();
    for (std::size_t g = 0; g < points.kPoints; ++g) {
        const Corners<N>& G = rest.gradient_per_m[g];
        const double weight = rest.volume_m3[g];
        const Polar& polar = points.polar[g];
        const double pressure = m.lambda_Pa * (polar.S.trace() - 3.0) + m.mean_Pa * points.mean_stretch;
        out.gradient_N += weight * (2.0 * m.mu_Pa * (points.F[g] - polar.R) + pressure * polar.R) * G;
        if (wanted != Wanted::tangent) continue;
        const auto column = static_cast<Eigen::Index>(4 * g);
        for (int i = 0; i < 3; ++i) basis.col(column + i) = flat<N>(polar.R * cross_matrix(Vector3d::Unit(i)) * G);
        basis.col(column + 3) = flat<N>(polar.R * G);
        weighted.template middleCols<3>(column).noalias() =
            basis.template middleCols<3>(column).lazyProduct(weight * (pressure - 2.0 * m.mu_Pa) * polar.inverse);
        weighted.col(column + 3) = weight * m.lambda_Pa * basis.col(column + 3);
        mean += weight * basis.col(column + 3);
        shape.noalias() += 2.0 * m.mu_Pa * weight * G.transpose().lazyProduct(G);
    }
    if (wanted != Wanted::tangent) return;
    basis.col(kColumns - 1) = mean;
    weighted.col(kColumns - 1) = m.mean_Pa / volume_of(rest) * mean;
    write_lower_product<N, kColumns>(basis, weighted, out.tangent_N_per_m);
    add_shape_and_mirror<N>(shape, out.tangent_N_per_m);
}

template void corotational_cell<8>(const CellRest<8>&, const LargeMaterial&, bool, const Hex&, Wanted, LargeCell<8>&);
template void corotational_cell<4>(const CellRest<4>&, const LargeMaterial&, bool, const Tet&, Wanted, LargeCell<4>&);

}  // namespace palpa::mechanics::cell_sums
