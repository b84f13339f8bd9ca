#pragma once
// A symmetric matrix in LAPACK's lower band storage, for loops: nothing throws, nothing allocates, no lock is taken.

#include <Eigen/Core>

namespace palpa::mechanics {

// values(i - j, j) holds A(i, j) for j <= i <= j + band; (band + 1) x n. What would lie below the last row is unused.
struct BandMatrix {
    int band = 0;
    Eigen::MatrixXd values;

    Eigen::Index size() const { return values.cols(); }
    double& at(Eigen::Index row, Eigen::Index column) { return values(row - column, column); }
};

inline BandMatrix band_matrix(Eigen::Index size, int band) { return {band, Eigen::MatrixXd::Zero(band + 1, size)}; }

// Adds a 3 x 3 block of rows 3 a .. 3 a + 2 and columns 3 b .. 3 b + 2; for a = b its lower triangle is taken. A block
// above the diagonal (a < b) is added below it, transposed.
inline void add_block(int a, int b, const Eigen::Matrix3d& block, BandMatrix& K) {
    const Eigen::Index rows = K.values.rows();
    const Eigen::Index column = 3 * Eigen::Index{a < b ? a : b};
    const Eigen::Index below = 3 * Eigen::Index{a < b ? b - a : a - b};
    double* first = K.values.data() + column * rows + below;
    for (int c = 0; c < 3; ++c) {
        double* value = first + c * (rows - 1);
        for (int r = below == 0 ? c : 0; r < 3; ++r) value[r] += a < b ? block(c, r) : block(r, c);
    }
}

// Makes an equation u = 0 of one row and column, with `stiffness` on the diagonal.
void hold_equation(Eigen::Index equation, double stiffness, BandMatrix& K);

// LAPACK brings its threads back when it is first used after a fork: then they would take over the real-time priority of
// whoever uses it, and wait busily at that for a tenth of a second. So a thread without such a priority calls this before
// it starts a loop that factors, and after the last fork.
void bring_back_threads() noexcept;

// Replaces the matrix by its Cholesky factor (dpbtrf, n band^2 operations). Returns 0, or the number (from 1) of the
// first pivot that is not positive, or -1 in a build without LAPACK; then the values are of no use.
int factor_in_place(BandMatrix& K) noexcept;
// Replaces right-hand sides by solutions (dpbtrs), one per column.
void solve_in_place(const BandMatrix& factor, Eigen::Ref<Eigen::MatrixXd> block) noexcept;

}  // namespace palpa::mechanics
