#include <doctest/doctest.h>
#include <thread>
#include <vector>

#include "mechanics/error.h"
#include "mechanics/solver.h"
#include "tests/mechanics/slab.h"

using namespace palpa::mechanics;

namespace {

LowerMatrix slab_matrix(double poisson) {
    const Problem problem =
        slab_problem(hex_box(graded_box(0.1, 0.05, 8, 5, 0.005)), Element::hex8_bbar, {2500.0, poisson});
    const LowerMatrix K = stiffness_N_per_m(problem.mesh, problem.element, problem.materials);
    return reduce(K, make_reduction(problem.mesh, problem.supports, {}));
}

Eigen::MatrixXd solve_with(SolverKind kind, const LowerMatrix& A, Eigen::MatrixXd block) {
    SparseCholesky solver(kind);
    solver.analyse(A);
    solver.factor(A);
    solver.solve(block);
    return block;
}

}  // namespace

TEST_CASE("solver: MUMPS and Eigen agree, block by block") {
    if (!mumps_built_in()) {
        MESSAGE("built without MUMPS: nothing to compare");
        return;
    }
    for (const double poisson : {0.3, 0.4999}) {
        const LowerMatrix A = slab_matrix(poisson);
        std::srand(4);
        const Eigen::MatrixXd B = Eigen::MatrixXd::Random(A.rows(), 70);
        const Eigen::MatrixXd mumps = solve_with(SolverKind::mumps, A, B);
        const Eigen::MatrixXd eigen = solve_with(SolverKind::eigen, A, B);
        CHECK((mumps - eigen).norm() / eigen.norm() < 1e-10);
        for (int k = 0; k < 70; k += 23) {
            CHECK(backward_error(A, mumps.col(k), B.col(k)) < 1e-15);
            CHECK(backward_error(A, eigen.col(k), B.col(k)) < 1e-15);
        }
    }
}

TEST_CASE("solver: new values on the same pattern, and two solvers in two threads") {
    const LowerMatrix A = slab_matrix(0.45);
    const Eigen::VectorXd b = Eigen::VectorXd::LinSpaced(A.rows(), -1.0, 1.0);
    SparseCholesky solver(best_solver());
    solver.analyse(A);
    solver.factor(A);
    Eigen::MatrixXd first = b;
    solver.solve(first);
    solver.factor(2.0 * A);
    Eigen::MatrixXd second = b;
    solver.solve(second);
    CHECK((second - 0.5 * first).norm() < 1e-13 * first.norm());

    Eigen::MatrixXd one;
    Eigen::MatrixXd two;
    std::thread other([&] { one = solve_with(best_solver(), A, b); });
    two = solve_with(best_solver(), A, b);
    other.join();
    CHECK((one.array() == two.array()).all());
}

// Maps promise equal bytes between runs. The ordering is what broke it, from 10 000 equations on; this system has more.
TEST_CASE("solver: the same system has the same solution to the last bit, wherever it lies in memory") {
    const int n = 20;
    const Problem problem =
        slab_problem(hex_box(graded_box(0.1, 0.05, n, n / 2, 0.005)), Element::hex8_bbar, {2500.0, 0.45});
    const LowerMatrix K = stiffness_N_per_m(problem.mesh, problem.element, problem.materials);
    const LowerMatrix A = reduce(K, make_reduction(problem.mesh, problem.supports, {}));
    constexpr int kColumns = 3;
    Eigen::MatrixXd first;
    for (int repeat = 0; repeat < 3; ++repeat) {
        SparseCholesky solver(best_solver());
        solver.analyse(A);
        solver.factor(A);
        std::vector<double> memory(static_cast<std::size_t>(kColumns * A.rows() + repeat));
        Eigen::Map<Eigen::MatrixXd> block(memory.data() + repeat, A.rows(), kColumns);
        for (int k = 0; k < kColumns; ++k) block.col(k).setLinSpaced(-1.0, 1.0 + k);
        solver.solve(block);
        if (repeat == 0) first = block;
        CHECK((block.array() == first.array()).all());
    }
}

TEST_CASE("solver: a matrix that is not positive definite is refused") {
    LowerMatrix A = slab_matrix(0.45);
    A.coeffRef(100, 100) = -A.coeff(100, 100);
    for (const SolverKind kind : {SolverKind::eigen, best_solver()}) {
        SparseCholesky solver(kind);
        solver.analyse(A);
        CHECK_THROWS_AS(solver.factor(A), SolverError);
    }
}

TEST_CASE("backward error: exact is round-off, a wrong digit shows") {
    const LowerMatrix A = slab_matrix(0.3);
    const Eigen::VectorXd x = Eigen::VectorXd::Ones(A.rows());
    const Eigen::VectorXd b = A.selfadjointView<Eigen::Lower>() * x;
    CHECK(backward_error(A, x, b) < 1e-15);
    Eigen::VectorXd wrong = x;
    wrong(17) += 1e-6;
    CHECK(backward_error(A, wrong, b) > 1e-9);
}
