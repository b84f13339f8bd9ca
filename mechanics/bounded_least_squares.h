#pragma once
// Least squares with bounds, for a few unknowns:
//
//   minimise |W x + d|^2 + t sum_j |w_j|^2 x_j^2 + sum_j r_j^2 (x_j - before_j)^2    subject to   lower <= x <= upper
//
// by an active set: unknowns are freed one at a time from their bounds, where that lowers the sum, and each set of free
// ones is solved by a QR factorisation with pivots. W^T W is never formed, which would square its condition number, and
// columns are scaled to length 1, since tensions and pressures differ by 1e5.
// Source: Stark & Parker, "Bounded-variable least-squares: an algorithm and applications", Computational Statistics 10
// (1995); Lawson & Hanson, Solving Least Squares Problems (1974), chapter 23, for the guard against cycling.

#include <Eigen/Core>

namespace palpa::mechanics {

inline constexpr int kMostUnknowns = 8;
inline constexpr int kMostResiduals = 8;  // rows of W

using SmallRows = Eigen::Matrix<double, Eigen::Dynamic, Eigen::Dynamic, Eigen::ColMajor, kMostResiduals, kMostUnknowns>;
using SmallVector = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostUnknowns, 1>;
using SmallResiduals = Eigen::Matrix<double, Eigen::Dynamic, 1, Eigen::ColMajor, kMostResiduals, 1>;

struct BoundedProblem {
    SmallRows W;            // m x n
    SmallResiduals d;       // m
    SmallVector lower;      // n; may be -infinity
    SmallVector upper;      // n; may be infinity
    double tikhonov = 0.0;  // t, relative to the columns: sqrt(t) is the share of the target that it gives away
    SmallVector rate;       // r_j, or empty
    SmallVector before;     // n where there is a rate term or a start; or empty
};

enum class BoundedStatus {
    solved,
    stopped,     // iterations ran out; x is within its bounds
    infeasible,  // lower > upper; x is `before`, or 0, brought to the nearer bound
    not_finite,
};

struct BoundedSolution {
    BoundedStatus status = BoundedStatus::not_finite;
    SmallVector x;
    SmallResiduals residual;  // W x + d
    unsigned active = 0;      // bit j: x_j is at a bound
    int rank = 0;             // of W (columns of length 1, pivots above 1e-10)
    int iterations = 0;
    double kkt = 0.0;     // greatest |x - P(x - gradient)| of the scaled problem, over |d|
    int infeasible = -1;  // the unknown whose bounds are crossed
    int limiting = -1;    // the unknown whose bound costs most; -1: none
};

// Throws and allocates nothing. An unknown whose column is 0 goes to `before` if there is a rate term, else to the bound
// nearest to 0, or 0.
BoundedSolution solve_bounded(const BoundedProblem& problem) noexcept;

}  // namespace palpa::mechanics
