#include "mechanics/large_strain.h"

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "mechanics/banded.h"
#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/mesh_check.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

using Eigen::Matrix3Xd;
using Eigen::VectorXd;

// Adds the time until it ends.
struct Stopwatch {
    explicit Stopwatch(double& sum_s) : sum(sum_s) {}
    ~Stopwatch() { sum += std::chrono::duration<double>(std::chrono::steady_clock::now() - began).count(); }
    Stopwatch(const Stopwatch&) = delete;
    Stopwatch& operator=(const Stopwatch&) = delete;
    double& sum;
    std::chrono::steady_clock::time_point began = std::chrono::steady_clock::now();
};

struct Newton {
    const LargeBody& body;
    const Reduction& reduction;
    const Matrix3Xd& load_N;
    const LargeOptions& options;
    SparseCholesky cholesky;
    LowerMatrix K_N_per_m;
    LargeSolution& out;
    Matrix3Xd gradient_N;
};

VectorXd all_dofs(const Matrix3Xd& values) { return values.reshaped(); }

double work_J(const Newton& newton, double share, const Matrix3Xd& u_m) {
    return share * newton.load_N.cwiseProduct(u_m).sum();
}

// The displacements that supports prescribe at this share, 0 where free.
Matrix3Xd prescribed_m(const Newton& newton, double share) {
    return (share * newton.reduction.prescribed_m).reshaped(3, newton.load_N.cols());
}

// The round-off of the nodal forces: some hundred units of the greatest stiffness times the size of the body.
double round_off_N(const Newton& newton) {
    const LowerMatrix& K = newton.K_N_per_m;
    double stiffest_N_per_m = 0.0;
    for (Eigen::Index j = 0; j < K.cols(); ++j)
        stiffest_N_per_m = std::max(stiffest_N_per_m, std::abs(K.valuePtr()[K.outerIndexPtr()[j]]));
    const Matrix3Xd& x_m = newton.body.mesh.nodes_m;
    return 1e-13 * stiffest_N_per_m * (x_m.rowwise().maxCoeff() - x_m.rowwise().minCoeff()).norm();
}

// Returns what is left to balance at free dofs, as LargeSolution::residual. rhs: the reduced forces that are out of
// balance.
double residual_of(const Newton& newton, double share, VectorXd& rhs) {
    const Matrix3Xd left_N = share * newton.load_N - newton.gradient_N;
    rhs = reduce_load(newton.reduction, all_dofs(left_N));
    double size_N = newton.load_N.cwiseAbs().maxCoeff() * share;
    for (Eigen::Index dof = 0; dof < left_N.size(); ++dof) {
        if (newton.reduction.equation[at(dof)] == kPrescribed) size_N = std::max(size_N, std::abs(left_N.data()[dof]));
    }
    const double most_N = rhs.size() > 0 ? rhs.lpNorm<Eigen::Infinity>() : 0.0;
    return most_N / (size_N + round_off_N(newton) / newton.options.tolerance);
}

// Assembles and factors the tangent; false if even the repaired one has no factor. `repaired`: whether it had to be.
bool factor_tangent(Newton& newton, const Matrix3Xd& u_m, bool& repaired) {
    repaired = false;
    for (const Tangent kind : {Tangent::exact, Tangent::positive}) {
        {
            const Stopwatch watch(newton.out.assemble_s);
            const double energy = energy_tangent_N_per_m(newton.body, u_m, kind, newton.gradient_N, newton.K_N_per_m);
            if (!std::isfinite(energy)) return false;
        }
        if (newton.reduction.equations == 0) return true;
        const Stopwatch watch(newton.out.factor_s);
        const LowerMatrix A = reduce(newton.K_N_per_m, newton.reduction);
        if (newton.cholesky.try_factor(A)) return true;
        repaired = true;
        if (kind == Tangent::exact) continue;
        // what is singular without the negative eigenvalues gets a small stiffness of its own
        for (const double share : {1e-8, 1e-6, 1e-4}) {
            LowerMatrix shifted = A;
            const double more_N_per_m = share * A.diagonal().mean();
            for (Eigen::Index i = 0; i < A.cols(); ++i) shifted.coeffRef(i, i) += more_N_per_m;
            if (newton.cholesky.try_factor(shifted)) return true;
        }
    }
    return false;
}

VectorXd solved(Newton& newton, const VectorXd& rhs) {
    if (rhs.size() == 0) return rhs;
    const Stopwatch watch(newton.out.solve_s);
    Eigen::MatrixXd block = rhs;
    newton.cholesky.solve(block);
    return block.col(0);
}

// The displacement of all dofs for unknowns q, prescribed ones held at 0.
Matrix3Xd unknowns_as_m(const Newton& newton, const VectorXd& q_m) {
    return (expand(newton.reduction, q_m) - newton.reduction.prescribed_m).reshaped(3, newton.load_N.cols());
}

// Goes along `step` until the energy less the work has fallen enough. Sums of energies are only good to their
// round-off, so a full step near the minimum passes too. Returns false if nothing does.
bool search(const Newton& newton, double share, double slope_J, const Matrix3Xd& step_m, Matrix3Xd& u_m) {
    const double elastic_J = energy_J(newton.body, u_m);
    const double work = work_J(newton, share, u_m);
    const double noise_J = 1e-13 * (std::abs(elastic_J) + std::abs(work));
    for (double length = 1.0; length > 1e-8; length *= 0.5) {
        const Matrix3Xd there = u_m + length * step_m;
        const double total = energy_J(newton.body, there) - work_J(newton, share, there);
        if (!(total - (elastic_J - work) <= 1e-4 * length * slope_J + noise_J)) continue;
        u_m = there;
        return true;
    }
    return false;
}

// The first step at a new share: along the tangent, supports included. False if that leaves where the laws are defined.
bool predict(Newton& newton, double share, Matrix3Xd& u_m) {
    bool repaired = false;
    if (!factor_tangent(newton, u_m, repaired)) return false;
    newton.out.repairs += repaired ? 1 : 0;
    Matrix3Xd moved = prescribed_m(newton, share);
    for (Eigen::Index dof = 0; dof < moved.size(); ++dof) {
        const bool held = newton.reduction.equation[at(dof)] == kPrescribed;
        moved.data()[dof] = held ? moved.data()[dof] - u_m.data()[dof] : 0.0;
    }
    const VectorXd pulled = newton.K_N_per_m.selfadjointView<Eigen::Lower>() * all_dofs(moved);
    const Matrix3Xd left_N = share * newton.load_N - newton.gradient_N;
    const VectorXd q = solved(newton, reduce_load(newton.reduction, all_dofs(left_N) - pulled));
    const Matrix3Xd there = u_m + moved + unknowns_as_m(newton, q);
    if (!std::isfinite(energy_J(newton.body, there))) return false;
    u_m = there;
    return true;
}

// Newton's method at one share of the load. u_m: in, an equilibrium at another share, or a start; out, the equilibrium
// if true is returned.
bool equilibrium(Newton& newton, double share, Matrix3Xd& u_m) {
    const bool supports_move = (prescribed_m(newton, share) - prescribed_m(newton, newton.out.load_share)).norm() > 0.0;
    if (supports_move && !predict(newton, share, u_m)) return false;
    VectorXd rhs;
    for (int i = 0; i < newton.options.most_iterations; ++i) {
        bool repaired = false;
        if (!factor_tangent(newton, u_m, repaired)) return false;
        newton.out.residual = residual_of(newton, share, rhs);
        if (newton.out.residual <= newton.options.tolerance) {
            newton.out.stable = !repaired;
            return true;
        }
        newton.out.repairs += repaired ? 1 : 0;
        ++newton.out.iterations;
        const VectorXd q = solved(newton, rhs);
        if (!q.allFinite() || !search(newton, share, -rhs.dot(q), unknowns_as_m(newton, q), u_m)) return false;
    }
    return false;
}

Matrix3Xd reactions_N(const Newton& newton, double share) {
    Matrix3Xd out = Matrix3Xd::Zero(3, newton.load_N.cols());
    for (Eigen::Index dof = 0; dof < out.size(); ++dof) {
        if (newton.reduction.equation[at(dof)] == kPrescribed)
            out.data()[dof] = newton.gradient_N.data()[dof] - share * newton.load_N.data()[dof];
    }
    return out;
}

// Keeps u_m, an equilibrium, as the result.
void keep(Newton& newton, double share, const Matrix3Xd& u_m) {
    LargeSolution& out = newton.out;
    out.load_share = share;
    out.u_m = u_m;
    out.energy_J = energy_gradient_N(newton.body, u_m, newton.gradient_N);
    out.reaction_N = reactions_N(newton, share);
}

void load_up(Newton& newton, Matrix3Xd u_m) {
    LargeSolution& out = newton.out;
    double step = 1.0;
    while (out.load_share < 1.0) {
        const double share = std::min(1.0, out.load_share + step);
        const double residual_before = out.residual;
        const bool stable_before = out.stable;
        Matrix3Xd there = u_m;
        if (equilibrium(newton, share, there)) {
            ++out.load_steps;
            u_m = there;
            keep(newton, share, u_m);
            step *= 2.0;
            continue;
        }
        out.residual = residual_before;
        out.stable = stable_before;
        if (++out.halvings > newton.options.most_halvings || step < 1e-9) return;
        step *= 0.5;
    }
    out.status = LargeStatus::converged;
}

SolverKind chosen_solver(const LowerMatrix& A, const LargeOptions& options) {
    if (options.solver) return *options.solver;
    return banded_built_in() && banded_work(band_order(A)) < kBandedWork ? SolverKind::banded : best_solver();
}

void check_load(const Mesh& mesh, const Matrix3Xd& load_N) {
    if (load_N.cols() == mesh.nodes_m.cols() && load_N.allFinite()) return;
    throw LoadError(text("load: ", load_N.cols(), " columns for ", mesh.nodes_m.cols(), " nodes",
                         load_N.allFinite() ? "" : ", some not finite"));
}

}  // namespace

LargeSolution solve_large(const LargeProblem& problem, const Matrix3Xd& load_N, const LargeOptions& options,
                          const std::optional<Matrix3Xd>& start_m) {
    check_load(problem.mesh, load_N);
    check_mesh(problem.mesh);
    check_supported(problem.mesh, problem.supports);
    const LargeBody body = make_large_body(problem.mesh, problem.element, problem.materials);
    const Reduction reduction = make_reduction(problem.mesh, problem.supports, {});
    LowerMatrix pattern = tangent_pattern(body);
    const LowerMatrix A = reduce(pattern, reduction);
    LargeSolution out;
    out.equations = reduction.equations;
    out.solver = chosen_solver(A, options);
    SparseCholesky cholesky(out.solver);  // before the aggregate, as in statics.cpp
    Newton newton{body, reduction, load_N, options, std::move(cholesky), std::move(pattern), out, {}};
    if (reduction.equations > 0) newton.cholesky.analyse(A);

    Matrix3Xd u_m = Matrix3Xd::Zero(3, load_N.cols());
    if (start_m) {
        check_load(problem.mesh, *start_m);
        for (Eigen::Index dof = 0; dof < u_m.size(); ++dof) {
            if (reduction.equation[at(dof)] >= 0) u_m.data()[dof] = start_m->data()[dof];
        }
        if (!std::isfinite(energy_J(body, u_m))) throw LoadError("start: the energy of this shape is infinite");
    }
    keep(newton, 0.0, u_m);
    load_up(newton, u_m);
    return out;
}

}  // namespace palpa::mechanics
