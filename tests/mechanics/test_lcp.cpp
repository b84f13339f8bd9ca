#include <Eigen/Dense>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/lcp.h"
#include "tests/mechanics/allocation_count.h"

using namespace palpa::mechanics;
using Eigen::MatrixXd;
using Eigen::VectorXd;

namespace {

// How far p is from solving the problem, relative to b.
double violation(const MatrixXd& A, const VectorXd& b, const VectorXd& p) {
    const VectorXd w = A * p + b;
    const double size = b.cwiseAbs().maxCoeff() + 1e-300;
    return std::max({-w.minCoeff(), -p.minCoeff() * A.diagonal().minCoeff(), p.cwiseProduct(w).cwiseAbs().maxCoeff()}) /
           size;
}

}  // namespace

TEST_CASE("linear complementarity: 2,000 seeded problems are solved, from wherever the last set was") {
    std::mt19937 random(7);
    MESSAGE("seed 7");
    std::normal_distribution<double> normal;
    for (const int n : {1, 2, 7, 24}) {
        LcpWork work = make_lcp_work(n);
        for (int i = 0; i < 500; ++i) {
            const MatrixXd B = MatrixXd::NullaryExpr(n, n + i % 3, [&] { return normal(random); });
            const MatrixXd A = B * B.transpose() + 1e-3 * MatrixXd::Identity(n, n);
            const VectorXd b = VectorXd::NullaryExpr(n, [&] { return normal(random); });
            VectorXd p(n);
            REQUIRE(solve_lcp(A, b, work, p) == LcpStatus::solved);
            CHECK(violation(A, b, p) < 1e-9);
        }
    }
}

TEST_CASE("linear complementarity: nothing in contact, everything in contact, and what cannot be solved") {
    LcpWork work = make_lcp_work(2);
    VectorXd p(2);
    const MatrixXd A = (MatrixXd(2, 2) << 2.0, 1.0, 1.0, 2.0).finished();
    CHECK(solve_lcp(A, Eigen::Vector2d(1.0, 0.0), work, p) == LcpStatus::solved);
    CHECK(p.isZero());
    CHECK(solve_lcp(A, Eigen::Vector2d(-3.0, -3.0), work, p) == LcpStatus::solved);
    CHECK((p - Eigen::Vector2d(1.0, 1.0)).norm() < 1e-15);
    const MatrixXd singular = MatrixXd::Zero(2, 2);
    CHECK(solve_lcp(singular, Eigen::Vector2d(-1.0, 1.0), work, p) == LcpStatus::not_settled);
    CHECK(solve_lcp(A, Eigen::Vector2d(NAN, 1.0), work, p) == LcpStatus::not_settled);
    // and goes on afterwards
    CHECK(solve_lcp(A, Eigen::Vector2d(-3.0, -3.0), work, p) == LcpStatus::solved);
    const long before = allocation_count();
    solve_lcp(A, VectorXd(Eigen::Vector2d(-3.0, 2.0)), work, p);
    CHECK(allocation_count() - before <= 2);  // the two vectors of this line
}
