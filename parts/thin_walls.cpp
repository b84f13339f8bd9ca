#include "parts/thin_walls.h"

#include <array>

namespace palpa::parts {
namespace {

using namespace mechanics;

// Voxels of one material from this one on along an axis, itself included, at most `most`.
int run_length(const Voxels& voxels, std::array<int, 3> at, std::size_t axis, int step, int most) {
    const int material = material_at(voxels, at[0], at[1], at[2]);
    int length = 1;
    for (; length < most; ++length) {
        at[axis] += step;
        if (material_at(voxels, at[0], at[1], at[2]) != material) break;
    }
    return length;
}

bool is_thin(const Voxels& voxels, const std::array<int, 3>& at, int least) {
    for (std::size_t axis = 0; axis < 3; ++axis) {
        if (run_length(voxels, at, axis, -1, least) + run_length(voxels, at, axis, 1, least) - 1 < least) return true;
    }
    return false;
}

}  // namespace

double share_of_thin_walls(const Voxels& voxels, int least) {
    constexpr std::int64_t kLookedAt = 20'000;
    const std::int64_t every = count(voxels, 0).voxels / kLookedAt | 1;  // odd: lines have even lengths more often
    std::int64_t voxel = 0, looked_at = 0, thin = 0;
    for (int z = 0; z < voxels.size[2]; ++z) {
        for (int y = 0; y < voxels.size[1]; ++y) {
            for (const Run& run : voxels.lines[line_of(voxels, y, z)]) {
                for (int x = run.x0; x < run.x1; ++x) {
                    if (voxel++ % every != 0) continue;
                    ++looked_at;
                    thin += is_thin(voxels, {x, y, z}, least);
                }
            }
        }
    }
    return looked_at == 0 ? 0.0 : static_cast<double>(thin) / static_cast<double>(looked_at);
}

}  // namespace palpa::parts
