#pragma once
// Supports and loads of a part, from its voxels to the nodes of its cells.

#include <cstdint>
#include <string>
#include <vector>

#include "mechanics/mesh.h"
#include "mechanics/voxel_grid.h"

namespace palpa::mechanics {

// Sides of voxels that lie in one plane direction: `axis`, outwards to +axis or -axis.
struct VoxelFaces {
    int axis = 0;
    bool outwards_up = true;
    std::vector<Point> centre_m;
    double area_m2 = 0.0;  // of one
};

// Return the voxel faces that look out of the part: those in one side of the box around all that is filled, or those whose
// centre is within `radius_m` of a place, looking along an axis, up or down.
VoxelFaces faces_on_side(const Voxels& voxels, Side side);
VoxelFaces faces_near(const Voxels& voxels, const Point& at_m, double radius_m, int axis, bool outwards_up);

// Returns nodal forces, 3 x n_nodes, of `force_N` spread evenly over the faces: F_a = t int N_a dA, exactly. Throws
// LoadError if there are no faces.
Eigen::Matrix3Xd spread_force(const VoxelCells& cells, const GridLevel& level, const VoxelFaces& faces,
                              const Point& force_N);

// Add bits (1 x, 2 y, 4 z) to the nodes of the grid's plane that is nearest to that side of all that is filled, or to the
// nodes in a region or on its surface, where cells beside the node are in it; if there are none, to those that the region touches
// from outside. Return how many nodes these are.
int fix_side(const Voxels& voxels, const VoxelCells& cells, const GridLevel& level, Side side, std::uint8_t axes,
             std::vector<std::uint8_t>& fixed);
int fix_region(const VoxelCells& cells, const GridLevel& level, const Region& region, std::uint8_t axes,
               std::vector<std::uint8_t>& fixed);

// Names the free motions of the part as one rigid body, "moves along x, turns about y"; "" if the nodes hold it.
std::string free_motions(const VoxelCells& cells, const GridLevel& level, const std::vector<std::uint8_t>& fixed);

// First and last + 1 voxel that is filled, along each axis; low > high if there is none.
struct FilledBox {
    std::array<int, 3> low{};
    std::array<int, 3> high{};
};
FilledBox filled_box(const Voxels& voxels);

}  // namespace palpa::mechanics
