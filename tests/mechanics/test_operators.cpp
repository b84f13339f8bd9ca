#include <doctest/doctest.h>
#include <random>

#include "mechanics/compliance.h"
#include "mechanics/error.h"
#include "mechanics/operators.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;
using palpa::test::contains;

namespace {

// A slab with a ball so stiff that it moves as a rigid body, lifted by 1 mm along its bottom.
Problem lifted_slab_with_ball() {
    Problem problem = calculix_problem(Element::hex8_bbar);
    for (Material& material : problem.materials) {
        if (material.young_Pa > 1e6) material.young_Pa = 1e15;
    }
    for (std::size_t i = 0; i < problem.supports.dof.size(); ++i) {
        if (problem.supports.dof[i] % 3 == 2) problem.supports.value_m[i] = 1e-3;
    }
    return problem;
}

// Sums over any nodes and axes, of `entries` dofs each.
std::vector<NodeSum> random_sums(const Mesh& mesh, int n, int entries, unsigned seed) {
    std::mt19937 random(seed);
    std::uniform_int_distribution<int> node(0, static_cast<int>(mesh.nodes_m.cols()) - 1);
    std::uniform_int_distribution<int> axis(0, 2);
    std::uniform_real_distribution<double> weight(-1.0, 1.0);
    std::vector<NodeSum> sums(static_cast<std::size_t>(n));
    for (NodeSum& sum : sums) {
        for (int i = 0; i < entries; ++i) sum.push_back({node(random), axis(random), weight(random)});
    }
    return sums;
}

Eigen::Matrix3Xd load_of(const NodeSum& sum, const Mesh& mesh) {
    Eigen::Matrix3Xd load_N = Eigen::Matrix3Xd::Zero(3, mesh.nodes_m.cols());
    for (const NodeWeight& entry : sum) load_N(entry.axis, entry.node) += entry.weight;
    return load_N;
}

}  // namespace

TEST_CASE(
    "responses: what a direct solution moves more than without the load, rigid bodies and lifted supports included") {
    const Problem problem = lifted_slab_with_ball();
    const Factored factored = factorise(problem, best_solver());
    const std::vector<NodeSum> observations = random_sums(problem.mesh, 40, 5, 1);
    const std::vector<NodeSum> loads = random_sums(problem.mesh, 9, 4, 2);
    const Eigen::MatrixXd W = responses(factored, observations, loads, 4);
    REQUIRE(W.rows() == 40);
    REQUIRE(W.cols() == 9);
    const Eigen::Matrix3Xd none = Eigen::Matrix3Xd::Zero(3, problem.mesh.nodes_m.cols());
    const Eigen::Matrix3Xd before_m = solve(factored, none).u_m;
    CHECK(before_m.cwiseAbs().maxCoeff() > 0.9e-3);
    for (Eigen::Index k = 0; k < W.cols(); ++k) {
        const NodeSum& load = loads[static_cast<std::size_t>(k)];
        const Eigen::Matrix3Xd moved_m = solve(factored, load_of(load, problem.mesh)).u_m - before_m;
        for (Eigen::Index i = 0; i < W.rows(); ++i) {
            const double expected =
                load_of(observations[static_cast<std::size_t>(i)], problem.mesh).cwiseProduct(moved_m).sum();
            CHECK(std::abs(W(i, k) - expected) < 1e-11 * W.cwiseAbs().maxCoeff());  // rounding of two solutions
        }
    }
}

TEST_CASE("responses: those of observations and loads swapped are the transpose") {
    const Problem problem = lifted_slab_with_ball();
    for (const SolverKind solver : {best_solver(), SolverKind::eigen}) {
        const Factored factored = factorise(problem, solver);
        const std::vector<NodeSum> observations = random_sums(problem.mesh, 25, 6, 3);
        const std::vector<NodeSum> loads = random_sums(problem.mesh, 12, 3, 4);
        const Eigen::MatrixXd W = responses(factored, observations, loads);
        const Eigen::MatrixXd swapped = responses(factored, loads, observations);
        CHECK((W - swapped.transpose()).cwiseAbs().maxCoeff() < 1e-12 * W.cwiseAbs().maxCoeff());
    }
}

TEST_CASE("responses: between the surface's nodes they are the surface compliance, to the last bit") {
    const Problem problem = calculix_problem(Element::hex8_bbar);
    const Factored factored = factorise(problem, best_solver());
    SurfaceRequest request = request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.03, 0.07, 0.03, 0.07});
    request.sideways = true;
    const Compliance c = surface_compliance(problem.mesh, factored, request);
    std::vector<NodeSum> observations;
    std::vector<NodeSum> loads;
    for (const int node : c.node) observations.push_back({{node, 2, -1.0}});
    for (const int node : c.node) observations.push_back({{node, 0, 1.0}});
    for (const int node : request.touch_nodes) loads.push_back({{node, 2, -1.0}});
    const Eigen::MatrixXd W = responses(factored, observations, loads, request.block);
    const Eigen::Index n = c.normal_m_per_N.rows();
    const Eigen::MatrixXd square = W.topRows(c.n_touch);
    CHECK(0.5 * (square + square.transpose()) == c.normal_m_per_N.topRows(c.n_touch));
    CHECK(W.middleRows(c.n_touch, n - c.n_touch) == c.normal_m_per_N.bottomRows(n - c.n_touch));
    CHECK(W.bottomRows(n) == c.along_x_m_per_N);
}

TEST_CASE("responses: the weights of one sum add up, an empty sum is nothing, nothing asked is nothing") {
    const Problem problem = calculix_problem(Element::hex8_bbar);
    const Factored factored = factorise(problem, best_solver());
    const int top = nearest_node(problem.mesh, 0.05, 0.05, 0.05);
    const NodeSum one{{top, 2, 1.0}};
    const NodeSum twice{{top, 2, 0.75}, {top, 2, 1.25}};
    const Eigen::MatrixXd W = responses(factored, {one, twice, {}}, {one, twice, {}});
    CHECK(W(0, 0) > 0.0);
    CHECK(W(1, 0) == close_to(2.0 * W(0, 0)).epsilon(1e-12));
    CHECK(W(1, 1) == close_to(4.0 * W(0, 0)).epsilon(1e-12));
    CHECK(W.row(2).isZero(0.0));
    CHECK(W.col(2).isZero(0.0));
    CHECK(responses(factored, {}, {one}).rows() == 0);
    CHECK(responses(factored, {one}, {}).cols() == 0);
}

TEST_CASE("responses: what the mesh does not have is refused by name") {
    Problem problem = calculix_problem(Element::hex8_bbar);
    problem.mesh.nodes_m.conservativeResize(3, problem.mesh.nodes_m.cols() + 1);
    const int loose = static_cast<int>(problem.mesh.nodes_m.cols()) - 1;
    problem.mesh.nodes_m.col(loose).setConstant(1.0);
    const Factored factored = factorise(problem, best_solver());
    const NodeSum good{{0, 2, 1.0}};
    const auto said = [&](const NodeSum& wrong) {
        CHECK_THROWS_AS(responses(factored, {good}, {wrong}), LoadError);
        try {
            responses(factored, {good, wrong}, {good});
        } catch (const LoadError& error) {
            return std::string(error.what());
        }
        return std::string();
    };
    CHECK(contains(said({{loose + 1, 2, 1.0}}), "observation 1: node 246 is not one of the mesh's 246"));
    CHECK(contains(said({{-1, 2, 1.0}}), "node -1 is not one of"));
    CHECK(contains(said({{4, 3, 1.0}}), "axis 3 of node 4, must be 0 ... 2"));
    CHECK(contains(said({{4, 0, std::nan("")}}), "the weight of node 4 is not finite"));
    CHECK(contains(said({{loose, 0, 1.0}}), "is in no cell, so it has no stiffness"));
    CHECK_THROWS_AS(responses(factored, {good}, {good}, 0), LoadError);
    std::atomic<bool> cancel = true;
    CHECK_THROWS_AS(responses(factored, {good}, {good}, 64, {{}, &cancel}), Cancelled);
}
