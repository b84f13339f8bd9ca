#include <Eigen/Geometry>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/elements.h"
#include "tests/close_to.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

constexpr Element kAll[] = {Element::hex8_bbar, Element::hex8, Element::tet4};

// Box of 3^3 cells whose inner nodes are pushed about.
Mesh irregular_box(Element element, unsigned seed) {
    Mesh mesh = hex_box({{0.1, 0.08, 0.06}, {3, 3, 3}, std::nullopt});
    std::mt19937 random(seed);
    std::uniform_real_distribution<double> push(-0.006, 0.006);
    const std::vector<int> outer = nodes_of(boundary_faces(mesh));
    for (int node = 0; node < mesh.nodes_m.cols(); ++node) {
        if (std::binary_search(outer.begin(), outer.end(), node)) continue;
        mesh.nodes_m.col(node) += Eigen::Vector3d(push(random), push(random), push(random));
    }
    return element == Element::tet4 ? split_to_tets(mesh) : mesh;
}

Hex random_hex(std::mt19937& random) {
    std::uniform_real_distribution<double> push(-0.15, 0.15);
    Hex x;
    x << 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 1, 1, 0, 0, 1, 1, 0, 0, 0, 0, 1, 1, 1, 1;
    for (int i = 0; i < x.size(); ++i) x.data()[i] += push(random);
    return 0.01 * x;
}

}  // namespace

TEST_CASE("patch test: linear displacements are exact on irregular meshes, all cells") {
    Eigen::Matrix3d gradient;
    gradient << 1e-3, 2e-3, -5e-4, 0.0, -2e-3, 1e-3, 3e-3, 1e-4, 5e-4;
    for (const Element element : kAll) {
        for (const double poisson : {0.0, 0.3, 0.4999}) {
            Problem problem;
            problem.mesh = irregular_box(element, 7);
            problem.element = element;
            const Material material{2500.0, poisson};
            problem.materials.assign(static_cast<std::size_t>(problem.mesh.cells.cols()), material);
            for (const int node : nodes_of(boundary_faces(problem.mesh))) {
                const Eigen::Vector3d u = gradient * problem.mesh.nodes_m.col(node);
                for (int c = 0; c < 3; ++c)
                    fix({node}, std::string_view("xyz").substr(static_cast<std::size_t>(c), 1), u(c), problem.supports);
            }
            const Factored factored = factorise(problem, best_solver());
            const Solution solution = solve(factored, Eigen::Matrix3Xd::Zero(3, problem.mesh.nodes_m.cols()));
            const Eigen::Matrix3Xd exact = gradient * problem.mesh.nodes_m;
            CAPTURE(static_cast<int>(element));
            CAPTURE(poisson);
            CHECK((solution.u_m - exact).cwiseAbs().maxCoeff() / exact.cwiseAbs().maxCoeff() < 1e-12);

            Voigt strain;
            strain << 1e-3, -2e-3, 5e-4, 2e-3, 1.1e-3, 2.5e-3;
            const CellFields fields = cell_fields(problem.mesh, problem.materials, solution.u_m);
            CHECK((fields.strain.colwise() - strain).cwiseAbs().maxCoeff() < 1e-12 * 3e-3 * 10);
            const Voigt stress = stress_Pa(material, strain);
            CHECK((fields.stress_Pa.colwise() - stress).cwiseAbs().maxCoeff() < 1e-11 * kappa_Pa(material) * 3e-3);
            CHECK(solution.energy_J == close_to(0.5 * stress.dot(strain) * factored.report.volume_m3).epsilon(1e-11));
        }
    }
}

TEST_CASE("stiffness: moving a cell rigidly makes no force, and the matrix is symmetric and positive") {
    std::mt19937 random(3);
    const Material material{2500.0, 0.49};
    for (int trial = 0; trial < 20; ++trial) {
        const Hex x = random_hex(random);
        for (const bool bbar : {true, false}) {
            const HexMatrix K = bbar ? hex8_bbar_stiffness_N_per_m(x, material) : hex8_stiffness_N_per_m(x, material);
            const double size = K.cwiseAbs().maxCoeff();
            CHECK((K - K.transpose()).cwiseAbs().maxCoeff() < 1e-14 * size);
            for (int axis = 0; axis < 3; ++axis) {
                Hex shift = Hex::Zero();
                shift.row(axis).setConstant(1e-3);
                Hex turn;
                for (int k = 0; k < 8; ++k) turn.col(k) = Eigen::Vector3d::Unit(axis).cross(x.col(k));
                CHECK((K * shift.reshaped()).cwiseAbs().maxCoeff() < 1e-12 * size * 1e-3);
                CHECK((K * turn.reshaped()).cwiseAbs().maxCoeff() < 1e-12 * size * 0.01);
            }
            const Hex u = Hex::Random();
            CHECK(u.reshaped().dot(K * u.reshaped()) > 0.0);
        }
    }
}

TEST_CASE("tet: rigid motions make no force; its energy is that of its constant strain") {
    Tet x;
    x << 0, 0.01, 0.002, 0.001, 0, 0.001, 0.012, 0.002, 0, 0.0, 0.001, 0.009;
    const Material material{2500.0, 0.45};
    const TetMatrix K = tet4_stiffness_N_per_m(x, material);
    Tet turn;
    for (int k = 0; k < 4; ++k) turn.col(k) = Eigen::Vector3d(1, 2, 3).cross(x.col(k));
    CHECK((K * turn.reshaped()).cwiseAbs().maxCoeff() < 1e-12 * K.cwiseAbs().maxCoeff() * 0.03);
    Tet gradient;
    const double volume = tet_gradients_per_m(x, gradient);
    const Tet u = 1e-3 * Tet::Random();
    const Voigt strain = mean_strain(x, u);
    CHECK(u.reshaped().dot(K * u.reshaped()) ==
          close_to(volume * strain.dot(stress_Pa(material, strain))).epsilon(1e-12));
}

TEST_CASE(
    "hexahedra: without volume change B-bar and full integration agree, near poisson 0.5 only B-bar stays "
    "soft") {
    std::mt19937 random(5);
    const Hex brick = hex_box({{0.01, 0.01, 0.01}, {1, 1, 1}, std::nullopt})
                          .nodes_m(Eigen::all, std::vector<int>{0, 1, 3, 2, 4, 5, 7, 6});
    Hex bend = Hex::Zero();  // u_x = x z': bending, whose mean volume change is zero
    for (int k = 0; k < 8; ++k) bend(0, k) = (brick(0, k) - 0.005) * (brick(2, k) - 0.005);
    const auto energy = [&](bool bbar, double poisson) {
        const Material m{2500.0, poisson};
        const HexMatrix K = bbar ? hex8_bbar_stiffness_N_per_m(brick, m) : hex8_stiffness_N_per_m(brick, m);
        return bend.reshaped().dot(K * bend.reshaped()) / mu_Pa(m);
    };
    CHECK(energy(false, 0.4999) > 100.0 * energy(true, 0.4999));
    CHECK(energy(true, 0.4999) == close_to(energy(true, 0.0)).epsilon(1e-9));
    const Hex shear = random_hex(random);
    Hex u = Hex::Zero();
    u.row(0) = 1e-3 * shear.row(1);
    const Material m{2500.0, 0.45};
    CHECK((hex8_stiffness_N_per_m(shear, m) * u.reshaped() - hex8_bbar_stiffness_N_per_m(shear, m) * u.reshaped())
              .norm() < 1e-12 * (hex8_stiffness_N_per_m(shear, m) * u.reshaped()).norm());
}
