#pragma once
// Banded Cholesky factorisation by LAPACK (dpbtrf, dpbtrs), for bodies that are long and thin. While it factors and
// solves it throws nothing and takes no lock of the whole process, as MUMPS does, so that loops may call it. The work
// is n b^2 for n equations of half-bandwidth b.

#include <Eigen/Core>
#include <vector>

#include "mechanics/band_matrix.h"
#include "mechanics/stiffness.h"

namespace palpa::mechanics {

bool banded_built_in();  // LAPACK comes with OpenBLAS, which builds without MUMPS lack

// An order of the equations with a small bandwidth: position[i] is the place of equation i.
// Source: George & Liu, Computer Solution of Large Sparse Positive Definite Systems (1981), chapter 4: reverse
// Cuthill-McKee from a pseudo-peripheral start. There the start is one equation; here it is the whole last level that is
// found from it, since bodies end in faces (the strip's band is 65 so, and 101 from one corner). The given order is kept
// where it is no wider.
struct BandOrder {
    std::vector<int> position;
    int band = 0;  // greatest distance of a coupled pair
};
BandOrder band_order(const LowerMatrix& A);

// Floating-point operations of the factorisation.
inline double banded_work(const BandOrder& order) {
    return static_cast<double>(order.position.size()) * static_cast<double>(order.band) *
           static_cast<double>(order.band);
}

struct BandedFactor {
    BandOrder order;
    std::vector<int> place;            // of each value of A in `matrix`
    BandMatrix matrix;                 // A, and after try_factor() its factor
    mutable Eigen::MatrixXd permuted;  // scratch: one thread at a time may solve
    bool factored = false;
};

// Throws SolverError in a build without LAPACK.
void analyse(const LowerMatrix& A, BandedFactor& factor);
// A: with the pattern that was analysed. Returns 0, or the number (from 1) of the first equation, in the band's order,
// whose pivot is not positive; then the factor is of no use. Throws nothing.
int try_factor(const LowerMatrix& A, BandedFactor& factor);
// Replaces right-hand sides by solutions, one per column. Allocates only for more columns than in any earlier call.
void solve_in_place(const BandedFactor& factor, Eigen::Ref<Eigen::MatrixXd> block);

}  // namespace palpa::mechanics
