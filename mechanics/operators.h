#pragma once
// Responses of a factored problem: how any nodes move under any unit loads, by observation and load operators.
//
//   W = P K^-1 B
//
// P: observations, one row each: the sum of weight * displacement over its dofs (m, with weights that are ratios).
// B: loads, one column each: unit load k puts weight newtons on each of its dofs.
// W: rows x loads, in metres per unit load: how far observation i moves when load k is 1. Supports are held at 0 for W,
//    whatever displacement they prescribe, so that W is the change by the load alone.
//
// By Maxwell-Betti W of (P, B) is the transpose of W of (B, P). The cost is one solution per column, so for few
// observations of many loads it is cheaper to exchange P and B. The surface compliance (compliance.h) is the case in
// which both are nodes of the surface.
//
// Source: James & Pai, "A unified treatment of elastostatic contact simulation for real time haptics",
// Haptics-e 2(1), 2001. There the rows and columns are nodes of the boundary; here they are any dofs, with weights.

#include <atomic>
#include <functional>
#include <vector>

#include "mechanics/statics.h"

namespace palpa::mechanics {

// One dof of a node, with its weight. axis: 0, 1, 2 for x, y, z.
struct NodeWeight {
    int node = 0;
    int axis = 0;
    double weight = 1.0;
};

// A row of P or a column of B: its entries that are not zero. A dof that stands twice counts twice.
using NodeSum = std::vector<NodeWeight>;

struct Progress {
    std::function<void(int done, int total)> report;  // called with numbers of columns after each block; may be empty
    const std::atomic<bool>* cancel = nullptr;        // looked at before each block; may be null
};

// W, as above. block: right-hand sides solved at once. Throws LoadError for a node, axis or weight that the problem
// does not have (a node that is in no cell has no stiffness and is refused too), and Cancelled when asked to stop. May
// run in a worker thread; MUMPS is locked one block at a time.
Eigen::MatrixXd responses(const Factored& factored, const std::vector<NodeSum>& observations,
                          const std::vector<NodeSum>& loads, int block = 64, const Progress& progress = {});

// The same one column at a time, for callers that keep only part of W. take(k, q) gets the reduced solution of load k,
// which is valid until take returns; response() reads observations from it.
using TakeColumn = std::function<void(int load, const Eigen::Ref<const Eigen::VectorXd>& q_m)>;
void solve_loads(const Factored& factored, const std::vector<NodeSum>& loads, int block, const Progress& progress,
                 const TakeColumn& take);

// One entry, or one row, of W from a column's solution. Allocates nothing.
double response(const Reduction& reduction, const NodeWeight& observed, const Eigen::Ref<const Eigen::VectorXd>& q_m);
double response(const Reduction& reduction, const NodeSum& observed, const Eigen::Ref<const Eigen::VectorXd>& q_m);

}  // namespace palpa::mechanics
