#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/large_body.h"
#include "mechanics/large_hex8i.h"
#include "mechanics/statics.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

const Material kRubber{130.4e3, 0.4494};

// A brick whose corners are moved by a tenth.
Hex odd_brick(std::mt19937_64& random) {
    std::normal_distribution<double> normal;
    Hex X;
    X << 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1;
    X *= 0.01;
    for (Eigen::Index i = 0; i < X.size(); ++i) X.data()[i] += 5e-4 * normal(random);
    return X;
}

Eigen::Matrix3d some_turn() {
    return Eigen::AngleAxisd(1.1, Eigen::Vector3d(1.0, 2.0, -1.0).normalized()).toRotationMatrix();
}

}  // namespace

TEST_CASE("hex8i: force is minus the slope of energy, tangent the slope of force") {
    constexpr std::uint64_t kSeed = 3;
    CAPTURE(kSeed);
    std::mt19937_64 random(kSeed);
    std::normal_distribution<double> normal;
    for (int pose = 0; pose < 5; ++pose) {
        const IncompatibleRest rest = incompatible_rest_of(odd_brick(random), kRubber);
        Hex x = rest.corners_m;
        for (Eigen::Index i = 0; i < x.size(); ++i) x.data()[i] += 1.5e-3 * normal(random);
        x = some_turn() * x;
        LargeCell<8> cell, high, low;
        incompatible_cell(rest, x, Wanted::tangent, cell);
        constexpr double kStep_m = 1e-7;
        for (Eigen::Index i = 0; i < 24; ++i) {
            Hex up = x, down = x;
            up.data()[i] += kStep_m;
            down.data()[i] -= kStep_m;
            incompatible_cell(rest, up, Wanted::gradient, high);
            incompatible_cell(rest, down, Wanted::gradient, low);
            const double slope_N = (high.energy_J - low.energy_J) / (2.0 * kStep_m);
            CHECK(std::abs(slope_N - cell.gradient_N.data()[i]) < 1e-8 * cell.gradient_N.norm());
            const Hex slope = (high.gradient_N - low.gradient_N) / (2.0 * kStep_m);
            const Eigen::Map<const Eigen::Matrix<double, 24, 1>> column(slope.data());
            CHECK((column - cell.tangent_N_per_m.col(i)).norm() < 1e-8 * cell.tangent_N_per_m.norm());
        }
    }
}

TEST_CASE("hex8i: moving it rigidly makes no force, and at rest its tangent is the linear stiffness") {
    std::mt19937_64 random(4);
    const Hex X = odd_brick(random);
    const IncompatibleRest rest = incompatible_rest_of(X, kRubber);
    LargeCell<8> cell;
    incompatible_cell(rest, X, Wanted::tangent, cell);
    const HexMatrix K = hex8i_stiffness_N_per_m(X, kRubber);
    CHECK((cell.tangent_N_per_m - K).norm() < 1e-12 * K.norm());
    const Hex moved = (some_turn() * X).colwise() + Eigen::Vector3d(0.3, -0.1, 0.2);
    incompatible_cell(rest, moved, Wanted::gradient, cell);
    CHECK(cell.gradient_N.norm() < 1e-12 * K.norm() * 0.01);
}

TEST_CASE("hex8i: a uniform strain is exact in an odd cell") {
    std::mt19937_64 random(6);
    const Hex X = odd_brick(random);
    Eigen::Matrix3d strain;
    strain << 1e-3, 2e-4, 0.0, 2e-4, -5e-4, 3e-4, 0.0, 3e-4, 2e-4;
    const Hex u = strain * X;
    const Eigen::Map<const Eigen::Matrix<double, 24, 1>> column(u.data());
    const auto energy_J = [&](const HexMatrix& K) { return 0.5 * column.dot(K * column); };
    const double full_J = energy_J(hex8_stiffness_N_per_m(X, kRubber));
    CHECK(energy_J(hex8i_stiffness_N_per_m(X, kRubber)) == close_to(full_J).epsilon(1e-10));
}

TEST_CASE("hex8i: one cell through bends as beam theory says, where hex8 is far too stiff") {
    // a strip of 20 x 1 x 1 cells, one end held, a couple at the other: w = M L^2 / (2 E I), nu = 0
    const Material material{1e5, 0.0};
    Box box;
    box.size_m = {0.1, 0.005, 0.002};
    box.cells = {20, 1, 1};
    const Mesh mesh = hex_box(box);
    const auto tip_m = [&](Element element) {
        Problem problem;
        problem.mesh = mesh;
        problem.element = element;
        problem.materials.assign(20, material);
        const Faces outer = boundary_faces(mesh);
        fix(nodes_of(faces_on(mesh, outer, Side::xmin)), "xyz", 0.0, problem.supports);
        Eigen::Matrix3Xd load_N = Eigen::Matrix3Xd::Zero(3, mesh.nodes_m.cols());
        for (const int node : nodes_of(faces_on(mesh, outer, Side::xmax)))
            load_N(0, node) = mesh.nodes_m(2, node) > 0.001 ? -1e-5 : 1e-5;
        const Solution solution = solve(factorise(problem, best_solver()), load_N);
        double sum = 0.0;
        for (const int node : nodes_of(faces_on(mesh, outer, Side::xmax))) sum += 0.25 * solution.u_m(2, node);
        return sum;
    };
    const double moment_Nm = 2.0 * 1e-5 * 0.002;
    const double expected_m = moment_Nm * 0.1 * 0.1 / (2.0 * 1e5 * 0.005 * 8e-9 / 12.0);
    CHECK(std::abs(tip_m(Element::hex8i)) == close_to(expected_m).epsilon(0.002));
    CHECK(std::abs(tip_m(Element::hex8)) < 0.5 * expected_m);
}

TEST_CASE("hex8i: another law than corotational is refused") {
    Box box;
    box.cells = {1, 1, 1};
    CHECK_THROWS_AS(make_large_body(hex_box(box), Element::hex8i, {LargeMaterial{}}), MaterialError);
}
