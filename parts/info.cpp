#include "parts/info.h"

#include <algorithm>

#include "files/sha256.h"

namespace palpa::parts {
namespace {

void append_int32(int value, std::string& out) {
    const auto bits = static_cast<std::uint32_t>(value);
    for (int byte = 0; byte < 4; ++byte) out.push_back(static_cast<char>(bits >> (8 * byte) & 0xFFU));
}

}  // namespace

std::string runs_sha256(const mechanics::Voxels& voxels) {
    std::string bytes;
    for (const int n : voxels.size) append_int32(n, bytes);
    for (int z = 0; z < voxels.size[2]; ++z) {
        for (int y = 0; y < voxels.size[1]; ++y) {
            for (const mechanics::Run& run : voxels.lines[line_of(voxels, y, z)]) {
                for (const int value : {z, y, run.x0, run.x1, run.material}) append_int32(value, bytes);
            }
        }
    }
    return files::sha256_hex(bytes);
}

PartInfo info_of(const Part& part) {
    const mechanics::Voxels& voxels = part.voxels;
    const mechanics::VoxelCounts counts = count(voxels, static_cast<int>(part.materials.size()));
    PartInfo out;
    out.voxels = counts.voxels;
    out.runs = counts.runs;
    out.memory_bytes = counts.memory_bytes;
    out.plain_bytes = voxels.lines.size() * static_cast<std::size_t>(voxels.size[0]);
    out.voxels_of_material = counts.of_material;
    const double voxel_m3 = voxels.frame.pitch_m * voxels.frame.pitch_m * voxels.frame.pitch_m;
    out.volume_m3 = static_cast<double>(counts.voxels) * voxel_m3;
    for (std::size_t m = 0; m < part.materials.size(); ++m) {
        const double mass_kg =
            static_cast<double>(counts.of_material[m]) * voxel_m3 * part.materials[m].density_kg_per_m3;
        out.mass_kg += mass_kg;
        for (std::size_t c = 0; c < 3; ++c) out.centroid_m[c] += mass_kg * counts.centre_m[m][c];
    }
    for (double& c : out.centroid_m) c /= out.mass_kg;
    out.runs_sha256 = runs_sha256(voxels);
    return out;
}

}  // namespace palpa::parts
