#pragma once
// Volumes of interest, cut into spans of voxels along x.

#include <array>
#include <memory>
#include <variant>
#include <vector>

#include "mechanics/triangle_solid.h"

namespace palpa::mechanics {

using Point = std::array<double, 3>;  // x, y, z

// Voxel (i, j, k) is the cube from origin + pitch (i, j, k) to origin + pitch (i + 1, j + 1, k + 1). It is in a region if
// its centre is.
struct VoxelFrame {
    double pitch_m = 1e-3;
    Point origin_m{0.0, 0.0, 0.0};
};

struct EverywhereRegion {};
struct BoxRegion {
    Point min_m{};
    Point max_m{};
};
struct BallRegion {
    Point centre_m{};
    double radius_m = 0.0;
};
// Between two flat ends, which are square to the axis.
struct CylinderRegion {
    Point from_m{};
    Point to_m{};
    double radius_m = 0.0;
};
// What a tool takes away that moves along a path: a ball, or a cylinder about the path (the same with flat ends at the
// first and the last point; at corners between it is round).
struct PathRegion {
    std::vector<Point> points_m;
    double radius_m = 0.0;
    bool flat_ends = false;
};
// Slabs square to an axis: offset + n period <= x < offset + n period + width, for all integers n.
struct BandsRegion {
    int axis = 0;
    double offset_m = 0.0;
    double period_m = 1e-3;
    double width_m = 0.5e-3;
};
// What triangles bound.
struct SolidRegion {
    std::shared_ptr<const TriangleSolid> solid;
};
struct Region;
// all: where all parts are. any: where one is. without: the first part less all others.
enum class Boolean { all, any, without };
struct BooleanRegion {
    Boolean kind = Boolean::any;
    std::vector<Region> parts;
};
struct Region {
    std::variant<EverywhereRegion, BoxRegion, BallRegion, CylinderRegion, PathRegion, BandsRegion, SolidRegion,
                 BooleanRegion>
        shape;
};

// Voxels x0 <= x < x1.
struct Span {
    int x0 = 0;
    int x1 = 0;
    bool operator==(const Span&) const = default;
};

// Writes the spans of a line of `length` voxels that are in the region, sorted, disjoint and not touching. (y, z): the
// line. Centres within 1e-9 of a voxel below a boundary count as on it, so that boxes whose sides are voxel faces, in
// decimal fractions, come out as meant.
void spans_of(const Region& region, const VoxelFrame& frame, int length, int y, int z, std::vector<Span>& out);

// Lines that the region can touch: y0 <= y < y1, z0 <= z < z1, within ny x nz.
struct LineRange {
    int y0 = 0, y1 = 0, z0 = 0, z1 = 0;
};
LineRange lines_of(const Region& region, const VoxelFrame& frame, int ny, int nz);

// Says whether a point is in the region (for supports and loads).
bool contains(const Region& region, const Point& at_m);

}  // namespace palpa::mechanics
