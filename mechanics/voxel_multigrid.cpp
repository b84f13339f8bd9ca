#include "mechanics/voxel_multigrid.h"

#include <Eigen/LU>
#include <algorithm>
#include <cmath>

#include "mechanics/index.h"

namespace palpa::mechanics {
namespace {

using Eigen::Matrix3Xd;

// out = D^-1 r
void apply_inverse_diagonal(const GridLevel& level, const Matrix3Xd& r, Matrix3Xd& out) {
    out.resize(3, r.cols());
    for (int i = 0; i < n_nodes(level); ++i) out.col(i).noalias() = level.inverse_m_per_N[at(i)] * r.col(i);
}

// Largest eigenvalue of D^-1 K of one cell, D being its diagonal blocks, by 30 steps of the power iteration.
double largest_of_cell(const HexMatrix& K) {
    HexMatrix D_inverse = HexMatrix::Zero();
    for (int a = 0; a < 8; ++a) {
        Eigen::Matrix3d block = K.block<3, 3>(3 * a, 3 * a);
        for (int c = 0; c < 3; ++c) {
            if (!(block(c, c) > 0.0)) block(c, c) = 1.0;
        }
        D_inverse.block<3, 3>(3 * a, 3 * a) = block.inverse();
    }
    Eigen::Matrix<double, 24, 1> x;
    for (int i = 0; i < 24; ++i) x(i) = std::sin(1.0 + 2.6 * i);
    double value = 0.0;
    for (int step = 0; step < 30; ++step) {
        const Eigen::Matrix<double, 24, 1> Kx = K * x, next = D_inverse * Kx;
        const double work = x.dot(Kx);
        if (!(work > 0.0)) return value;
        value = Kx.dot(next) / work;  // in the norm of K, in which D^-1 K is symmetric too
        x = next / next.norm();
    }
    return value;
}

// Returns a bound of the largest eigenvalue of D^-1 K on a level: x . K x is the sum over cells, and so is x . D x, so that
// it is at most that of any cell. 5 % are added for what the power iteration leaves. An estimate below the true value
// makes the V-cycle indefinite.
double largest_eigenvalue(const GridLevel& level) {
    double largest = 1.0;
    for (const HexMatrix& K : level.stiffness_N_per_m) largest = std::max(largest, largest_of_cell(K));
    return 1.05 * largest;
}

constexpr double kSmoothed = 8.0;  // eigenvalues from largest / 8 are the smoother's

// Two steps of Chebyshev's iteration. On entry b is the residual at x; it becomes the residual after the first step and, if
// `residual` is wanted, after both.
void smooth(const GridLevel& level, double largest, bool residual, Matrix3Xd& x, Matrix3Xd& b, Matrix3Xd& d,
            Matrix3Xd& Kd) {
    const double low = largest / kSmoothed;
    const double middle = 0.5 * (largest + low), half = 0.5 * (largest - low);
    const double rho = half / middle;
    const double rho_next = 1.0 / (2.0 * middle / half - rho);
    apply_inverse_diagonal(level, b, d);
    d /= middle;
    x += d;
    multiply(level, d, Kd);
    b -= Kd;
    apply_inverse_diagonal(level, b, Kd);
    d = rho_next * rho * d + (2.0 * rho_next / half) * Kd;
    x += d;
    if (!residual) return;
    multiply(level, d, Kd);
    b -= Kd;
}

void restrict_to(const GridLevel& fine, const Matrix3Xd& r, Matrix3Xd& coarse) {
    coarse.setZero();
    for (int i = 0; i < n_nodes(fine); ++i) {
        const Eigen::Vector3d share = 0.125 * r.col(i);
        for (const int node : fine.coarse[at(i)]) coarse.col(node) += share;
    }
}

void add_prolonged(const GridLevel& fine, const Matrix3Xd& coarse, Matrix3Xd& x) {
    for (int i = 0; i < n_nodes(fine); ++i) {
        Eigen::Vector3d sum = Eigen::Vector3d::Zero();
        for (const int node : fine.coarse[at(i)]) sum += coarse.col(node);
        x.col(i) += 0.125 * (fine.free.size() > 0 ? sum.cwiseProduct(fine.free.col(i)).eval() : sum);
    }
}

void descend(const Multigrid& multigrid, std::size_t l, MultigridWork& work) {
    const GridLevel& level = multigrid.levels[l];
    Matrix3Xd& x = work.x[l];
    Matrix3Xd& b = work.b[l];
    if (l + 1 == multigrid.levels.size()) {
        Eigen::MatrixXd column = b.reshaped();
        multigrid.bottom.solve(column);
        x = column.reshaped(3, b.cols());
        return;
    }
    x.setZero();
    smooth(level, multigrid.largest[l], true, x, b, work.d[l], work.Kd[l]);
    restrict_to(level, b, work.b[l + 1]);
    descend(multigrid, l + 1, work);
    // the correction enters x, and K times it leaves the residual
    work.d[l].setZero();
    add_prolonged(level, work.x[l + 1], work.d[l]);
    x += work.d[l];
    multiply(level, work.d[l], work.Kd[l]);
    b -= work.Kd[l];
    smooth(level, multigrid.largest[l], false, x, b, work.d[l], work.Kd[l]);
}

}  // namespace

Multigrid make_multigrid(GridLevel finest, int bottom_nodes) {
    Multigrid out;
    out.levels.push_back(std::move(finest));
    while (n_nodes(out.levels.back()) > bottom_nodes) {
        GridLevel next = coarser_level(out.levels.back());
        const bool smaller = n_nodes(next) < n_nodes(out.levels.back());
        if (!smaller) break;
        out.levels.push_back(std::move(next));
    }
    for (std::size_t l = 0; l + 1 < out.levels.size(); ++l) out.largest.push_back(largest_eigenvalue(out.levels[l]));
    // the shift keeps motions that fixed dofs have left without stiffness from being singular
    const LowerMatrix K = assembled(out.levels.back(), 1e-12);
    out.bottom.analyse(K);
    out.bottom.factor(K);
    return out;
}

void v_cycle(const Multigrid& multigrid, const Matrix3Xd& r, MultigridWork& work, Matrix3Xd& z) {
    const std::size_t n = multigrid.levels.size();
    for (auto* vectors : {&work.x, &work.b, &work.d, &work.Kd}) vectors->resize(n);
    for (std::size_t l = 0; l < n; ++l) {
        for (auto* vectors : {&work.x, &work.b, &work.d, &work.Kd})
            (*vectors)[l].resize(3, n_nodes(multigrid.levels[l]));
    }
    work.b[0] = r;
    descend(multigrid, 0, work);
    z = work.x[0];
}

}  // namespace palpa::mechanics
