#pragma once
// Where cells touch without being joined: nodes on the outside that lie in another cell's outer face.

#include <vector>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

struct Seam {
    int node = -1;
    int cell = -1;   // whose face the node lies in
    int other = -1;  // its corner at the same place; -1: the node lies inside the face or on its edge
};

// Each node once in each list, in the order of the nodes.
struct Seams {
    std::vector<Seam> hanging;  // no corner there: the two sides cannot have the same displacement
    std::vector<Seam> doubled;  // two nodes at one place, as a slit has them and two bodies meshed apart
};

// A node lies in a face when it is nearer than this times the face's size: meshes are written with at least
// seven digits, and a gap that somebody meant is wider.
inline constexpr double kSeam = 1e-6;

// outer: boundary_faces(mesh). A conforming mesh of one piece has none.
Seams find_seams(const Mesh& mesh, const Faces& outer);

}  // namespace palpa::mechanics
