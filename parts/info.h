#pragma once
// What a part is made of.

#include <string>

#include "parts/part_file.h"

namespace palpa::parts {

struct PartInfo {
    std::int64_t voxels = 0;  // that are filled
    std::int64_t runs = 0;
    std::size_t memory_bytes = 0;  // of the runs
    std::size_t plain_bytes = 0;   // of one byte per voxel, empty ones too
    double volume_m3 = 0.0;
    double mass_kg = 0.0;
    mechanics::Point centroid_m{};  // of the mass
    std::vector<std::int64_t> voxels_of_material;
    std::string runs_sha256;
};
PartInfo info_of(const Part& part);

// SHA-256 of the runs, as little-endian 32-bit numbers: size x, y, z, then z y x0 x1 material for each run, lines in the
// order of y, then z. Parts with the same voxels have the same hash.
std::string runs_sha256(const mechanics::Voxels& voxels);

}  // namespace palpa::parts
