#include <doctest/doctest.h>

#include "mechanics/compliance.h"
#include "mechanics/error.h"
#include "tests/close_to.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

Problem small_slab() {
    return slab_problem(hex_box(graded_box(0.1, 0.05, 10, 5, 0.005)), Element::hex8_bbar, {2500.0, 0.45});
}

}  // namespace

TEST_CASE("compliance: columns are what a direct solution gives, rows beyond the touch nodes included") {
    const Problem problem = small_slab();
    const Factored factored = factorise(problem, best_solver());
    SurfaceRequest request = request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.03, 0.07, 0.03, 0.07});
    request.tangential = true;
    request.block = 7;
    const Compliance c = surface_compliance(problem.mesh, factored, request);
    CHECK(c.asymmetry < 1e-13);
    CHECK(c.n_touch + static_cast<int>(request.other_nodes.size()) == 121);
    CHECK(c.area_m2.sum() == close_to(0.01).epsilon(1e-12));
    CHECK(c.thickness_m == close_to(0.05));
    for (const int column : {0, c.n_touch / 2, c.n_touch - 1}) {
        for (int direction = 0; direction < 3; ++direction) {
            Eigen::Matrix3Xd load = Eigen::Matrix3Xd::Zero(3, problem.mesh.nodes_m.cols());
            const int node = c.node[static_cast<std::size_t>(column)];
            if (direction == 0)
                load(2, node) = -1.0;
            else
                load(direction - 1, node) = 1.0;
            const Solution s = solve(factored, load);
            const double size = s.u_m.cwiseAbs().maxCoeff();
            if (direction == 0) {
                for (Eigen::Index i = 0; i < c.normal_m_per_N.rows(); ++i) {
                    CHECK(std::abs(c.normal_m_per_N(i, column) + s.u_m(2, c.node[static_cast<std::size_t>(i)])) <
                          1e-12 * size);
                }
            }
            for (int i = 0; i < c.n_touch; ++i) {
                const Eigen::Vector3d u = s.u_m.col(c.node[static_cast<std::size_t>(i)]);
                const Eigen::Vector3d expected(-u.z(), u.x(), u.y());
                CHECK((c.full_m_per_N.block<3, 1>(3 * i, 3 * column + direction) - expected).norm() < 1e-12 * size);
            }
        }
    }
    CHECK(c.normal_m_per_N.topRows(c.n_touch).isApprox(c.normal_m_per_N.topRows(c.n_touch).transpose(), 0.0));
}

TEST_CASE("compliance: progress counts up, cancel stops, wrong requests are refused") {
    const Problem problem = small_slab();
    const Factored factored = factorise(problem, best_solver());
    const SurfaceRequest request = request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.0, 0.1, 0.0, 0.1});
    std::vector<int> seen;
    std::atomic<bool> cancel = false;
    Progress progress{[&](int done, int total) {
                          seen.push_back(done);
                          CHECK(total == 121);
                      },
                      &cancel};
    surface_compliance(problem.mesh, factored, request, progress);
    CHECK(seen == std::vector<int>{64, 121});
    progress.report = [&](int, int) { cancel = true; };
    CHECK_THROWS_AS(surface_compliance(problem.mesh, factored, request, progress), Cancelled);
    SurfaceRequest wrong;
    CHECK_THROWS_AS(surface_compliance(problem.mesh, factored, wrong), LoadError);
    wrong.touch_nodes = {100000};
    CHECK_THROWS_AS(surface_compliance(problem.mesh, factored, wrong), LoadError);
}

TEST_CASE("fingerprint: equal for equal inputs, another for any change") {
    const Problem problem = small_slab();
    const SurfaceRequest request =
        request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.03, 0.07, 0.03, 0.07});
    const std::uint64_t key = fingerprint(problem, request);
    CHECK(key == fingerprint(small_slab(), request));
    Problem other = problem;
    other.materials[17].young_Pa += 1e-9;
    CHECK(fingerprint(other, request) != key);
    other = problem;
    other.mesh.nodes_m(0, 0) += 1e-15;
    CHECK(fingerprint(other, request) != key);
    other = problem;
    other.element = Element::hex8;
    CHECK(fingerprint(other, request) != key);
    SurfaceRequest more = request;
    more.tangential = true;
    CHECK(fingerprint(problem, more) != key);
}

TEST_CASE("compliance: asked for sideways it is what the full one holds, and nothing else changes") {
    const Problem problem =
        slab_problem(hex_box(graded_box(0.1, 0.05, 8, 4, 0.005)), Element::hex8_bbar, {2500.0, 0.45});
    SurfaceRequest request = request_rectangle(problem.mesh, boundary_faces(problem.mesh), {0.03, 0.07, 0.03, 0.07});
    const Factored factored = factorise(problem, best_solver());
    const Compliance plain = surface_compliance(problem.mesh, factored, request);
    CHECK(plain.along_x_m_per_N.size() == 0);
    const std::uint64_t number = fingerprint(problem, request);
    request.sideways = true;
    CHECK(fingerprint(problem, request) != number);
    const Compliance sideways = surface_compliance(problem.mesh, factored, request);
    CHECK(sideways.normal_m_per_N == plain.normal_m_per_N);
    CHECK(sideways.full_m_per_N.size() == 0);
    CHECK(sideways.along_x_m_per_N.rows() == plain.normal_m_per_N.rows());
    request.tangential = true;
    request.sideways = false;
    const Compliance full = surface_compliance(problem.mesh, factored, request);
    const double size = full.full_m_per_N.cwiseAbs().maxCoeff();
    for (int i = 0; i < full.n_touch; ++i) {
        for (int j = 0; j < full.n_touch; ++j) {
            CHECK(std::abs(sideways.along_x_m_per_N(i, j) - full.full_m_per_N(3 * i + 1, 3 * j)) < 1e-12 * size);
            CHECK(std::abs(sideways.along_y_m_per_N(i, j) - full.full_m_per_N(3 * i + 2, 3 * j)) < 1e-12 * size);
        }
    }
}
