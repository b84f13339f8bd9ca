#pragma once
// The two factorisations behind SparseCholesky. Only the solver's own sources include this.

#include <Eigen/SparseCholesky>
#include <vector>

#include "mechanics/solver.h"

namespace palpa::mechanics {

struct EigenFactor {
    Eigen::SimplicialLDLT<LowerMatrix, Eigen::Lower> ldlt;
};
void analyse(const LowerMatrix& A, EigenFactor& factor);
void refactor(const LowerMatrix& A, EigenFactor& factor);
void solve_in_place(const EigenFactor& factor, Eigen::Ref<Eigen::MatrixXd> block);

void analyse(const LowerMatrix& A, MumpsFactor& factor);
void refactor(const LowerMatrix& A, MumpsFactor& factor);
void solve_in_place(MumpsFactor& factor, Eigen::Ref<Eigen::MatrixXd> block);

}  // namespace palpa::mechanics
