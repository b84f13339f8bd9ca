#pragma once
// What any nodes do under any unit loads, of one factored problem: observation and load operators.
//
//   W = P K^-1 B
//
// P: observations, one row each: the sum of weight * displacement over its dofs (m, with weights that are ratios).
// B: loads, one column each: unit load k puts weight newtons on each of its dofs.
// W: rows x loads, in metres per unit load: what observation i moves when load k is 1. Supports are held at 0 for
//    it, whatever displacement they give: W is the change by the load alone.
//
// By Maxwell-Betti W of (P, B) is the transpose of W of (B, P): whoever asks for few rows of many loads swaps them,
// since the cost is one solution a column. The surface compliance (compliance.h) is the case in which P and B are the
// surface's nodes.
//
// Source: James & Pai, "A unified treatment of elastostatic contact simulation for real time haptics",
// Haptics-e 2(1), 2001. There the rows and columns are nodes of the boundary; here any dofs, with weights.

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
    std::function<void(int done, int total)> report;  // columns, after each block; may be empty
    const std::atomic<bool>* cancel = nullptr;        // may be null
};

// W, as above. block: right-hand sides solved at once. Throws LoadError for a node, axis or weight that the problem
// does not have (a node that is in no cell has no stiffness and is refused too), and Cancelled when asked to stop. May
// run in a worker thread; MUMPS is locked one block at a time.
Eigen::MatrixXd responses(const Factored& factored, const std::vector<NodeSum>& observations,
                          const std::vector<NodeSum>& loads, int block = 64, const Progress& progress = {});

// The same a column at a time, for who keeps only part of it: take(k, q) gets the reduced solution of load k, valid
// until it returns, of which response() reads observations.
using TakeColumn = std::function<void(int load, const Eigen::Ref<const Eigen::VectorXd>& q_m)>;
void solve_loads(const Factored& factored, const std::vector<NodeSum>& loads, int block, const Progress& progress,
                 const TakeColumn& take);

// One entry, or one row, of W from a column's solution. Allocates nothing.
double response(const Reduction& reduction, const NodeWeight& observed, const Eigen::Ref<const Eigen::VectorXd>& q_m);
double response(const Reduction& reduction, const NodeSum& observed, const Eigen::Ref<const Eigen::VectorXd>& q_m);

}  // namespace palpa::mechanics
