#pragma once
// Prescribed displacements, and the equations that are left.

#include <Eigen/SparseCore>
#include <string_view>
#include <vector>

#include "mechanics/mesh.h"
#include "mechanics/stiffness.h"

namespace palpa::mechanics {

// Prescribed displacements: dof 3 i + c belongs to node i, axis c. A clamped node has "xyz" at 0; a plane of symmetry
// has the axis of its normal at 0.
struct Supports {
    std::vector<int> dof;
    std::vector<double> value_m;
};

// Adds supports that give the nodes one displacement along each of some axes. axes: some of the letters x, y and z, as
// in a case file. Throws SupportError for another letter.
void fix(const std::vector<int>& nodes, std::string_view axes, double value_m, Supports& supports);

// Throws SupportError if a part of the mesh can move without resistance, naming the part and its free motions, and for
// more than 200 parts. Each part is taken as a rigid body; supports and shared nodes are conditions on its motion. The
// null space of all conditions must be empty, so that hinges between parts are found as well as floating parts.
void check_supported(const Mesh& mesh, const Supports& supports);

// What becomes of each dof: the number of its equation, >= 0, or one of these.
inline constexpr int kPrescribed = -1;
inline constexpr int kLoose = -2;   // its node is in no cell
inline constexpr int kOnBody = -3;  // its node moves with a rigid body

// The displacements of all dofs are u = T q + u_prescribed, q being the unknowns of the equations. The row of T for a
// dof with an equation holds a single one; `body` holds the rows for nodes of rigid bodies,
//   u(x) = t + w x (x - c) / L
// c, L: centre and size of the body; t, w: its six unknowns, in metres.
struct Reduction {
    int equations = 0;
    std::vector<int> equation;                          // one per dof
    Eigen::VectorXd prescribed_m;                       // one per dof, 0 where free
    Eigen::SparseMatrix<double, Eigen::RowMajor> body;  // n_dof x equations; no entries when nothing is rigid
};

// rigid_cell: one flag per cell, or empty for none. Rigid cells with a common node are one body. Throws SupportError if
// one displacement is given two values, and if a body that a support touches is not held completely and without strain.
Reduction make_reduction(const Mesh& mesh, const Supports& supports, const std::vector<bool>& rigid_cell);

// Returns the lower triangle of T^T K T.
LowerMatrix reduce(const LowerMatrix& K, const Reduction& reduction);

// Return T^T f for one load, and T q + u_prescribed for one solution; f and u are vectors of all dofs.
Eigen::VectorXd reduce_load(const Reduction& reduction, const Eigen::VectorXd& f_N);
Eigen::VectorXd expand(const Reduction& reduction, const Eigen::VectorXd& q_m);

// The same for one dof: add a force to a right-hand side, and read a displacement from a solution.
void add_force(const Reduction& reduction, int dof, double force_N, Eigen::Ref<Eigen::VectorXd> rhs);
double displacement_m(const Reduction& reduction, int dof, const Eigen::Ref<const Eigen::VectorXd>& q_m);

}  // namespace palpa::mechanics
