#include "mechanics/error.h"
#include "mechanics/solver_backends.h"
#include "mechanics/text.h"

namespace palpa::mechanics {

void analyse(const LowerMatrix& A, EigenFactor& factor) { factor.ldlt.analyzePattern(A); }

void refactor(const LowerMatrix& A, EigenFactor& factor) {
    factor.ldlt.factorize(A);
    const bool done = factor.ldlt.info() == Eigen::Success;
    if (done && factor.ldlt.vectorD().minCoeff() > 0.0) return;
    throw SolverError(
        text("Cholesky: the ", A.rows(), " x ", A.cols(), " matrix is not positive definite, smallest pivot ",
             done ? factor.ldlt.vectorD().minCoeff() : 0.0),
        static_cast<int>(factor.ldlt.info()));
}

void solve_in_place(const EigenFactor& factor, Eigen::Ref<Eigen::MatrixXd> block) {
    // column by column, since solving a block at once would copy it
    for (Eigen::Index k = 0; k < block.cols(); ++k) block.col(k) = factor.ldlt.solve(Eigen::VectorXd(block.col(k)));
}

}  // namespace palpa::mechanics
