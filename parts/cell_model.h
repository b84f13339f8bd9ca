#pragma once
// The finite cells of a part with its supports and loads.

#include "mechanics/voxel_load.h"
#include "parts/part_file.h"

namespace palpa::parts {

// Cells with the supports fixed.
struct CellModel {
    mechanics::VoxelCells cells;
    mechanics::GridLevel level;
};

// Throws InputError if a support holds no corner of a cell and if nothing holds the part; MeshError, MaterialError as
// cells_of().
CellModel cell_model(const Part& part, int voxels_per_cell);

// Returns the nodal forces of a load for 1 N, 3 x n_nodes. Throws InputError for a force on air.
Eigen::Matrix3Xd unit_load_N(const Part& part, const CellModel& model, const PartLoad& load);

// Returns the axis, 0 to 2, along which a direction is largest.
int largest_axis(const mechanics::Point& direction);

// How far displacements leave what is small: the largest principal strain, and the largest rotation, in the middle of
// cells that are at least half full.
struct CellStrain {
    double strain = 0.0;
    double rotation_rad = 0.0;
};
CellStrain greatest_strain(const CellModel& model, const Eigen::Matrix3Xd& u_m);

// Returns how many voxels a cell's edge has: that of the part, or cell_m over the pitch. Throws InputError unless that is
// a whole number.
int voxels_per_cell(const Part& part, const std::optional<double>& cell_m);

}  // namespace palpa::parts
