#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>
#include <iterator>
#include <sys/wait.h>
#include <unistd.h>
#include <vector>

#include "mechanics/banded.h"
#include "mechanics/error.h"
#include "mechanics/solver.h"
#include "mechanics/statics.h"

using namespace palpa::mechanics;

namespace {

// The strip of the soft devices, 765 nodes, its ends held.
LowerMatrix strip_matrix() {
    const Mesh mesh = hex_box({{0.1, 0.02, 0.004}, {50, 4, 2}, std::nullopt});
    Supports supports;
    const Faces outer = boundary_faces(mesh);
    for (const Side side : {Side::xmin, Side::xmax}) fix(nodes_of(faces_on(mesh, outer, side)), "xyz", 0.0, supports);
    const std::vector<Material> materials(static_cast<std::size_t>(mesh.cells.cols()), {130e3, 0.45});
    return reduce(stiffness_N_per_m(mesh, Element::hex8_bbar, materials), make_reduction(mesh, supports, {}));
}

}  // namespace

TEST_CASE("banded: the strip, numbered along its length, is ordered across it") {
    const BandOrder order = band_order(strip_matrix());
    CAPTURE(order.band);
    CHECK(order.band == 65);  // section by section it is 59, as numbered 887
    std::vector<int> sorted = order.position;
    std::sort(sorted.begin(), sorted.end());
    for (int i = 0; i < static_cast<int>(sorted.size()); ++i) REQUIRE(sorted[static_cast<std::size_t>(i)] == i);
}

TEST_CASE("banded: solutions are those of Eigen's factorisation, also for new values and more columns") {
    if (!banded_built_in()) return;
    const LowerMatrix A = strip_matrix();
    SparseCholesky banded(SolverKind::banded);
    SparseCholesky eigen(SolverKind::eigen);
    banded.analyse(A);
    eigen.analyse(A);
    for (const double scale : {1.0, 3.0}) {
        banded.factor(scale * A);
        eigen.factor(scale * A);
        std::srand(4);
        Eigen::MatrixXd b = Eigen::MatrixXd::Random(A.rows(), scale > 1.0 ? 5 : 1);
        Eigen::MatrixXd c = b;
        const Eigen::VectorXd first = b.col(0);
        banded.solve(b);
        eigen.solve(c);
        CHECK((b - c).norm() < 1e-10 * c.norm());
        CHECK(backward_error(scale * A, b.col(0), first) < 1e-15);
    }
}

TEST_CASE("banded: separate parts, and a matrix without couplings") {
    if (!banded_built_in()) return;
    LowerMatrix A(6, 6);
    for (int i = 0; i < 6; ++i) A.insert(i, i) = 2.0 + i;
    A.insert(4, 1) = 1.0;
    A.insert(5, 2) = -1.0;
    A.makeCompressed();
    BandedFactor factor;
    analyse(A, factor);
    CHECK(factor.order.band == 1);
    REQUIRE(try_factor(A, factor) == 0);
    const Eigen::VectorXd x = Eigen::VectorXd::LinSpaced(6, 1.0, 2.0);
    Eigen::MatrixXd b = A.selfadjointView<Eigen::Lower>() * x;
    solve_in_place(factor, b);
    CHECK((b.col(0) - x).norm() < 1e-14);
}

TEST_CASE("banded: what is not positive definite is a return value, or an error of factor()") {
    if (!banded_built_in()) return;
    LowerMatrix A = strip_matrix();
    BandedFactor factor;
    analyse(A, factor);
    CHECK(try_factor(A, factor) == 0);
    A.coeffRef(100, 100) = -A.coeff(100, 100);
    CHECK(try_factor(A, factor) > 0);
    SparseCholesky solver(SolverKind::banded);
    solver.analyse(A);
    CHECK_FALSE(solver.try_factor(A));
    CHECK_THROWS_AS(solver.factor(A), SolverError);
    SparseCholesky other(SolverKind::eigen);
    other.analyse(A);
    CHECK_FALSE(other.try_factor(A));
}

TEST_CASE("banded: after a fork no factorisation starts a thread, which would spin at the loop's real-time priority") {
    if (!banded_built_in()) return;
    const auto threads = [] {
        return std::distance(std::filesystem::directory_iterator("/proc/self/task"),
                             std::filesystem::directory_iterator());
    };
    BandMatrix K = band_matrix(300, 20);
    K.values.row(0).setConstant(4.0);
    REQUIRE(factor_in_place(K) == 0);
    const pid_t child = ::fork();
    if (child == 0) ::_exit(0);
    REQUIRE(child > 0);
    ::waitpid(child, nullptr, 0);
    bring_back_threads();
    const auto before = threads();
    CHECK(factor_in_place(K) == 0);
    CHECK(threads() == before);
}
