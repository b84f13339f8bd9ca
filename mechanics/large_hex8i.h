#pragma once
// hex8i at large strains: the linear stiffness of a cell with incompatible modes (elements.h), turned with the cell.
//
//   E = 1/2 d^T K d,   d_a = R^T (x_a - xbar) - (X_a - Xbar)
//
// x: corners now, X: at rest, bars: means over the corners; R the rotation nearest to F = x grad N at the cell's middle.
// It holds for large rotations and small strains, as thin walls have them.
// Source: Felippa & Haugen, "A unified formulation of small-strain corotational finite elements", CMAME 194 (2005), for
// the idea; the tangent, which is exact, is ours.

#include "mechanics/large_elements.h"

namespace palpa::mechanics {

struct IncompatibleRest {
    HexMatrix stiffness_N_per_m;
    Hex gradient_per_m;  // of the shape functions, in the middle
    Hex corners_m;       // from their mean
};
IncompatibleRest incompatible_rest_of(const Hex& corners_m, const Material& material);

void incompatible_cell(const IncompatibleRest& rest, const Hex& x_m, Wanted wanted, LargeCell<8>& out);

}  // namespace palpa::mechanics
