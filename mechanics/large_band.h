#pragma once
// The tangent of a body at large strains, summed straight into band storage, for loops. The nodes are numbered so that
// the band is narrow; those from K.size() / 3 on are held and have no equations.

#include "mechanics/band_matrix.h"
#include "mechanics/large_body.h"

namespace palpa::mechanics {

// Adds gradient (3 x n_nodes) and tangent to what stands there already, and returns the energy. Where it is infinite
// (hyperelastic.h), the sums are incomplete. Allocates nothing.
double add_energy_gradient_N(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Eigen::Matrix3Xd& gradient_N) noexcept;
double add_energy_tangent_N_per_m(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Tangent kind,
                                  Eigen::Matrix3Xd& gradient_N, BandMatrix& K_N_per_m) noexcept;

// An order of the nodes for which the band is narrow: node_at[place] is a node. `held` nodes come last; `cliques` are
// lists of nodes that are coupled besides those of a cell. band: the half-bandwidth of the equations, three per node.
struct NodeOrder {
    std::vector<int> node_at;
    int free_nodes = 0;
    int band = 0;
};
NodeOrder node_order(const Mesh& mesh, const std::vector<bool>& held, const std::vector<std::vector<int>>& cliques);

// The same mesh with nodes numbered by that order. node_number is kept.
Mesh renumbered(const Mesh& mesh, const NodeOrder& order);

}  // namespace palpa::mechanics
