#pragma once
// Which faces of voxels around one corner of the lattice belong to one vertex of a surface.

#include <array>
#include <cstdint>

namespace palpa::parts {

// Octant o of a corner is the voxel on side (o & 1, o >> 1 & 1, o >> 2) of it along x, y, z. Face 3 o + a is that between
// octant o, which is filled, and its neighbour along axis a, which is not. Edge 2 a + side leaves the corner along axis a.
using Fans = std::array<std::uint8_t, 24>;

// Says whether two filled octants are joined by faces of filled ones around the corner. filled: a bit per octant.
bool joined_around(unsigned filled, int octant, int other);

// The two filled octants of an edge about which only two that face each other diagonally are filled; {-1, -1} otherwise.
std::array<int, 2> diagonal_of(unsigned filled, int edge);

// Returns the number of the fan, from 0, of each face around the corner. Faces that share an edge are in one fan. At an edge
// with four faces, two of a voxel belong together if the edge's bit in `joined` is not set; else two that look at the same
// empty voxel. With the bit set just where joined_around() holds at both ends of an edge, no two fans meet in two vertices:
// voxels that are joined at both ends enclose the empty ones between them, whose faces then close a fan of their own.
Fans fans_of(unsigned filled, unsigned joined);

}  // namespace palpa::parts
