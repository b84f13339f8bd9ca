#include "mechanics/statics.h"

#include <algorithm>
#include <chrono>
#include <utility>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

double seconds_since(std::chrono::steady_clock::time_point start) {
    return std::chrono::duration<double>(std::chrono::steady_clock::now() - start).count();
}

std::vector<bool> rigid_cells(const Problem& problem) {
    double softest = problem.materials.front().young_Pa;
    for (const Material& m : problem.materials) softest = std::min(softest, m.young_Pa);
    std::vector<bool> rigid(problem.materials.size(), false);
    bool any = false;
    for (std::size_t i = 0; i < rigid.size(); ++i) {
        rigid[i] = problem.materials[i].young_Pa > problem.rigid_contrast * softest;
        any = any || rigid[i];
    }
    if (!any) rigid.clear();
    return rigid;
}

// Solves A q = b, then refines q with the residual while that lowers the backward error. Returns the backward error.
double solve_refined(const Factored& factored, const Eigen::VectorXd& b, Eigen::VectorXd& q) {
    Eigen::MatrixXd block = b;
    factored.cholesky.solve(block);
    q = block.col(0);
    double error = backward_error(factored.A_N_per_m, q, b);
    for (int i = 0; i < 2 && error > 1e-16; ++i) {
        block.col(0) = b - factored.A_N_per_m.selfadjointView<Eigen::Lower>() * q;
        factored.cholesky.solve(block);
        const Eigen::VectorXd better = q + block.col(0);
        const double smaller = backward_error(factored.A_N_per_m, better, b);
        if (!(smaller < error)) break;
        q = better;
        error = smaller;
    }
    return error;
}

}  // namespace

Factored factorise(const Problem& problem, SolverKind solver) {
    check_materials(problem.materials);
    // before the aggregate: GCC 12 destroys its first members twice if a later one throws
    SparseCholesky cholesky(solver);
    auto checked = check_mesh(problem.mesh);
    Factored out{{}, {}, {}, std::move(cholesky), std::move(checked), 0.0, 0.0};
    check_supported(problem.mesh, problem.supports);

    const auto start = std::chrono::steady_clock::now();
    if (static_cast<Eigen::Index>(problem.materials.size()) != problem.mesh.cells.cols()) {
        throw MaterialError(text(problem.materials.size(), " materials for ", problem.mesh.cells.cols(), " cells"), {});
    }
    const std::vector<bool> rigid = rigid_cells(problem);
    out.K_N_per_m = stiffness_N_per_m(problem.mesh, problem.element, problem.materials, rigid);
    out.reduction = make_reduction(problem.mesh, problem.supports, rigid);
    out.A_N_per_m = reduce(out.K_N_per_m, out.reduction);
    out.assemble_s = seconds_since(start);

    const auto middle = std::chrono::steady_clock::now();
    if (out.reduction.equations > 0) {
        out.cholesky.analyse(out.A_N_per_m);
        out.cholesky.factor(out.A_N_per_m);
    }
    out.factor_s = seconds_since(middle);
    return out;
}

Solution solve(const Factored& factored, const Eigen::Matrix3Xd& load_N) {
    const auto start = std::chrono::steady_clock::now();
    const Eigen::Index n_dof = factored.K_N_per_m.rows();
    if (load_N.size() != n_dof || !load_N.allFinite()) {
        throw LoadError(text("load: ", load_N.cols(), " columns for ", n_dof / 3, " nodes",
                             load_N.allFinite() ? "" : ", some not finite"));
    }
    const auto K = factored.K_N_per_m.selfadjointView<Eigen::Lower>();
    const Eigen::Map<const Eigen::VectorXd> f(load_N.data(), n_dof);
    const Eigen::VectorXd given = expand(factored.reduction, Eigen::VectorXd::Zero(factored.reduction.equations));
    const Eigen::VectorXd b = reduce_load(factored.reduction, f - K * given);

    Solution out;
    Eigen::VectorXd q(factored.reduction.equations);
    if (q.size() > 0) out.backward_error = solve_refined(factored, b, q);
    out.u_m = expand(factored.reduction, q).reshaped(3, n_dof / 3);
    const Eigen::Map<const Eigen::VectorXd> u(out.u_m.data(), n_dof);
    const Eigen::VectorXd internal = K * u;
    out.reaction_N = Eigen::Matrix3Xd::Zero(3, n_dof / 3);
    for (Eigen::Index dof = 0; dof < n_dof; ++dof) {
        if (factored.reduction.equation[static_cast<std::size_t>(dof)] == kPrescribed)
            out.reaction_N.data()[dof] = internal(dof) - f(dof);
    }
    out.energy_J = 0.5 * u.dot(internal);
    out.work_J = 0.5 * (f.dot(u) + out.reaction_N.reshaped().dot(u));
    out.solve_s = seconds_since(start);
    return out;
}

}  // namespace palpa::mechanics
