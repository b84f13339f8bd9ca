#pragma once
// Sparse Cholesky behind one interface: analyses the pattern, factors the values, and solves blocks of right-hand
// sides.
//
// mumps  multifrontal; factors some twelve times as fast as eigen (docs/performance.md). It is not thread-safe, so
//        every call takes one lock of the process; only more processes give more speed. OpenBLAS is set to one thread,
//        since a second one gains nothing and spins.
// eigen  SimplicialLDLT, for builds without MUMPS (web).
// banded LAPACK's band Cholesky (banded.h), for long thin bodies and for loops: no lock, nothing thrown by try_factor().

#include <memory>

#include "mechanics/stiffness.h"

namespace palpa::mechanics {

enum class SolverKind { mumps, eigen, banded };
inline const char* name_of(SolverKind kind) {
    return kind == SolverKind::mumps ? "mumps" : kind == SolverKind::eigen ? "eigen" : "banded";
}

bool mumps_built_in();
inline SolverKind best_solver() { return mumps_built_in() ? SolverKind::mumps : SolverKind::eigen; }

struct MumpsFactor;
struct EigenFactor;
struct BandedFactor;

// Owns one factorisation. Throws SolverError with the solver's code for a matrix that is not positive definite and for
// MUMPS or LAPACK in a build without them, and OutOfMemory if there is not enough memory.
class SparseCholesky {
  public:
    explicit SparseCholesky(SolverKind kind);
    ~SparseCholesky();
    SparseCholesky(SparseCholesky&&) noexcept;
    SparseCholesky& operator=(SparseCholesky&&) noexcept;

    void analyse(const LowerMatrix& A);
    void factor(const LowerMatrix& A);  // with the pattern that was analysed
    // The same, but returns false for a matrix that is not positive definite.
    bool try_factor(const LowerMatrix& A);
    // Replaces right-hand sides by solutions, one per column; the elements of a column are contiguous.
    void solve(Eigen::Ref<Eigen::MatrixXd> block) const;

    SolverKind kind() const { return kind_; }

  private:
    SolverKind kind_;
    std::unique_ptr<MumpsFactor> mumps_;
    std::unique_ptr<EigenFactor> eigen_;
    std::unique_ptr<BandedFactor> banded_;
};

// Returns the smallest relative change of A and b for which x is the exact solution:
//   |b - A x| / ( |A| |x| + |b| ),  all in the maximum norm
// Source: Higham, Accuracy and Stability of Numerical Algorithms, theorem 7.1. The relative residual |b - A x| / |b|
// alone misleads if stiffnesses differ much (1.5e-9 at a contrast of 1e6, where the backward error is 1e-17).
double backward_error(const LowerMatrix& A, const Eigen::VectorXd& x, const Eigen::VectorXd& b);

}  // namespace palpa::mechanics
