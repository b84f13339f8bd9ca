#include "mechanics/elements.h"

#include <Eigen/Cholesky>
#include <Eigen/LU>
#include <array>
#include <cmath>

#include "mechanics/element_products.h"

namespace palpa::mechanics {
namespace {

using Eigen::Matrix3d;
using Eigen::Vector3d;

// Signs of the reference corners (-1..1)^3 in VTK order.
constexpr std::array<std::array<double, 3>, 8> kCorner{
    {{-1, -1, -1}, {1, -1, -1}, {1, 1, -1}, {-1, 1, -1}, {-1, -1, 1}, {1, -1, 1}, {1, 1, 1}, {-1, 1, 1}}};

// Returns dN_a/d(r, s, t) at the Gauss point that lies towards corner g, one column per node a.
Hex reference_gradient(int g) {
    const double at = 1.0 / std::sqrt(3.0);
    const auto& point = kCorner[static_cast<std::size_t>(g)];
    Hex d;
    for (int a = 0; a < 8; ++a) {
        const auto& c = kCorner[static_cast<std::size_t>(a)];
        const double r = 1.0 + c[0] * at * point[0];
        const double s = 1.0 + c[1] * at * point[1];
        const double t = 1.0 + c[2] * at * point[2];
        d.col(a) << 0.125 * c[0] * s * t, 0.125 * c[1] * r * t, 0.125 * c[2] * r * s;
    }
    return d;
}

const std::array<Hex, 8>& reference_gradients() {
    static const std::array<Hex, 8> all = [] {
        std::array<Hex, 8> made;
        for (int g = 0; g < 8; ++g) made[static_cast<std::size_t>(g)] = reference_gradient(g);
        return made;
    }();
    return all;
}

// Sums over the eight Gauss points: the products of gradients, the mean gradient and the volume.
struct HexSums {
    HexMatrix products = HexMatrix::Zero();
    Hex mean_gradient = Hex::Zero();
    double volume_m3 = 0.0;
};

HexSums hex_sums(const Hex& corners_m) {
    HexSums sums;
    for (int g = 0; g < 8; ++g) {
        const HexPoint point = hex_point(corners_m, g);
        const Eigen::Map<const Eigen::Matrix<double, 24, 1>> column(point.gradient_per_m.data());
        sums.products.noalias() += (point.volume_m3 * column) * column.transpose();
        sums.mean_gradient += point.volume_m3 * point.gradient_per_m;
        sums.volume_m3 += point.volume_m3;
    }
    sums.mean_gradient /= sums.volume_m3;
    return sums;
}

Voigt strain_of(const Matrix3d& u_gradient) {
    const Matrix3d twice = u_gradient + u_gradient.transpose();
    Voigt strain;
    strain << 0.5 * twice(0, 0), 0.5 * twice(1, 1), 0.5 * twice(2, 2), twice(0, 1), twice(1, 2), twice(0, 2);
    return strain;
}

}  // namespace

HexPoint hex_point(const Hex& corners_m, int g) {
    const Hex& reference = reference_gradients()[static_cast<std::size_t>(g)];
    const Matrix3d J = reference * corners_m.transpose();  // dx_j/dr_i
    return {J.inverse() * reference, J.determinant()};     // Gauss weights are 1
}

HexPoint hex_middle(const Hex& corners_m) {
    Hex reference;
    for (int a = 0; a < 8; ++a) {
        const auto& c = kCorner[static_cast<std::size_t>(a)];
        reference.col(a) << 0.125 * c[0], 0.125 * c[1], 0.125 * c[2];
    }
    const Matrix3d J = reference * corners_m.transpose();
    return {J.inverse() * reference, 8.0 * J.determinant()};
}

HexMatrix hex8i_stiffness_N_per_m(const Hex& corners_m, const Material& material) {
    using Wide = Eigen::Matrix<double, 33, 33>;  // corners, then modes
    const double middle_m3 = 0.125 * hex_middle(corners_m).volume_m3;
    Matrix3d to_space = Matrix3d::Zero();  // J0^-1
    for (int a = 0; a < 8; ++a) {
        const auto& c = kCorner[static_cast<std::size_t>(a)];
        to_space += 0.125 * Vector3d(c[0], c[1], c[2]) * corners_m.col(a).transpose();
    }
    to_space = to_space.inverse().eval();
    Wide products = Wide::Zero();
    for (int g = 0; g < 8; ++g) {
        const HexPoint point = hex_point(corners_m, g);
        Eigen::Matrix<double, 3, 11> gradient;
        gradient.leftCols<8>() = point.gradient_per_m;
        for (int mode = 0; mode < 3; ++mode) {
            const double at = kCorner[static_cast<std::size_t>(g)][static_cast<std::size_t>(mode)] / std::sqrt(3.0);
            gradient.col(8 + mode) = -2.0 * at * middle_m3 / point.volume_m3 * to_space.col(mode);
        }
        const Eigen::Map<const Eigen::Matrix<double, 33, 1>> column(gradient.data());
        products.noalias() += (point.volume_m3 * column) * column.transpose();
    }
    Wide K;
    stiffness_from_products(products, mu_Pa(material), lambda_Pa(material), K);
    const Eigen::Matrix<double, 9, 9> modes = K.bottomRightCorner<9, 9>();
    const Eigen::Matrix<double, 9, 24> coupling = K.bottomLeftCorner<9, 24>();
    HexMatrix out = K.topLeftCorner<24, 24>();
    out.noalias() -= coupling.transpose() * modes.ldlt().solve(coupling);
    return out;
}

HexMatrix hex8_stiffness_N_per_m(const Hex& corners_m, const Material& material) {
    HexMatrix K;
    stiffness_from_products(hex_sums(corners_m).products, mu_Pa(material), lambda_Pa(material), K);
    return K;
}

HexMatrix hex8_bbar_stiffness_N_per_m(const Hex& corners_m, const Material& material) {
    const HexSums sums = hex_sums(corners_m);
    const double mu = mu_Pa(material);
    HexMatrix K;
    stiffness_from_products(sums.products, mu, -2.0 * mu / 3.0, K);
    const Eigen::Map<const Eigen::Matrix<double, 24, 1>> mean(sums.mean_gradient.data());
    K.noalias() += (kappa_Pa(material) * sums.volume_m3 * mean) * mean.transpose();
    return K;
}

double tet_gradients_per_m(const Tet& corners_m, Tet& gradient_per_m) {
    const Matrix3d edges = corners_m.rightCols<3>().colwise() - corners_m.col(0);
    gradient_per_m.rightCols<3>() = edges.inverse().transpose();
    gradient_per_m.col(0) = -gradient_per_m.rightCols<3>().rowwise().sum();
    return edges.determinant() / 6.0;
}

TetMatrix tet4_stiffness_N_per_m(const Tet& corners_m, const Material& material) {
    Tet gradient;
    const double volume_m3 = tet_gradients_per_m(corners_m, gradient);
    const Eigen::Map<const Eigen::Matrix<double, 12, 1>> column(gradient.data());
    const TetMatrix products = (volume_m3 * column) * column.transpose();
    TetMatrix K;
    stiffness_from_products(products, mu_Pa(material), lambda_Pa(material), K);
    return K;
}

Voigt mean_strain(const Hex& corners_m, const Hex& u_m) {
    return strain_of(u_m * hex_sums(corners_m).mean_gradient.transpose());
}

Voigt mean_strain(const Tet& corners_m, const Tet& u_m) {
    Tet gradient;
    tet_gradients_per_m(corners_m, gradient);
    return strain_of(u_m * gradient.transpose());
}

}  // namespace palpa::mechanics
