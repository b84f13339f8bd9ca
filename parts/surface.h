#pragma once
// Closed surfaces of a part's materials, for printers and for drawing.

#include <array>
#include <vector>

#include "mechanics/voxels.h"

namespace palpa::parts {

// Triangles of one material, counter-clockwise as seen from outside it. Each edge of a triangle is used by exactly one other
// triangle, which runs along it the other way.
struct Surface {
    int material = 0;
    std::vector<mechanics::Point> vertices_m;
    std::vector<std::array<int, 3>> triangles;
};

// Returns a surface for each material that has voxels, in their order: two triangles per voxel face that looks at another
// material or out of the part. Where two materials touch, both have the same corners and the same diagonals, so that neither
// gaps nor overlaps lie between them. Where a material touches itself along an edge or at a corner only, it has a vertex for
// each side: four triangles at one edge are what slicers cut wrongly.
//
// smooth: corners move towards the middle of their neighbours on the surface, by at most half a voxel, the same way for all
// materials that share them; corners at which a surface was split stay. Volumes then differ from the voxels'.
// Source of the smoothing: Taubin, "A signal processing approach to fair surface design", SIGGRAPH 1995, section 2, with his
// factors 0.5 and -0.53; the bound is that of Gibson, "Constrained elastic surface nets", MICCAI 1998.
// Throws MeshError for more than 254 materials, and if the box around the part has more than kMostSurfaceVoxels.
inline constexpr std::int64_t kMostSurfaceVoxels = std::int64_t{1} << 31;
std::vector<Surface> surfaces_of(const mechanics::Voxels& voxels, bool smooth = false);

// Sum of a . (b x c) / 6 over the triangles.
double volume_m3(const Surface& surface);

}  // namespace palpa::parts
