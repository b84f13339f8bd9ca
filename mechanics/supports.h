#pragma once
// Which displacements are given, and the equations that are left.

#include <Eigen/SparseCore>
#include <string_view>
#include <vector>

#include "mechanics/mesh.h"
#include "mechanics/stiffness.h"

namespace palpa::mechanics {

// Given displacements: dof 3 i + c of node i, axis c. Clamped: "xyz" to 0. Symmetric about a plane: its
// normal axis to 0.
struct Supports {
    std::vector<int> dof;
    std::vector<double> value_m;
};

// axes: any of "x", "y", "z" together, as in a case file. Throws SupportError for another letter.
void fix(const std::vector<int>& nodes, std::string_view axes, double value_m, Supports& supports);

// Throws SupportError when a part of the mesh can move without resistance, naming the part and its free
// motions, and when one displacement is given two values. Parts are rigid bodies here, supports and shared
// nodes their conditions: the null space of all conditions must be empty (hinges between parts are found as
// well as floating bodies).
void check_supported(const Mesh& mesh, const Supports& supports);

// What becomes of each dof: an equation number >= 0, or one of these.
inline constexpr int kPrescribed = -1;
inline constexpr int kLoose = -2;   // its node is in no cell
inline constexpr int kOnBody = -3;  // moves with a rigid body

// u = T q + u_given. For dofs with an equation T is a one; `body` holds the rows of rigid bodies' nodes:
//   u(x) = t + w x (x - c) / L,   c, L: centre and size of the body, six unknowns (t, w) in metres.
struct Reduction {
    int equations = 0;
    std::vector<int> equation;                          // one per dof
    Eigen::VectorXd prescribed_m;                       // one per dof, 0 where free
    Eigen::SparseMatrix<double, Eigen::RowMajor> body;  // n_dof x equations; no entries when nothing is rigid
};

// rigid_cell: one flag per cell, or empty. Rigid cells with a common node are one body; a body that touches a
// support must be held by it completely and without strain, else SupportError.
Reduction make_reduction(const Mesh& mesh, const Supports& supports, const std::vector<bool>& rigid_cell);

// Lower triangle of T^T K T.
LowerMatrix reduce(const LowerMatrix& K, const Reduction& reduction);

// T^T f for one load, and T q + u_given for one solution (3 x n_nodes, as a vector of dofs).
Eigen::VectorXd reduce_load(const Reduction& reduction, const Eigen::VectorXd& f_N);
Eigen::VectorXd expand(const Reduction& reduction, const Eigen::VectorXd& q_m);

// One dof at a time: adds a force to a right-hand side, reads a displacement off a solution.
void add_force(const Reduction& reduction, int dof, double force_N, Eigen::Ref<Eigen::VectorXd> rhs);
double displacement_m(const Reduction& reduction, int dof, const Eigen::Ref<const Eigen::VectorXd>& q_m);

}  // namespace palpa::mechanics
