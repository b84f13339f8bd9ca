#include <Eigen/LU>
#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <random>
#include <vector>

#include "mechanics/error.h"
#include "mechanics/hyperelastic.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

constexpr Law kLaws[] = {Law::neo_hookean, Law::neo_hookean_split, Law::stable_neo_hookean};
constexpr double kMu = 45e3;  // the silicone of the soft devices
constexpr double kKappa = 430e3;

// Force per rest area of a bar that is free to become thinner, Pa: the lateral stretch makes the lateral stress 0.
double uniaxial_Pa(const LargeMaterial& material, double stretch) {
    const auto stress = [&](double lateral) {
        return cauchy_stress_Pa(material, Eigen::Vector3d(stretch, lateral, lateral).asDiagonal().toDenseMatrix());
    };
    double low = 0.3;
    double high = 2.0;
    for (int i = 0; i < 200; ++i) {
        const double middle = 0.5 * (low + high);
        (stress(middle)(1, 1) > 0.0 ? high : low) = middle;
    }
    return stress(low)(0, 0) * low * low;
}

}  // namespace

TEST_CASE("laws: at rest there is neither energy nor stress, and the moduli are those given") {
    for (const Law law : {Law::neo_hookean, Law::neo_hookean_split, Law::stable_neo_hookean, Law::corotational}) {
        CAPTURE(name_of(law));
        const LargeMaterial material{law, kMu, kKappa};
        CHECK(cauchy_stress_Pa(material, Eigen::Matrix3d::Identity()).cwiseAbs().maxCoeff() < 1e-9 * kKappa);
        constexpr double h = 1e-6;
        Eigen::Matrix3d shear = Eigen::Matrix3d::Identity();
        shear(0, 1) = h;
        CHECK(cauchy_stress_Pa(material, shear)(0, 1) / h == close_to(kMu).epsilon(1e-5));
        const Eigen::Matrix3d swollen = (1.0 + h / 3.0) * Eigen::Matrix3d::Identity();
        CHECK(cauchy_stress_Pa(material, swollen).trace() / (3.0 * h) == close_to(kKappa).epsilon(1e-5));
        if (law == Law::corotational) continue;
        CHECK(std::abs(energy_density(material, 3.0, 1.0).W_Pa) < 1e-12 * kMu);
    }
}

TEST_CASE("laws: derivatives are the slopes of the energy, by I and J and by A and J") {
    constexpr double h = 1e-5;
    for (const Law law : kLaws) {
        const LargeMaterial material{law, kMu, kKappa};
        for (const bool split : {false, true}) {
            const auto at = [&](double I, double J) {
                return split ? split_energy_density(material, I, J) : energy_density(material, I, J);
            };
            for (const double I : {3.0, 3.4, 5.0}) {
                for (const double J : {0.6, 1.0, 1.7}) {
                    CAPTURE(name_of(law));
                    CAPTURE(split);
                    CAPTURE(I);
                    CAPTURE(J);
                    const EnergyDensity e = at(I, J);
                    const auto slope = [&](auto field) {
                        return std::array{(field(at(I + h, J)) - field(at(I - h, J))) / (2.0 * h),
                                          (field(at(I, J + h)) - field(at(I, J - h))) / (2.0 * h)};
                    };
                    const auto W = slope([](const EnergyDensity& x) { return x.W_Pa; });
                    const auto dI = slope([](const EnergyDensity& x) { return x.I; });
                    const auto dJ = slope([](const EnergyDensity& x) { return x.J; });
                    const double near = 1e-6 * kKappa;  // differences of values near kappa
                    CHECK(std::abs(e.I - W[0]) < near);
                    CHECK(std::abs(e.J - W[1]) < near);
                    CHECK(std::abs(e.II - dI[0]) < near);
                    CHECK(std::abs(e.IJ - dI[1]) < near);
                    CHECK(std::abs(e.IJ - dJ[0]) < near);
                    CHECK(std::abs(e.JJ - dJ[1]) < near);
                }
            }
        }
    }
}

// The reference: closed forms, and CalculiX 2.20 (C3D8, one element), which agrees with the split form to 4e-7.
TEST_CASE("laws: a bar pulled and pressed has the known forces") {
    struct Row {
        double stretch, split_Pa, log_Pa, calculix_Pa;
    };
    constexpr Row kRows[] = {{0.6, -95165.967379, -90312.866408, -95165.96},
                             {0.8, -33299.184580, -32597.409607, -33299.184},
                             {1.2, 21838.522454, 22210.069617, 21838.524},
                             {1.5, 45018.503793, 46790.901319, 45018.520},
                             {2.0, 72721.374897, 78135.557340, 72721.360}};
    for (const Row& row : kRows) {
        CAPTURE(row.stretch);
        const double split_Pa = uniaxial_Pa({Law::neo_hookean_split, kMu, kKappa}, row.stretch);
        CHECK(split_Pa == close_to(row.split_Pa).epsilon(1e-10));
        CHECK(split_Pa == close_to(row.calculix_Pa).epsilon(4e-7));
        CHECK(uniaxial_Pa({Law::neo_hookean, kMu, kKappa}, row.stretch) == close_to(row.log_Pa).epsilon(1e-10));
    }
}

TEST_CASE("laws: the log and the split form are infinite at J <= 0, the stable form is not") {
    for (const double J : {0.0, -0.3}) {
        CHECK(std::isinf(energy_density({Law::neo_hookean, kMu, kKappa}, 3.0, J).W_Pa));
        CHECK(std::isinf(energy_density({Law::neo_hookean_split, kMu, kKappa}, 3.0, J).W_Pa));
        CHECK(std::isfinite(energy_density({Law::stable_neo_hookean, kMu, kKappa}, 3.0, J).W_Pa));
        CHECK(std::isinf(split_energy_density({Law::stable_neo_hookean, kMu, kKappa}, 3.0, J).W_Pa));
    }
}

TEST_CASE("stretches: F = U s V^T with rotations, inside out too") {
    constexpr unsigned kSeed = 11;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> entry(-1.0, 1.0);
    for (int trial = 0; trial < 50; ++trial) {
        Eigen::Matrix3d F;
        for (int i = 0; i < 9; ++i) F.data()[i] = entry(random);
        const Stretches s = stretches_of(F);
        CHECK((s.U * s.s.asDiagonal() * s.V.transpose() - F).norm() < 1e-14);
        CHECK(s.rotation().determinant() == close_to(1.0));
        CHECK(s.s.prod() == close_to(F.determinant()));
    }
}

TEST_CASE("laws: moduli at rest go there and back, and wrong ones are refused") {
    const LargeMaterial silicone{Law::neo_hookean, kMu, kKappa};
    const Material rest = at_rest(silicone);
    CHECK(rest.young_Pa == close_to(130.4e3).epsilon(1e-3));
    CHECK(rest.poisson == close_to(0.4494).epsilon(1e-4));
    CHECK(with_law(rest, Law::neo_hookean).kappa_Pa == close_to(kKappa).epsilon(1e-12));
    for (const LargeMaterial& bad : {LargeMaterial{Law::neo_hookean, 0.0, 1.0}, LargeMaterial{Law::linear, 1.0, 1.0},
                                     LargeMaterial{Law::corotational, 1.0, std::nan("")}})
        CHECK_THROWS_AS(check_large_materials(std::vector{silicone, bad}), MaterialError);
}
