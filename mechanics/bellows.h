#pragma once
// Meshes of bellows: a thin wall turned about the z axis, open below, closed by a plate above.

#include "mechanics/mesh.h"

namespace palpa::mechanics {

// The wall lies about the line r(z) = radius - amplitude cos(2 pi waves z / height), z = 0 to height, half its thickness
// to each side along the line's normal; the plate lies on top of it, z = height to height + plate.
struct Bellows {
    double radius_m = 0.023;
    double amplitude_m = 0.003;
    double waves = 4.0;
    double height_m = 0.06;
    double wall_m = 0.002;
    double plate_m = 0.004;
    int sectors = 16;     // round about, a multiple of 4
    int along = 22;       // cells along the wall
    int through = 1;      // cells through the wall
    int plate_cells = 2;  // through the plate
    int rings = 0;        // of the plate, between its square middle and the wall
};

struct BellowsMesh {
    Mesh mesh;                // hexahedra
    std::vector<int> inside;  // nodes around the cavity, ascending: of wall and plate; it is open below
};

// Throws MeshError for numbers with which wall or plate has no volume.
BellowsMesh bellows(const Bellows& shape);

// Splits each hexahedron into six tetrahedra without new nodes: two prisms by the plane through the edges 0-4 and 2-6,
// each split along the diagonals from its lowest node numbers. Neighbours match if hexahedra that share the face 0123
// of one and 4567 of the other have their corners in the same order; their other faces may have any order.
// Source of the prism's split: Dompierre, Labbe, Vallet & Camarero, "How to subdivide pyramids, prisms and hexahedra
// into tetrahedra", International Meshing Roundtable 8 (1999).
Mesh split_columns_to_tets(const Mesh& hexes);

}  // namespace palpa::mechanics
