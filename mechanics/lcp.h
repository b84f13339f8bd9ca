#pragma once
// Linear complementarity with a symmetric positive definite matrix, such as the compliance of points in contact:
//
//   find p >= 0 with  w = A p + b >= 0  and  p . w = 0
//
// by block principal pivoting: all infeasible entries of the set p > 0 are exchanged at once, and one at a time (the last
// of them) while that does not lead on, which ends for every such matrix.
// Source: Judice & Pires, "A block principal pivoting algorithm for large-scale strictly monotone linear complementarity
// problems", Computers & Operations Research 21 (1994) 587-596; Murty, Linear Algebra and its Applications 7 (1974) 65.

#include <Eigen/Core>
#include <vector>

namespace palpa::mechanics {

struct LcpWork {
    std::vector<char> positive;  // entry by entry; the next call starts from this set
    std::vector<int> set;
    Eigen::MatrixXd factor;
    Eigen::VectorXd solution;
    Eigen::VectorXd w;
};
LcpWork make_lcp_work(int n);

enum class LcpStatus { solved, not_settled };  // not_settled: a matrix that is not positive definite, or not finite

// A: n x n; b, p: n values. Allocates nothing for a work of that n, and throws nothing.
LcpStatus solve_lcp(const Eigen::Ref<const Eigen::MatrixXd>& A, const Eigen::Ref<const Eigen::VectorXd>& b,
                    LcpWork& work, Eigen::Ref<Eigen::VectorXd> p) noexcept;

// Solves A_SS x = r on the set that solve_lcp() ended with; 0 elsewhere. r, x: n values.
void solve_on_set(const LcpWork& work, const Eigen::Ref<const Eigen::VectorXd>& r,
                  Eigen::Ref<Eigen::VectorXd> x) noexcept;

}  // namespace palpa::mechanics
