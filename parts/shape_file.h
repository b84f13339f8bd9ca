#pragma once
// The operations that make a part's shape, one after the other, as part files and `palpa part edit` spell them.

#include "parts/part_file.h"

namespace palpa::parts {

// Does one operation {add | remove | permute | sculpt: region, material, from} or {runs: file} to the voxels, as one entry of
// the history, and returns how many voxels changed. Throws InputError with the part as it was: for what is no operation,
// for an unknown material, and for a region that reaches no voxel.
std::int64_t apply_operation(files::JsonReader& json, Part& part);

// Throws InputError unless one body is left, whose voxels are joined by faces.
void check_shape(const Part& part);

}  // namespace palpa::parts
