#include "mechanics/solver.h"

#include "mechanics/banded.h"
#include "mechanics/error.h"
#include "mechanics/solver_backends.h"
#include "mechanics/text.h"
#ifdef PALPA_HAS_MUMPS
#include "mechanics/solver_mumps.h"
#endif

namespace palpa::mechanics {

#ifdef PALPA_HAS_MUMPS
bool mumps_built_in() { return true; }
#else
bool mumps_built_in() { return false; }
struct MumpsFactor {
    MumpsFactor() { throw SolverError("MUMPS asked for, but this build has none; use eigen", 0); }
};
void analyse(const LowerMatrix&, MumpsFactor&) {}
void refactor(const LowerMatrix&, MumpsFactor&) {}
void solve_in_place(MumpsFactor&, Eigen::Ref<Eigen::MatrixXd>) {}
#endif

namespace {

void refactor(const LowerMatrix& A, BandedFactor& factor) {
    const int pivot = try_factor(A, factor);
    if (pivot == 0) return;
    throw SolverError(text("Cholesky: the ", A.rows(), " x ", A.cols(), " matrix is not positive definite, pivot ",
                           pivot, " of the band is not > 0"),
                      pivot);
}

}  // namespace

SparseCholesky::SparseCholesky(SolverKind kind) : kind_(kind) {
    if (kind == SolverKind::mumps)
        mumps_ = std::make_unique<MumpsFactor>();
    else if (kind == SolverKind::banded)
        banded_ = std::make_unique<BandedFactor>();
    else
        eigen_ = std::make_unique<EigenFactor>();
}

SparseCholesky::~SparseCholesky() = default;
SparseCholesky::SparseCholesky(SparseCholesky&&) noexcept = default;
SparseCholesky& SparseCholesky::operator=(SparseCholesky&&) noexcept = default;

void SparseCholesky::analyse(const LowerMatrix& A) {
    if (mumps_)
        mechanics::analyse(A, *mumps_);
    else if (banded_)
        mechanics::analyse(A, *banded_);
    else
        mechanics::analyse(A, *eigen_);
}

void SparseCholesky::factor(const LowerMatrix& A) {
    if (mumps_)
        refactor(A, *mumps_);
    else if (banded_)
        refactor(A, *banded_);
    else
        refactor(A, *eigen_);
}

bool SparseCholesky::try_factor(const LowerMatrix& A) {
    if (banded_) return mechanics::try_factor(A, *banded_) == 0;
    try {
        factor(A);
    } catch (const OutOfMemory&) {
        throw;
    } catch (const SolverError&) {
        return false;
    }
    return true;
}

void SparseCholesky::solve(Eigen::Ref<Eigen::MatrixXd> block) const {
    if (mumps_)
        solve_in_place(*mumps_, block);
    else if (banded_)
        solve_in_place(*banded_, block);
    else
        solve_in_place(*eigen_, block);
}

double backward_error(const LowerMatrix& A, const Eigen::VectorXd& x, const Eigen::VectorXd& b) {
    Eigen::VectorXd row_sum = Eigen::VectorXd::Zero(A.rows());
    for (Eigen::Index j = 0; j < A.cols(); ++j) {
        for (LowerMatrix::InnerIterator it(A, j); it; ++it) {
            row_sum(it.row()) += std::abs(it.value());
            if (it.row() != j) row_sum(j) += std::abs(it.value());
        }
    }
    const Eigen::VectorXd residual = b - A.selfadjointView<Eigen::Lower>() * x;
    const double scale = row_sum.maxCoeff() * x.lpNorm<Eigen::Infinity>() + b.lpNorm<Eigen::Infinity>();
    return scale > 0.0 ? residual.lpNorm<Eigen::Infinity>() / scale : 0.0;
}

}  // namespace palpa::mechanics
