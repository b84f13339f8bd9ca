#pragma once
// How large a contact is whose forces are known at nodes only.

#include <span>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

// Nodes inside the contact count with their whole share of the surface, nodes at its rim with
//
//   w = min(1, 1/3 + q^2 / (Q^2 - q^2))
//
// of it. q: pressure of the rim node, Q: the greatest among its neighbours in contact. Near the rim of a smooth
// contact p^2 grows in proportion to the distance from the rim (Hertz), so that q^2 / (Q^2 - q^2) spacings lie
// between the node and the rim. Whole shares for all nodes in contact are 14 to 31 % too large with three to five
// spacings across the radius. One or two nodes tell nothing.
//
// surface: faces of the whole surface; node_area_m2: tributary, per mesh node; nodes: in contact, each pressed
// with pressing_N > 0.
double contact_area_m2(const Faces& surface, const Eigen::VectorXd& node_area_m2, std::span<const int> nodes,
                       std::span<const double> pressing_N);

}  // namespace palpa::mechanics
