#include "mechanics/voxel_solve.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Matrix3Xd;

double dot(const Matrix3Xd& a, const Matrix3Xd& b) { return a.cwiseProduct(b).sum(); }

Matrix3Xd free_load(const GridLevel& level, const Matrix3Xd& load_N) {
    if (load_N.cols() != n_nodes(level) || !load_N.allFinite()) {
        throw LoadError(text("load: ", load_N.cols(), " columns for ", n_nodes(level), " nodes",
                             load_N.allFinite() ? "" : ", some not finite"));
    }
    return load_N.cwiseProduct(level.free);
}

// Returns the sum of the latest terms, back to the first that is five times the last; -1 while there is none.
double error_estimate(const std::vector<double>& terms) {
    double sum = 0.0;
    for (std::size_t k = terms.size(); k-- > 0;) {
        sum += terms[k];
        if (terms[k] >= 5.0 * terms.back() && k + 1 < terms.size()) return sum;
    }
    return -1.0;
}

// One step. Returns alpha (r, z), by which the squared error falls; not finite or negative if the step must not be taken.
double step(const Multigrid& multigrid, VoxelIteration& it) {
    multiply(multigrid.levels.front(), it.p, it.Kp);
    const double alpha = it.rz / dot(it.p, it.Kp);
    const double term = alpha * it.rz;
    if (!(std::isfinite(term) && alpha > 0.0)) return -1.0;
    it.solution.u_m += alpha * it.p;
    it.r -= alpha * it.Kp;
    v_cycle(multigrid, it.r, it.work, it.z);
    const double rz = dot(it.r, it.z);
    it.p = it.z + (rz / it.rz) * it.p;
    it.rz = rz;
    return term;
}

}  // namespace

VoxelIteration begin_solve(const Multigrid& multigrid, const Matrix3Xd& load_N, const VoxelStop& stop,
                           const Matrix3Xd& start) {
    const GridLevel& level = multigrid.levels.front();
    VoxelIteration it;
    it.stop = stop;
    it.f = free_load(level, load_N);
    it.solution.u_m.setZero(3, it.f.cols());
    it.r = it.f;
    if (start.size() > 0) {
        it.solution.u_m = start.cwiseProduct(level.free);
        multiply(level, it.solution.u_m, it.Kp);
        it.r -= it.Kp;
    }
    v_cycle(multigrid, it.r, it.work, it.z);
    it.p = it.z;
    it.rz = dot(it.r, it.z);
    it.solution.converged = it.rz == 0.0;
    return it;
}

bool advance(const Multigrid& multigrid, VoxelIteration& it) {
    VoxelSolution& out = it.solution;
    const double term =
        it.ended || out.converged || out.iterations >= it.stop.most_iterations ? -1.0 : step(multigrid, it);
    if (term < 0.0) {
        it.ended = true;
        out.work_J = dot(it.f, out.u_m) + dot(it.r, out.u_m);  // K u = f - r
        return false;
    }
    ++out.iterations;
    it.terms.push_back(term);
    const double energy = dot(it.f, out.u_m) + dot(it.r, out.u_m);
    const double estimate = error_estimate(it.terms);
    out.energy_error = estimate >= 0.0 && energy > 0.0 ? estimate / energy : 1.0;
    out.converged = out.energy_error <= it.stop.energy_error || it.rz == 0.0;
    return true;
}

VoxelSolution solve(const Multigrid& multigrid, const Matrix3Xd& load_N, const VoxelStop& stop,
                    const Matrix3Xd& start) {
    VoxelIteration it = begin_solve(multigrid, load_N, stop, start);
    while (advance(multigrid, it)) {
    }
    return std::move(it.solution);
}

DirectSolution solve_directly(const GridLevel& level, const Matrix3Xd& load_N) {
    const Matrix3Xd f = free_load(level, load_N);
    const LowerMatrix K = assembled(level, 0.0);
    SparseCholesky cholesky(best_solver());
    cholesky.analyse(K);
    cholesky.factor(K);
    Eigen::MatrixXd block = f.reshaped();
    cholesky.solve(block);
    const Eigen::VectorXd u = block.col(0);
    return {u.reshaped(3, f.cols()), dot(f, u.reshaped(3, f.cols())), backward_error(K, u, f.reshaped())};
}

std::size_t memory_bytes(const Multigrid& multigrid) {
    std::size_t bytes = 0;
    for (const GridLevel& level : multigrid.levels) {
        bytes += level.stiffness_N_per_m.size() * sizeof(HexMatrix);
        bytes += level.cell_place.size() * (sizeof(level.cell_place[0]) + sizeof(level.corners[0]));
        // a node: its place, its coarse nodes, its block, and four vectors of three numbers
        bytes += level.node_place.size() * (sizeof(level.node_place[0]) + sizeof(std::array<int, 8>) +
                                            sizeof(Eigen::Matrix3d) + 12 * sizeof(double));
    }
    return bytes;
}

}  // namespace palpa::mechanics
