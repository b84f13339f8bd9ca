#pragma once
// The beams of 100 x 10 x 10 mm of two materials whose deflections are known.

#include <vector>

#include "mechanics/material.h"
#include "mechanics/voxels.h"

namespace palpa::test {

inline const std::vector<mechanics::Material> kHardAndSoft{{8.3e9, 0.28}, {2e9, 0.394}};
enum class PaperBeam { homogeneous, hshsh, shshs, hsh, shs };

// `along` voxels along x; the voxels are cubes. 0 hard, 1 soft.
inline mechanics::Voxels paper_beam(PaperBeam kind, int along) {
    using namespace mechanics;
    const double h = 0.1 / along;
    const int across = along / 10;
    Voxels voxels = empty_voxels({along, across, across}, {h, {0.0, 0.0, 0.0}});
    EditHistory history;
    const bool soft_first = kind == PaperBeam::shshs || kind == PaperBeam::shs;
    apply({EditKind::add, {EverywhereRegion{}}, soft_first ? 1 : 0, {}}, voxels, history);
    BoxRegion middle{{-1.0, -1.0, 0.01 / 3.0}, {1.0, 1.0, 0.02 / 3.0}};
    if (kind == PaperBeam::hshsh || kind == PaperBeam::shshs)
        apply({EditKind::permute, {BandsRegion{0, 0.02, 0.04, 0.02}}, soft_first ? 0 : 1, {}}, voxels, history);
    if (kind == PaperBeam::hsh || kind == PaperBeam::shs)
        apply({EditKind::permute, {middle}, soft_first ? 0 : 1, {}}, voxels, history);
    return voxels;
}

}  // namespace palpa::test
