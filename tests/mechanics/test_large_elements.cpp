#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/large_elements.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

constexpr Law kEvery[] = {Law::neo_hookean, Law::neo_hookean_split, Law::stable_neo_hookean, Law::corotational};
constexpr unsigned kPoseSeed = 5;

const Hex kCube = [] {
    Hex x;
    x << 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1;
    return Hex(0.01 * x);
}();
const Tet kCorner = [] {
    Tet x;
    x << 0, 0.01, 0.002, 0.001, 0, 0.001, 0.012, 0.002, 0, 0.0, 0.001, 0.009;
    return x;
}();

template <int N>
Eigen::Matrix<double, 3, N> pushed(const Eigen::Matrix<double, 3, N>& x_m, double most_m, std::mt19937& random) {
    std::uniform_real_distribution<double> push(-most_m, most_m);
    Eigen::Matrix<double, 3, N> out = x_m;
    for (int i = 0; i < out.size(); ++i) out.data()[i] += push(random);
    return out;
}

template <int N>
LargeCell<N> tangent_of(const CellRest<N>& rest, const LargeMaterial& m, bool mean,
                        const Eigen::Matrix<double, 3, N>& x) {
    LargeCell<N> out;
    large_cell<N>(rest, m, mean, x, Wanted::tangent, out);
    return out;
}

// Turned and deformed poses of an irregular cell: gradient against energy, tangent against gradient.
template <int N>
void check_slopes(const Eigen::Matrix<double, 3, N>& shape, bool mean) {
    CAPTURE(kPoseSeed);
    std::mt19937 random(kPoseSeed);
    for (const Law law : kEvery) {
        for (int trial = 0; trial < 3; ++trial) {
            CAPTURE(name_of(law));
            CAPTURE(mean);
            const Eigen::Matrix<double, 3, N> rest_m = pushed<N>(shape, 0.0008, random);
            const CellRest<N> rest = rest_of(rest_m);
            const LargeMaterial material{law, 45e3, trial == 2 ? 2.25e8 : 430e3};  // the last has poisson 0.4999
            const Eigen::Matrix3d turn = Eigen::AngleAxisd(1.7, Eigen::Vector3d(1, 2, -1).normalized()).matrix();
            const Eigen::Matrix<double, 3, N> x = pushed<N>(turn * rest_m, 0.001, random);
            const LargeCell<N> here = tangent_of<N>(rest, material, mean, x);
            REQUIRE(std::isfinite(here.energy_J));
            constexpr double h = 1e-7;
            const double f_size = here.gradient_N.cwiseAbs().maxCoeff();
            const double K_size = here.tangent_N_per_m.cwiseAbs().maxCoeff();
            for (int i = 0; i < 3 * N; ++i) {
                Eigen::Matrix<double, 3, N> high = x;
                Eigen::Matrix<double, 3, N> low = x;
                high.data()[i] += h;
                low.data()[i] -= h;
                const LargeCell<N> up = tangent_of<N>(rest, material, mean, high);
                const LargeCell<N> down = tangent_of<N>(rest, material, mean, low);
                CHECK(std::abs((up.energy_J - down.energy_J) / (2.0 * h) - here.gradient_N.data()[i]) < 1e-6 * f_size);
                const Eigen::Matrix<double, 3, N> slope = (up.gradient_N - down.gradient_N) / (2.0 * h);
                CHECK((slope.reshaped() - here.tangent_N_per_m.col(i)).cwiseAbs().maxCoeff() < 1e-6 * K_size);
            }
            CHECK((here.tangent_N_per_m - here.tangent_N_per_m.transpose()).cwiseAbs().maxCoeff() < 1e-12 * K_size);
            CHECK(here.gradient_N.rowwise().sum().norm() < 1e-12 * f_size);
        }
    }
}

}  // namespace

TEST_CASE("large cells: force is minus the slope of energy, tangent the slope of force") {
    check_slopes<8>(kCube, true);
    check_slopes<8>(kCube, false);
    check_slopes<4>(kCorner, false);
}

TEST_CASE("large cells: at rest the tangent is the linear stiffness, and a turned cell has no force") {
    std::mt19937 random(kPoseSeed);
    const Hex x = pushed<8>(kCube, 0.001, random);
    const Eigen::Matrix3d turn = Eigen::AngleAxisd(2.0, Eigen::Vector3d::UnitY()).matrix();
    for (const Law law : kEvery) {
        const LargeMaterial m{law, 45e3, 430e3};
        CAPTURE(name_of(law));
        const auto same = [&](const auto& here, const auto& K) {
            CHECK((here.tangent_N_per_m - K).cwiseAbs().maxCoeff() < 1e-13 * K.cwiseAbs().maxCoeff());
        };
        same(tangent_of<8>(rest_of(x), m, true, x), hex8_bbar_stiffness_N_per_m(x, at_rest(m)));
        same(tangent_of<8>(rest_of(x), m, false, x), hex8_stiffness_N_per_m(x, at_rest(m)));
        same(tangent_of<4>(rest_of(kCorner), m, false, kCorner), tet4_stiffness_N_per_m(kCorner, at_rest(m)));
        for (const bool mean : {true, false}) {
            const LargeCell<8> turned = tangent_of<8>(rest_of(x), m, mean, turn * x);
            CHECK(turned.gradient_N.cwiseAbs().maxCoeff() < 1e-12 * 430e3 * 1e-4);
            CHECK(turned.energy_J < 1e-12 * 430e3 * 1e-6);
        }
    }
}

TEST_CASE("large cells: with the mean volume a bent cell near poisson 0.5 stays soft") {
    Hex bent = kCube;
    for (int k = 0; k < 8; ++k) bent(0, k) += 20.0 * (kCube(0, k) - 0.005) * (kCube(2, k) - 0.005);
    for (const Law law : kEvery) {
        CAPTURE(name_of(law));
        const LargeMaterial m{law, 45e3, 2.25e8};
        CHECK(tangent_of<8>(rest_of(kCube), m, false, bent).energy_J >
              100.0 * tangent_of<8>(rest_of(kCube), m, true, bent).energy_J);
    }
}

TEST_CASE("large cells: inside out, the energy is infinite or finite as the law says") {
    Hex inverted = kCube;
    inverted.row(2) *= -0.2;
    LargeCell<8> cell;
    for (const Law law : kEvery) {
        CAPTURE(name_of(law));
        for (const bool mean : {true, false}) {
            large_cell<8>(rest_of(kCube), {law, 45e3, 430e3}, mean, inverted, Wanted::energy, cell);
            const bool finite = law == Law::corotational || (law == Law::stable_neo_hookean && !mean);
            CHECK(std::isfinite(cell.energy_J) == finite);
        }
    }
}

TEST_CASE("large cells: the repaired tangent has no negative eigenvalue and keeps the others") {
    Hex pressed = kCube;
    pressed.row(2) *= 0.5;
    LargeCell<8> cell = tangent_of<8>(rest_of(kCube), {Law::neo_hookean, 45e3, 430e3}, true, pressed);
    const Eigen::VectorXd before = Eigen::SelfAdjointEigenSolver<HexMatrix>(cell.tangent_N_per_m).eigenvalues();
    make_positive<8>(cell.tangent_N_per_m);
    const Eigen::VectorXd after = Eigen::SelfAdjointEigenSolver<HexMatrix>(cell.tangent_N_per_m).eigenvalues();
    REQUIRE(before(0) < -1e-3 * before(23));
    CHECK((after - before.cwiseMax(0.0)).cwiseAbs().maxCoeff() < 1e-12 * before(23));
}

TEST_CASE("large cells: strain and stress of a stretched brick") {
    Hex stretched = kCube;
    stretched.row(2) *= 1.2;
    for (const bool mean : {true, false}) {
        const LargeMaterial m{Law::neo_hookean_split, 45e3, 430e3};
        const LargeFields fields = large_fields<8>(rest_of(kCube), m, mean, stretched);
        CHECK(fields.strain(2) == close_to(0.5 * (1.44 - 1.0)));
        const Eigen::Matrix3d stress = cauchy_stress_Pa(m, Eigen::Vector3d(1, 1, 1.2).asDiagonal().toDenseMatrix());
        CHECK(fields.stress_Pa(2) == close_to(stress(2, 2)));
        // the corners' forces on the top are the stress times the area
        const LargeCell<8> cell = tangent_of<8>(rest_of(kCube), m, mean, stretched);
        CHECK(cell.gradient_N.rightCols<4>().row(2).sum() == close_to(1e-4 * stress(2, 2)));
    }
}
