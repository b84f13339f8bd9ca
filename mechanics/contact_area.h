#pragma once
// The area of a contact whose forces are known only at nodes.

#include <span>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

// Nodes inside the contact count with their whole tributary area, nodes at its rim with the share
//
//   w = min(1, 1/3 + q^2 / (Q^2 - q^2))
//
// of it. q: pressure of the rim node; Q: the greatest pressure among its neighbours in contact. Near the rim of a
// smooth contact p^2 grows in proportion to the distance from the rim (Hertz), so that q^2 / (Q^2 - q^2) spacings lie
// between the node and the rim. If all nodes in contact counted whole, the area would be 14 to 31 % too large with
// three to five spacings across the radius. With only one or two nodes in contact the result has no meaning.
//
// surface: faces of the whole surface; node_area_m2: tributary area of each mesh node; nodes: those in contact, each
// pressed with its pressing_N > 0.
double contact_area_m2(const Faces& surface, const Eigen::VectorXd& node_area_m2, std::span<const int> nodes,
                       std::span<const double> pressing_N);

}  // namespace palpa::mechanics
