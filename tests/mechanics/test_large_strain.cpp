#include <chrono>
#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/error.h"
#include "mechanics/large_strain.h"
#include "mechanics/loads.h"
#include "tests/close_to.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

constexpr LargeMaterial kSilicone{Law::neo_hookean, 45e3, 430e3};

LargeProblem block_of(const Box& box, Element element, const LargeMaterial& material) {
    LargeProblem problem;
    problem.mesh = hex_box(box);
    if (element == Element::tet4) problem.mesh = split_to_tets(problem.mesh);
    problem.element = element;
    problem.materials.assign(static_cast<std::size_t>(problem.mesh.cells.cols()), material);
    return problem;
}

std::vector<int> side_nodes(const Mesh& mesh, Side side) {
    return nodes_of(faces_on(mesh, boundary_faces(mesh), side));
}

Eigen::Matrix3Xd no_load(const LargeProblem& problem) { return Eigen::Matrix3Xd::Zero(3, problem.mesh.nodes_m.cols()); }

double side_force_N(const LargeProblem& problem, const LargeSolution& solution, Side side) {
    double sum = 0.0;
    for (const int node : side_nodes(problem.mesh, side)) sum += solution.reaction_N(axis_of(side), node);
    return sum;
}

// The bonded block: its top comes down by a share of its height.
LargeProblem pressed_block(int n, Element element, const LargeMaterial& material, double share = 0.3) {
    LargeProblem problem = block_of({{0.02, 0.02, 0.02}, {n, n, n}, std::nullopt}, element, material);
    fix(side_nodes(problem.mesh, Side::zmin), "xyz", 0.0, problem.supports);
    fix(side_nodes(problem.mesh, Side::zmax), "xy", 0.0, problem.supports);
    fix(side_nodes(problem.mesh, Side::zmax), "z", -0.02 * share, problem.supports);
    return problem;
}

double pressed_N(int n, Element element, const LargeMaterial& material) {
    const LargeProblem problem = pressed_block(n, element, material);
    const LargeSolution solution = solve_large(problem, no_load(problem));
    REQUIRE(solution.status == LargeStatus::converged);
    CHECK(solution.residual < 1e-9);
    return side_force_N(problem, solution, Side::zmax);
}

}  // namespace

// CalculiX 2.20 (C3D8), FEniCSx 0.5.2 (Q1) and a prototype agree on these meshes to all digits printed.
TEST_CASE("bonded block, 30 % pressed: the split form is that of CalculiX and FEniCSx, mean volume that of Q1P0") {
    CHECK(pressed_N(4, Element::hex8, {Law::neo_hookean_split, 45e3, 430e3}) == close_to(-32.15270436).epsilon(1e-8));
    CHECK(pressed_N(8, Element::hex8_bbar, {Law::neo_hookean_split, 45e3, 4.3e6}) == close_to(-29.33882).epsilon(1e-6));
}

TEST_CASE("bonded block: to poisson 0.4999 the mean volume does not lock") {
    const double soft = pressed_N(4, Element::hex8_bbar, with_law({134.9e3, 0.499}, Law::neo_hookean));
    const double softer = pressed_N(4, Element::hex8_bbar, with_law({134.99e3, 0.4999}, Law::neo_hookean));
    CHECK(softer == close_to(soft).epsilon(0.01));
}

TEST_CASE("small loads: every law and element gives the linear answer") {
    for (const Element element : {Element::hex8_bbar, Element::hex8, Element::tet4}) {
        for (const Law law : {Law::neo_hookean, Law::neo_hookean_split, Law::stable_neo_hookean, Law::corotational}) {
            CAPTURE(name_of(law));
            CAPTURE(static_cast<int>(element));
            LargeProblem problem = block_of({{0.02, 0.02, 0.01}, {3, 3, 2}, std::nullopt}, element, kSilicone);
            for (LargeMaterial& m : problem.materials) m.law = law;
            fix(side_nodes(problem.mesh, Side::zmin), "xyz", 0.0, problem.supports);
            const Faces top = faces_on(problem.mesh, boundary_faces(problem.mesh), Side::zmax);
            const Eigen::Matrix3Xd load = traction_load(problem.mesh, top, {0.02, 0.0, -0.05});
            Problem linear{problem.mesh, element, {}, problem.supports};
            linear.materials.assign(problem.materials.size(), at_rest(kSilicone));
            const Solution expected = solve(factorise(linear, best_solver()), load);
            const LargeSolution found = solve_large(problem, load);
            REQUIRE(found.status == LargeStatus::converged);
            CHECK((found.u_m - expected.u_m).norm() < 1e-5 * expected.u_m.norm());
            CHECK((found.reaction_N - expected.reaction_N).norm() < 1e-5 * expected.reaction_N.norm());
        }
    }
}

TEST_CASE("a body that its supports turn by a right angle has no force") {
    LargeProblem problem = block_of({{0.02, 0.02, 0.02}, {2, 2, 2}, std::nullopt}, Element::hex8_bbar, kSilicone);
    const Mesh& mesh = problem.mesh;
    for (const int node : side_nodes(mesh, Side::zmin)) {
        const Eigen::Vector3d x = mesh.nodes_m.col(node);
        fix({node}, "x", -x.y() - x.x(), problem.supports);
        fix({node}, "y", x.x() - x.y(), problem.supports);
        fix({node}, "z", 0.0, problem.supports);
    }
    const LargeSolution solution = solve_large(problem, no_load(problem));
    REQUIRE(solution.status == LargeStatus::converged);
    CHECK(solution.energy_J < 1e-12);
    CHECK(solution.u_m.row(2).cwiseAbs().maxCoeff() < 1e-7);
}

// Euler: a column held at its foot leans from P = pi^2 E I / (4 L^2) on. A small force across decides the direction.
TEST_CASE(
    "buckling strip: straight is reported as unstable, and a small load across finds the bent strip, which is stable") {
    LargeProblem problem = block_of({{0.1, 0.02, 0.004}, {40, 2, 2}, std::nullopt}, Element::hex8_bbar, kSilicone);
    fix(side_nodes(problem.mesh, Side::xmin), "xyz", 0.0, problem.supports);
    const Faces end = faces_on(problem.mesh, boundary_faces(problem.mesh), Side::xmax);
    const double E_Pa = at_rest(kSilicone).young_Pa;
    const double inertia_m4 = 0.02 * std::pow(0.004, 3) / 12.0;
    const double euler_N = std::pow(std::acos(-1.0), 2) * E_Pa * inertia_m4 / (4.0 * 0.1 * 0.1);
    const auto loaded = [&](double share, double across_Pa) {
        return solve_large(problem, traction_load(problem.mesh, end, {-share * euler_N / 8e-5, 0.0, across_Pa}));
    };
    CHECK(loaded(0.8, 0.0).stable);
    const LargeSolution straight = loaded(1.3, 0.0);
    const LargeSolution bent = loaded(1.3, 0.01);
    REQUIRE(straight.status == LargeStatus::converged);
    REQUIRE(bent.status == LargeStatus::converged);
    CHECK_FALSE(straight.stable);
    CHECK(bent.stable);
    CHECK(bent.repairs > 0);
    CHECK(straight.u_m.row(2).cwiseAbs().maxCoeff() < 1e-4);
    CHECK(bent.u_m.row(2).cwiseAbs().maxCoeff() > 0.04);
}

TEST_CASE("scrambled nodes: a block of the stable form goes back to its rest shape") {
    constexpr unsigned kSeed = 3;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    std::uniform_real_distribution<double> push(-0.0015, 0.0015);
    LargeProblem problem = pressed_block(4, Element::hex8, {Law::stable_neo_hookean, 45e3, 430e3}, 0.0);
    Eigen::Matrix3Xd start = no_load(problem);
    for (int i = 0; i < start.size(); ++i) start.data()[i] = push(random);
    LargeOptions options;
    options.most_iterations = 200;
    const LargeSolution solution = solve_large(problem, no_load(problem), options, start);
    CHECK(solution.status == LargeStatus::converged);
    CHECK(solution.u_m.cwiseAbs().maxCoeff() < 1e-9);
    CHECK(solution.energy_J < 1e-12);
}

TEST_CASE("failure is a status with the last equilibrium, not a wild result") {
    // the top would have to come out below the bottom
    const LargeProblem problem = pressed_block(3, Element::hex8_bbar, kSilicone, 1.2);
    LargeOptions options;
    options.most_halvings = 3;
    const LargeSolution solution = solve_large(problem, no_load(problem), options);
    CHECK(solution.status == LargeStatus::stopped);
    CHECK(solution.load_share < 1.0);
    CHECK(solution.u_m.allFinite());
    CHECK(std::isfinite(solution.energy_J));
    CHECK(solution.residual < 1e-9);
}

TEST_CASE("solvers agree, and what cannot be computed with is refused") {
    const LargeProblem problem = pressed_block(3, Element::hex8_bbar, kSilicone);
    LargeOptions options;
    options.solver = SolverKind::eigen;
    const LargeSolution eigen = solve_large(problem, no_load(problem), options);
    const LargeSolution chosen = solve_large(problem, no_load(problem));
    CHECK(chosen.solver == (mumps_built_in() ? SolverKind::banded : SolverKind::eigen));
    CHECK((eigen.u_m - chosen.u_m).norm() < 1e-10 * eigen.u_m.norm());
    CHECK_THROWS_AS(solve_large(problem, Eigen::Matrix3Xd::Zero(3, 2)), LoadError);
    LargeProblem loose = problem;
    loose.supports = {};
    CHECK_THROWS_AS(solve_large(loose, no_load(problem)), SupportError);
    LargeProblem linear = problem;
    linear.materials[2].law = Law::linear;
    CHECK_THROWS_AS(solve_large(linear, no_load(problem)), MaterialError);
    const Eigen::Matrix3Xd flat = -problem.mesh.nodes_m;
    CHECK_THROWS_AS(solve_large(problem, no_load(problem), {}, flat), LoadError);
}
