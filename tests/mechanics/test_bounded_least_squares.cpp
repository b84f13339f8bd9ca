#include <cmath>
#include <doctest/doctest.h>
#include <limits>
#include <random>
#include <vector>

#include "mechanics/bounded_least_squares.h"
#include "tests/close_to.h"
#include "tests/mechanics/allocation_count.h"

#if __has_include(<CGAL/QP_functions.h>)
#pragma GCC diagnostic push
#pragma GCC diagnostic ignored "-Wall"
#pragma GCC diagnostic ignored "-Wextra"
#pragma GCC diagnostic ignored "-Wold-style-cast"
#pragma GCC diagnostic ignored "-Wshadow"
#pragma GCC diagnostic ignored "-Wsign-conversion"
#pragma GCC diagnostic ignored "-Wconversion"
#include <CGAL/Gmpq.h>
#include <CGAL/QP_functions.h>
#include <CGAL/QP_models.h>
#pragma GCC diagnostic pop
#define PALPA_EXACT_QP 1
#endif

using namespace palpa::mechanics;
using namespace palpa::test;
using palpa::test::close_to;

namespace {

constexpr double kNoBound = std::numeric_limits<double>::infinity();

BoundedProblem bounded(Eigen::Index rows, Eigen::Index unknowns) {
    BoundedProblem p;
    p.W.setZero(rows, unknowns);
    p.d.setZero(rows);
    p.lower.setConstant(unknowns, 0.0);
    p.upper.setConstant(unknowns, 1.0);
    p.tikhonov = 1e-8;
    return p;
}

double bounded_cost(const BoundedProblem& p, const SmallVector& x) {
    double sum = (p.W * x + p.d).squaredNorm();
    for (Eigen::Index j = 0; j < x.size(); ++j) {
        sum += p.tikhonov * p.W.col(j).squaredNorm() * x(j) * x(j);
        if (p.rate.size() > 0) sum += std::pow(p.rate(j) * (x(j) - p.before(j)), 2);
    }
    return sum;
}

// A quarter each of plain columns, duplicates, columns 1e-4 as long, and columns nearly opposite to an earlier one.
BoundedProblem degenerate(std::mt19937_64& random, Eigen::Index n) {
    std::normal_distribution<double> normal;
    BoundedProblem p = bounded(std::max<Eigen::Index>(1, 3 * n / 4), n);
    for (Eigen::Index j = 0; j < n; ++j) {
        for (Eigen::Index i = 0; i < p.W.rows(); ++i) p.W(i, j) = normal(random);
        const auto other = static_cast<Eigen::Index>(random() % static_cast<unsigned long>(j + 1));
        if (j % 4 == 1) p.W.col(j) = p.W.col(other).eval();
        if (j % 4 == 2) p.W.col(j) *= 1e-4;
        if (j % 4 == 3) p.W.col(j) = -p.W.col(other).eval() * (1.0 + 1e-9 * normal(random));
        p.lower(j) = -std::abs(normal(random));
        p.upper(j) = std::abs(normal(random));
    }
    for (Eigen::Index i = 0; i < p.W.rows(); ++i) p.d(i) = normal(random);
    return p;
}

}  // namespace

TEST_CASE("bounded least squares: optimality and bounds on 2,000 degenerate problems") {
    constexpr std::uint64_t kSeed = 22;
    CAPTURE(kSeed);
    std::mt19937_64 random(kSeed);
    std::uniform_real_distribution<double> share;
    for (int i = 0; i < 2000; ++i) {
        CAPTURE(i);
        const BoundedProblem p = degenerate(random, 1 + i % 8);
        const BoundedSolution s = solve_bounded(p);
        REQUIRE(s.status == BoundedStatus::solved);
        CHECK(s.kkt <= 1e-10);
        REQUIRE(((s.x - p.lower).minCoeff() >= 0.0 && (p.upper - s.x).minCoeff() >= 0.0));
        const double best = bounded_cost(p, s.x);
        for (int k = 0; k < 20; ++k) {
            SmallVector other = p.lower;
            for (Eigen::Index j = 0; j < other.size(); ++j) other(j) += share(random) * (p.upper(j) - p.lower(j));
            CHECK(best <= bounded_cost(p, other) + 1e-14 * p.d.squaredNorm());
        }
    }
}

#ifdef PALPA_EXACT_QP
TEST_CASE("bounded least squares: as good as the exact solver of CGAL") {
    constexpr std::uint64_t kSeed = 23;
    CAPTURE(kSeed);
    using Exact = CGAL::Gmpq;
    std::mt19937_64 random(kSeed);
    for (int i = 0; i < 60; ++i) {
        CAPTURE(i);
        const Eigen::Index n = 1 + i % 6;
        const BoundedProblem p = degenerate(random, n);
        CGAL::Quadratic_program<Exact> exact(CGAL::SMALLER, true, 0, true, 0);
        for (Eigen::Index a = 0; a < n; ++a) {
            Exact c = 0;
            for (Eigen::Index r = 0; r < p.W.rows(); ++r) c += Exact(p.W(r, a)) * Exact(p.d(r));
            exact.set_c(static_cast<int>(a), Exact(2) * c);
            exact.set_l(static_cast<int>(a), true, Exact(p.lower(a)));
            exact.set_u(static_cast<int>(a), true, Exact(p.upper(a)));
            for (Eigen::Index b = 0; b <= a; ++b) {
                Exact d = a == b ? Exact(p.tikhonov * p.W.col(a).squaredNorm()) : Exact(0);
                for (Eigen::Index r = 0; r < p.W.rows(); ++r) d += Exact(p.W(r, a)) * Exact(p.W(r, b));
                exact.set_d(static_cast<int>(a), static_cast<int>(b), Exact(2) * d);
            }
        }
        const auto solution = CGAL::solve_quadratic_program(exact, Exact());
        REQUIRE(solution.is_optimal());
        SmallVector x(n);
        Eigen::Index j = 0;
        for (auto it = solution.variable_values_begin(); it != solution.variable_values_end(); ++it)
            x(j++) = CGAL::to_double(*it);
        const BoundedSolution ours = solve_bounded(p);
        CHECK(bounded_cost(p, ours.x) <= bounded_cost(p, x) + 1e-14 * p.d.squaredNorm());
    }
}
#endif

TEST_CASE("bounded least squares: a column's unit changes its unknown and nothing else") {
    std::mt19937_64 random(5);
    for (int i = 0; i < 50; ++i) {
        BoundedProblem p = degenerate(random, 4);
        const BoundedSolution before = solve_bounded(p);
        p.W.col(2) *= 1e6;
        p.lower(2) *= 1e-6;
        p.upper(2) *= 1e-6;
        const BoundedSolution after = solve_bounded(p);
        CHECK((after.residual - before.residual).norm() <= 1e-9 * p.d.norm());
        CHECK(1e6 * after.x(2) == close_to(before.x(2)).epsilon(1e-6));
    }
}

TEST_CASE("bounded least squares: duplicate and zero columns, equal bounds, crossed bounds") {
    BoundedProblem p = bounded(1, 2);
    p.W << 2.0, 2.0;
    p.d << -2.0;
    SUBCASE("duplicate columns share") {
        const BoundedSolution s = solve_bounded(p);
        CHECK(s.x(0) == close_to(0.5));
        CHECK(s.x(1) == close_to(0.5));
        CHECK(s.rank == 1);
    }
    SUBCASE("a zero column stays where its bound is nearest to 0, or where it was") {
        p.W(0, 1) = 0.0;
        p.lower(1) = 0.25;
        CHECK(solve_bounded(p).x(1) == 0.25);
        p.rate.setConstant(2, 1e-6);
        p.before.setConstant(2, 0.7);
        CHECK(solve_bounded(p).x(1) == close_to(0.7));
    }
    SUBCASE("l = u holds") {
        p.lower(0) = p.upper(0) = 0.125;
        const BoundedSolution s = solve_bounded(p);
        CHECK(s.x(0) == 0.125);
        CHECK(s.x(1) == close_to(0.875).epsilon(1e-6));
    }
    SUBCASE("l > u is named") {
        p.lower(1) = 2.0;
        const BoundedSolution s = solve_bounded(p);
        CHECK(s.status == BoundedStatus::infeasible);
        CHECK(s.infeasible == 1);
        CHECK(s.x.allFinite());
    }
    SUBCASE("not a number") {
        p.W(0, 0) = std::nan("");
        CHECK(solve_bounded(p).status == BoundedStatus::not_finite);
    }
}

TEST_CASE("bounded least squares: an unreachable target ends at the bound that limits it") {
    BoundedProblem p = bounded(1, 2);
    p.W << 1.0, 0.5;
    p.d << -10.0;
    const BoundedSolution s = solve_bounded(p);
    CHECK(s.x(0) == 1.0);
    CHECK(s.x(1) == 1.0);
    CHECK(s.active == 3U);
    CHECK(s.limiting >= 0);  // a tie, in lengths of their columns
    CHECK(s.residual(0) == close_to(-8.5));
}

TEST_CASE("bounded least squares: 1e5 between units, and no bounds at all") {
    BoundedProblem p = bounded(2, 2);
    p.W << 1e-3, 1e-8, 0.5e-3, 3e-8;
    p.d << -1e-3, -2e-3;
    p.lower.setConstant(2, -kNoBound);
    p.upper.setConstant(2, kNoBound);
    p.tikhonov = 1e-16;
    const BoundedSolution s = solve_bounded(p);
    CHECK(s.x(0) == close_to(0.4).epsilon(1e-6));
    CHECK(s.x(1) == close_to(6e4).epsilon(1e-6));
    CHECK(s.active == 0U);
}

TEST_CASE("bounded least squares: the rate term keeps the answer where W is 0, without a jump") {
    BoundedProblem p = bounded(1, 1);
    p.upper(0) = 5.0;
    p.before.setConstant(1, 1.4);
    p.rate.setConstant(1, 1e-4);
    double last = 1.4;
    for (int i = -100; i <= 100; ++i) {
        p.W(0, 0) = 1e-6 * i;  // passes through 0
        p.d(0) = -1e-6 * i * 1.4 + 1e-7;
        const double x = solve_bounded(p).x(0);
        CHECK(std::abs(x - last) < 0.01);
        last = x;
    }
}

TEST_CASE("bounded least squares: allocates nothing") {
    std::mt19937_64 random(9);
    const BoundedProblem p = degenerate(random, 8);
    const long before = allocation_count();
    const BoundedSolution s = solve_bounded(p);
    CHECK(allocation_count() == before);
    CHECK(s.status == BoundedStatus::solved);
}
