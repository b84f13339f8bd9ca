#include "mechanics/operators.h"

#include <algorithm>
#include <cmath>

#include "mechanics/error.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

int dof_of(const NodeWeight& entry) { return 3 * entry.node + entry.axis; }

void check_sums(const Reduction& reduction, const std::vector<NodeSum>& sums, const char* what) {
    const auto n_nodes = static_cast<int>(reduction.equation.size() / 3);
    for (std::size_t i = 0; i < sums.size(); ++i) {
        for (const NodeWeight& entry : sums[i]) {
            const auto fail = [&](const auto&... why) { throw LoadError(text(what, " ", i, ": ", why...)); };
            if (entry.node < 0 || entry.node >= n_nodes)
                fail("node ", entry.node, " is not one of the mesh's ", n_nodes);
            if (entry.axis < 0 || entry.axis > 2)
                fail("axis ", entry.axis, " of node ", entry.node, ", must be 0 ... 2");
            if (!std::isfinite(entry.weight)) fail("the weight of node ", entry.node, " is not finite");
            if (reduction.equation[static_cast<std::size_t>(dof_of(entry))] == kLoose)
                fail("node ", entry.node, " is in no cell, so it has no stiffness");
        }
    }
}

}  // namespace

double response(const Reduction& reduction, const NodeWeight& observed, const Eigen::Ref<const Eigen::VectorXd>& q_m) {
    const int dof = dof_of(observed);
    const bool held = reduction.equation[static_cast<std::size_t>(dof)] == kPrescribed;
    return observed.weight * (held ? 0.0 : displacement_m(reduction, dof, q_m));
}

double response(const Reduction& reduction, const NodeSum& observed, const Eigen::Ref<const Eigen::VectorXd>& q_m) {
    double sum = 0.0;
    for (const NodeWeight& entry : observed) sum += response(reduction, entry, q_m);
    return sum;
}

void solve_loads(const Factored& factored, const std::vector<NodeSum>& loads, int block, const Progress& progress,
                 const TakeColumn& take) {
    if (block < 1) throw LoadError(text("loads in blocks of ", block, ", must be at least 1"));
    check_sums(factored.reduction, loads, "load");
    const auto total = static_cast<int>(loads.size());
    Eigen::MatrixXd columns;
    for (int first = 0; first < total; first += block) {
        if (progress.cancel != nullptr && progress.cancel->load())
            throw Cancelled(text("operators: stopped after ", first, " of ", total, " columns"));
        const int n = std::min(block, total - first);
        columns.setZero(factored.reduction.equations, n);
        for (int k = 0; k < n; ++k) {
            for (const NodeWeight& entry : loads[static_cast<std::size_t>(first + k)])
                add_force(factored.reduction, dof_of(entry), entry.weight, columns.col(k));
        }
        if (columns.rows() > 0) factored.cholesky.solve(columns);
        for (int k = 0; k < n; ++k) take(first + k, columns.col(k));
        if (progress.report) progress.report(first + n, total);
    }
}

Eigen::MatrixXd responses(const Factored& factored, const std::vector<NodeSum>& observations,
                          const std::vector<NodeSum>& loads, int block, const Progress& progress) {
    check_sums(factored.reduction, observations, "observation");
    Eigen::MatrixXd W(static_cast<Eigen::Index>(observations.size()), static_cast<Eigen::Index>(loads.size()));
    solve_loads(factored, loads, block, progress, [&](int load, const Eigen::Ref<const Eigen::VectorXd>& q_m) {
        for (Eigen::Index i = 0; i < W.rows(); ++i)
            W(i, load) = response(factored.reduction, observations[static_cast<std::size_t>(i)], q_m);
    });
    if (!W.allFinite()) throw SolverError("responses: some are not finite", 0);
    return W;
}

}  // namespace palpa::mechanics
