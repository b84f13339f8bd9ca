#pragma once
// A body at large strains: energy, its gradient and its tangent for all cells together.

#include <vector>

#include "mechanics/assembly.h"
#include "mechanics/large_elements.h"
#include "mechanics/large_hex8i.h"

namespace palpa::mechanics {

struct LargeBody {
    Mesh mesh;
    Element element = Element::hex8_bbar;
    std::vector<LargeMaterial> materials;  // one per cell
    std::vector<CellRest<8>> hexes;        // one per cell, or none
    std::vector<CellRest<4>> tets;         // one per cell, or none
    std::vector<IncompatibleRest> walls;   // one per cell of element hex8i, or none
    Neighbours near;
};

// Throws MeshError and MaterialError as stiffness_N_per_m() and check_large_materials() do, and for hex8i with a law that
// is not corotational.
LargeBody make_large_body(const Mesh& mesh, Element element, std::vector<LargeMaterial> materials);

// The elastic energy at displacements u_m (3 x n_nodes), J; infinite where a law is not defined. The sums run in the
// order of the cells, so that they are the same to the last bit every time.
double energy_J(const LargeBody& body, const Eigen::Matrix3Xd& u_m);
// Writes the gradient too: minus the forces of the body on its nodes, 3 x n_nodes. Not if the energy is infinite.
double energy_gradient_N(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Eigen::Matrix3Xd& gradient_N);
// Writes the tangent too, in the pattern of tangent_pattern(). positive: without the negative eigenvalues of cells.
enum class Tangent { exact, positive };
double energy_tangent_N_per_m(const LargeBody& body, const Eigen::Matrix3Xd& u_m, Tangent kind,
                              Eigen::Matrix3Xd& gradient_N, LowerMatrix& K_N_per_m);
inline LowerMatrix tangent_pattern(const LargeBody& body) { return pattern_of(body.near); }

// One cell of the body as it is at u_m; see large_cell(). N: 8 or 4 corners, as the element has.
template <int N>
void cell_of(const LargeBody& body, Eigen::Index cell, const Eigen::Matrix3Xd& u_m, Wanted wanted, LargeCell<N>& out);

// Mean strain (Green-Lagrange) and stress (Cauchy) of each cell, 6 x n_cells.
CellFields large_cell_fields(const LargeBody& body, const Eigen::Matrix3Xd& u_m);

}  // namespace palpa::mechanics
