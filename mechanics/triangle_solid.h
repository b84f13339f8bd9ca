#pragma once
// A body bounded by triangles (an STL): where lines along an axis go into it and come out, and whether it is closed.

#include <array>
#include <cstdint>
#include <vector>

namespace palpa::mechanics {

using Triangle = std::array<std::array<double, 3>, 3>;  // corners, m, counter-clockwise as seen from outside

// Triangles by squares of a grid across an axis, so that a line along it looks at few of them.
struct TriangleBins {
    int axis = 0;
    std::array<int, 2> n{1, 1};
    std::array<double, 2> low_m{};
    std::array<double, 2> per_m{};     // squares per metre
    std::vector<std::uint32_t> first;  // of each square, and the end
    std::vector<std::uint32_t> triangle;
};

struct TriangleSolid {
    std::vector<Triangle> triangles;
    std::array<double, 3> low_m{}, high_m{};  // the box around them
    TriangleBins along_x;
};

// Throws MeshError for no triangles, more than kMostTriangles, and numbers that are not finite.
inline constexpr std::size_t kMostTriangles = 20'000'000;
TriangleSolid make_solid(std::vector<Triangle> triangles);
TriangleBins bins_of(const std::vector<Triangle>& triangles, int axis, const std::array<double, 3>& low_m,
                     const std::array<double, 3>& high_m);

// Part of a line that is inside, m.
struct Stretch {
    double low_m = 0.0;
    double high_m = 0.0;
};
// What a line says of the surface: a closed one is left as often as it is entered.
struct LineCount {
    bool closed = true;
    bool turned = false;  // somewhere it was left more often than entered: triangles that face inwards
};

// Writes where the line along bins.axis through (u, v) is inside, in order. u, v: its places along the next two axes (y, z
// for x; z, x for y; x, y for z). Inside is where the line has been entered more often than left, so that bodies that
// overlap are one, and cavities are empty. Edges are compared in an order of their own and not their triangle's, so that
// rounding opens no closed surface. Without an end, an inner stretch goes on to the box.
LineCount stretches_of(const TriangleSolid& solid, const TriangleBins& bins, double u_m, double v_m,
                       std::vector<Stretch>& out);

struct SolidCheck {
    double volume_m3 = 0.0;   // of what the triangles bound: sum of a . (b x c) / 6; negative if they face inwards
    double open_share = 0.0;  // of the lines, those that do not close or whose voxels the other two axes see otherwise
    double turned_share = 0.0;    // of the lines, those that find triangles that face inwards
    std::int64_t open_edges = 0;  // of triangles, without a partner that runs the other way between the same two points
};
// Looks along lines of all three axes, 1/`most_along` of the longest side apart.
SolidCheck check_solid(const TriangleSolid& solid, int most_along = 256);

}  // namespace palpa::mechanics
