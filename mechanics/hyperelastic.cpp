#include "mechanics/hyperelastic.h"

#include <Eigen/Geometry>
#include <Eigen/LU>
#include <Eigen/SVD>
#include <algorithm>
#include <cassert>
#include <cmath>
#include <limits>
#include <vector>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

double lambda_of(const LargeMaterial& m) { return m.kappa_Pa - 2.0 * m.mu_Pa / 3.0; }

EnergyDensity undefined() { return {std::numeric_limits<double>::infinity()}; }

EnergyDensity log_form(double mu, double lambda, double I, const VolumeChange& volume) {
    const double J = volume.J;
    const double ln = volume.log;
    EnergyDensity e;
    e.W_Pa = 0.5 * mu * (I - 3.0) - mu * ln + 0.5 * lambda * ln * ln;
    e.I = 0.5 * mu;
    e.J = (lambda * ln - mu) / J;
    e.JJ = (lambda * (1.0 - ln) + mu) / (J * J);
    return e;
}

EnergyDensity split_form(double mu, double kappa, double I, const VolumeChange& volume) {
    const double J = volume.J;
    const double c = 1.0 / volume.two_thirds;
    EnergyDensity e;
    e.W_Pa = 0.5 * mu * (c * I - 3.0) + 0.5 * kappa * (J - 1.0) * (J - 1.0);
    e.I = 0.5 * mu * c;
    e.J = -mu * c * I / (3.0 * J) + kappa * (J - 1.0);
    e.IJ = -mu * c / (3.0 * J);
    e.JJ = 5.0 * mu * c * I / (9.0 * J * J) + kappa;
    return e;
}

EnergyDensity stable_form(double mu, double lambda, double I, double J) {
    const double m = 4.0 / 3.0 * mu;
    const double l = lambda + 5.0 / 6.0 * mu;
    const double a = 1.0 + 0.75 * m / l;
    EnergyDensity e;
    // (J - a)^2 - (1 - a)^2 as a product, since a may be close to 1
    e.W_Pa = 0.5 * m * (I - 3.0) + 0.5 * l * (J - 1.0) * (J + 1.0 - 2.0 * a) - 0.5 * m * std::log(0.25 * (I + 1.0));
    e.I = 0.5 * m * I / (I + 1.0);
    e.J = l * (J - a);
    e.II = 0.5 * m / ((I + 1.0) * (I + 1.0));
    e.JJ = l;
    return e;
}

EnergyDensity density_at(const LargeMaterial& m, double I, const VolumeChange& volume) {
    switch (m.law) {
        case Law::neo_hookean:
            return volume.J > 0.0 ? log_form(m.mu_Pa, lambda_of(m), I, volume) : undefined();
        case Law::neo_hookean_split:
            return volume.J > 0.0 ? split_form(m.mu_Pa, m.kappa_Pa, I, volume) : undefined();
        case Law::stable_neo_hookean:
            return stable_form(m.mu_Pa, lambda_of(m), I, volume.J);
        case Law::linear:
        case Law::corotational:
            break;
    }
    assert(false && "not a law W(I, J)");
    return undefined();
}

}  // namespace

void check_large_materials(std::span<const LargeMaterial> materials) {
    std::vector<int> bad;
    for (std::size_t i = 0; i < materials.size(); ++i) {
        const LargeMaterial& m = materials[i];
        const bool good = std::isfinite(m.mu_Pa) && m.mu_Pa > 0.0 && std::isfinite(m.kappa_Pa) && m.kappa_Pa > 0.0 &&
                          m.law != Law::linear;
        if (!good) bad.push_back(static_cast<int>(i));
    }
    if (bad.empty()) return;
    const LargeMaterial& first = materials[static_cast<std::size_t>(bad.front())];
    throw MaterialError(text("material ", bad.front(), ": law ", name_of(first.law), ", mu_Pa ", first.mu_Pa,
                             ", kappa_Pa ", first.kappa_Pa, "; wanted a law for large strains and moduli > 0 (",
                             bad.size(), " of ", materials.size(), " materials are wrong)"),
                        bad);
}

Material at_rest(const LargeMaterial& m) {
    const double sum = 3.0 * m.kappa_Pa + m.mu_Pa;
    return {9.0 * m.kappa_Pa * m.mu_Pa / sum, (3.0 * m.kappa_Pa - 2.0 * m.mu_Pa) / (2.0 * sum)};
}

LargeMaterial with_law(const Material& material, Law law) { return {law, mu_Pa(material), kappa_Pa(material)}; }

VolumeChange volume_change(double J) {
    const double root = std::cbrt(J);
    return {J, root * root, J > 0.0 ? std::log(J) : std::numeric_limits<double>::quiet_NaN()};
}

EnergyDensity energy_density(const LargeMaterial& m, double I, double J) { return density_at(m, I, volume_change(J)); }

EnergyDensity split_energy_density(const LargeMaterial& material, double A, const VolumeChange& volume) {
    const double J = volume.J;
    if (!(J > 0.0)) return undefined();
    const double c = volume.two_thirds;      // I = c A
    const double slope = 2.0 / 3.0 * c / J;  // dc/dJ
    const EnergyDensity w = density_at(material, c * A, volume);
    EnergyDensity e;
    e.W_Pa = w.W_Pa;
    e.I = c * w.I;
    e.J = slope * A * w.I + w.J;
    e.II = c * c * w.II;
    e.IJ = slope * w.I + c * (slope * A * w.II + w.IJ);
    e.JJ = slope * A * (slope * A * w.II + 2.0 * w.IJ) - slope / (3.0 * J) * A * w.I + w.JJ;
    return e;
}

Stretches stretches_of(const Eigen::Matrix3d& F) {
    const Eigen::JacobiSVD<Eigen::Matrix3d> svd(F, Eigen::ComputeFullU | Eigen::ComputeFullV);
    Stretches out{svd.matrixU(), svd.matrixV(), svd.singularValues()};
    if (out.U.determinant() < 0.0) {
        out.U.col(2) *= -1.0;
        out.s(2) *= -1.0;
    }
    if (out.V.determinant() < 0.0) {
        out.V.col(2) *= -1.0;
        out.s(2) *= -1.0;
    }
    return out;
}

namespace {

// R and S of an F that is far from singular; false where the iteration does not settle.
bool polar_by_newton(const Eigen::Matrix3d& F, Eigen::Matrix3d& R) {
    constexpr double kNearSingular = 1e-3;  // det F over its size cubed
    R = F;
    const double size = F.norm();
    if (!(F.determinant() > kNearSingular * size * size * size)) return false;
    for (int i = 0; i < 12; ++i) {
        Eigen::Matrix3d cofactor;
        cofactor << R.col(1).cross(R.col(2)), R.col(2).cross(R.col(0)), R.col(0).cross(R.col(1));
        const double det = R.col(0).dot(cofactor.col(0));
        const Eigen::Matrix3d change = 0.5 * (cofactor / det - R);
        R += change;
        if (change.squaredNorm() < 1e-16) return true;  // the next change would be its square
    }
    return false;
}

}  // namespace

Polar polar_of(const Eigen::Matrix3d& F) {
    constexpr double kLeastSum = 1e-4;  // of two stretches
    Polar out;
    if (polar_by_newton(F, out.R)) {
        const Eigen::Matrix3d S = out.R.transpose() * F;
        out.S = 0.5 * (S + S.transpose());
        out.inverse = (out.S.trace() * Eigen::Matrix3d::Identity() - out.S).inverse();
        return out;
    }
    const Stretches stretches = stretches_of(F);
    out.R = stretches.rotation();
    out.S = stretches.V * stretches.s.asDiagonal() * stretches.V.transpose();
    Eigen::Vector3d slope;
    for (int i = 0; i < 3; ++i)
        slope(i) = 1.0 / std::max(stretches.s((i + 1) % 3) + stretches.s((i + 2) % 3), kLeastSum);
    out.inverse = stretches.V * slope.asDiagonal() * stretches.V.transpose();
    return out;
}

Eigen::Matrix3d cauchy_stress_Pa(const LargeMaterial& m, const Eigen::Matrix3d& F) {
    const double J = F.determinant();
    if (m.law == Law::corotational) {
        const Stretches stretches = stretches_of(F);
        const Eigen::Matrix3d R = stretches.rotation();
        const Eigen::Matrix3d P = 2.0 * m.mu_Pa * (F - R) + lambda_of(m) * (stretches.s.sum() - 3.0) * R;
        return P * F.transpose() / J;
    }
    const EnergyDensity w = energy_density(m, F.squaredNorm(), J);
    return 2.0 * w.I / J * F * F.transpose() + w.J * Eigen::Matrix3d::Identity();
}

}  // namespace palpa::mechanics
