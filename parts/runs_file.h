#pragma once
// Runs of voxels as a NumPy file: int32 [n, 5], a row for each run: z, y, x0, x1, material (voxels x0 to x1 - 1; materials by
// their place in the part file, from 0).

#include <filesystem>
#include <string>
#include <vector>

#include "files/npy.h"
#include "mechanics/voxel_overlay.h"

namespace palpa::parts {

// Return the runs sorted by z, y and x0, in whatever order the file has them. Throw InputError, which names the row: for
// another shape, for runs that are empty or leave the voxels, for materials that are not there, and for runs that overlap.
std::vector<mechanics::PlacedRun> read_runs(const std::filesystem::path& path, const mechanics::Voxels& voxels,
                                            int n_materials);
std::vector<mechanics::PlacedRun> runs_of(const files::NpyIntegers& rows, const std::string& file_name,
                                          const mechanics::Voxels& voxels, int n_materials);

// Writes all runs of a part, whole or not at all. Throws std::runtime_error if the file cannot be written.
void write_runs(const mechanics::Voxels& voxels, const std::filesystem::path& path);

}  // namespace palpa::parts
