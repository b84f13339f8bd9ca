#pragma once
// Seams: places where cells touch without being joined. A node on the outside lies there in another cell's outer face.

#include <vector>

#include "mechanics/mesh.h"

namespace palpa::mechanics {

struct Seam {
    int node = -1;
    int cell = -1;   // the cell in whose face the node lies
    int other = -1;  // the cell's corner at the same place; -1 if the node lies inside the face or on its edge
};

// Each node is at most once in each list; both are in the order of the nodes.
struct Seams {
    std::vector<Seam> hanging;  // the node meets no corner, so that the two sides cannot have the same displacement
    std::vector<Seam> doubled;  // two nodes at one place, as along a slit or between two bodies that were meshed apart
};

// A node lies in a face if it is nearer than this times the face's size: meshes are written with at least seven digits,
// and an intended gap is wider.
inline constexpr double kSeam = 1e-6;

// outer: boundary_faces(mesh). A conforming mesh in one piece has no seams.
Seams find_seams(const Mesh& mesh, const Faces& outer);

}  // namespace palpa::mechanics
