#pragma once
// Sparse Cholesky behind one interface: analyse the pattern, factor the values, solve blocks of right-hand
// sides.
//
// mumps: multifrontal, some 15 times faster here. Not thread-safe, so every call takes one lock for the
// process; more
//        speed comes from more processes. OpenBLAS is set to one thread: a second one gains nothing and
//        spins.
// eigen: SimplicialLDLT, where MUMPS is missing (web).

#include <memory>

#include "mechanics/stiffness.h"

namespace palpa::mechanics {

enum class SolverKind { mumps, eigen };

bool mumps_built_in();
inline SolverKind best_solver() { return mumps_built_in() ? SolverKind::mumps : SolverKind::eigen; }

struct MumpsFactor;
struct EigenFactor;

// Owns one factorisation. Errors throw SolverError with the solver's code: a matrix that is not positive
// definite, memory, MUMPS asked for but not built in.
class SparseCholesky {
  public:
    explicit SparseCholesky(SolverKind kind);
    ~SparseCholesky();
    SparseCholesky(SparseCholesky&&) noexcept;
    SparseCholesky& operator=(SparseCholesky&&) noexcept;

    void analyse(const LowerMatrix& A);
    void factor(const LowerMatrix& A);  // same pattern as analysed
    // Right-hand sides in, solutions out; one per column, columns contiguous.
    void solve(Eigen::Ref<Eigen::MatrixXd> block) const;

    SolverKind kind() const { return kind_; }

  private:
    SolverKind kind_;
    std::unique_ptr<MumpsFactor> mumps_;
    std::unique_ptr<EigenFactor> eigen_;
};

// How far A would have to be changed for x to be exact, relative to its size:
//   |b - A x| / ( |A| |x| + |b| ),  all in the maximum norm
// Source: Higham, Accuracy and Stability of Numerical Algorithms, theorem 7.1. |b - A x| / |b| alone misleads
// when stiffnesses differ much (1.5e-9 at a contrast of 1e6 while this is 1e-17).
double backward_error(const LowerMatrix& A, const Eigen::VectorXd& x, const Eigen::VectorXd& b);

}  // namespace palpa::mechanics
