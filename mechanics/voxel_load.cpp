#include "mechanics/voxel_load.h"

#include <Eigen/Eigenvalues>
#include <Eigen/Geometry>
#include <algorithm>
#include <cmath>
#include <limits>

#include "mechanics/error.h"
#include "mechanics/index.h"
#include "mechanics/text.h"

namespace palpa::mechanics {
namespace {

// Calls visit(voxel) for the voxels of a box whose neighbour along the axis is empty.
template <class Visit>
void for_each_exposed(const Voxels& voxels, const FilledBox& box, int axis, bool up, const Visit& visit) {
    std::array<int, 3> v{};
    for (v[2] = box.low[2]; v[2] < box.high[2]; ++v[2]) {
        for (v[1] = box.low[1]; v[1] < box.high[1]; ++v[1]) {
            for (const Run& run : voxels.lines[line_of(voxels, v[1], v[2])]) {
                for (v[0] = std::max(run.x0, box.low[0]); v[0] < std::min(run.x1, box.high[0]); ++v[0]) {
                    std::array<int, 3> next = v;
                    next[at(axis)] += up ? 1 : -1;
                    if (material_at(voxels, next[0], next[1], next[2]) < 0) visit(v);
                }
            }
        }
    }
}

Point face_centre_m(const Voxels& voxels, const std::array<int, 3>& v, int axis, bool up) {
    Point out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double along = c != at(axis) ? 0.5 : (up ? 1.0 : 0.0);
        out[c] = voxels.frame.origin_m[c] + (v[c] + along) * voxels.frame.pitch_m;
    }
    return out;
}

Point node_m(const VoxelCells& cells, const std::array<int, 3>& place) {
    Point out{};
    for (std::size_t c = 0; c < 3; ++c) out[c] = cells.origin_m[c] + place[c] * cells.cell_m;
    return out;
}

// The cell that holds a face, and the place in it, 0..1: the cell on the inner side of the face.
struct PlaceInCell {
    std::array<int, 3> cell{};
    Point local{};
};
PlaceInCell place_of(const VoxelCells& cells, const VoxelFaces& faces, const Point& centre_m) {
    PlaceInCell out;
    const double inwards_m = 0.25 * cells.cell_m / cells.voxels_per_cell * (faces.outwards_up ? -1.0 : 1.0);
    for (std::size_t c = 0; c < 3; ++c) {
        const double place = (centre_m[c] - cells.origin_m[c]) / cells.cell_m;
        const double inside = place + (c == at(faces.axis) ? inwards_m / cells.cell_m : 0.0);
        out.cell[c] = std::clamp(static_cast<int>(std::floor(inside)), 0, cells.n[c] - 1);
        out.local[c] = place - out.cell[c];
    }
    return out;
}

}  // namespace

FilledBox filled_box(const Voxels& voxels) {
    constexpr int kHigh = std::numeric_limits<int>::max();
    FilledBox out{{kHigh, kHigh, kHigh}, {0, 0, 0}};
    for (int z = 0; z < voxels.size[2]; ++z) {
        for (int y = 0; y < voxels.size[1]; ++y) {
            const std::vector<Run>& line = voxels.lines[line_of(voxels, y, z)];
            if (line.empty()) continue;
            const std::array<int, 3> low{line.front().x0, y, z}, high{line.back().x1, y + 1, z + 1};
            for (std::size_t c = 0; c < 3; ++c) {
                out.low[c] = std::min(out.low[c], low[c]);
                out.high[c] = std::max(out.high[c], high[c]);
            }
        }
    }
    return out;
}

VoxelFaces faces_on_side(const Voxels& voxels, Side side) {
    const int axis = axis_of(side);
    VoxelFaces out{axis, is_max(side), {}, voxels.frame.pitch_m * voxels.frame.pitch_m};
    FilledBox box = filled_box(voxels);
    if (is_max(side)) {
        box.low[at(axis)] = box.high[at(axis)] - 1;
    } else {
        box.high[at(axis)] = std::min(box.high[at(axis)], box.low[at(axis)] + 1);
    }
    for_each_exposed(voxels, box, axis, is_max(side), [&](const std::array<int, 3>& v) {
        out.centre_m.push_back(face_centre_m(voxels, v, axis, is_max(side)));
    });
    return out;
}

VoxelFaces faces_near(const Voxels& voxels, const Point& at_m, double radius_m, int axis, bool outwards_up) {
    const double h = voxels.frame.pitch_m;
    VoxelFaces out{axis, outwards_up, {}, h * h};
    FilledBox box;
    for (std::size_t c = 0; c < 3; ++c) {
        const double place = (at_m[c] - voxels.frame.origin_m[c]) / h, reach = radius_m / h + 1.0;
        box.low[c] = static_cast<int>(std::clamp(std::floor(place - reach), 0.0, double{kMostVoxelsAlong}));
        box.high[c] = static_cast<int>(std::clamp(std::ceil(place + reach), 0.0, double(voxels.size[c])));
    }
    for_each_exposed(voxels, box, axis, outwards_up, [&](const std::array<int, 3>& v) {
        const Point centre_m = face_centre_m(voxels, v, axis, outwards_up);
        double distance2 = 0.0;
        for (std::size_t c = 0; c < 3; ++c) distance2 += (centre_m[c] - at_m[c]) * (centre_m[c] - at_m[c]);
        if (distance2 <= radius_m * radius_m) out.centre_m.push_back(centre_m);
    });
    return out;
}

Eigen::Matrix3Xd spread_force(const VoxelCells& cells, const GridLevel& level, const VoxelFaces& faces,
                              const Point& force_N) {
    if (faces.centre_m.empty()) throw LoadError("there is no surface of the part under the load");
    const NodeNumbers number(level);
    Eigen::Matrix3Xd out = Eigen::Matrix3Xd::Zero(3, n_nodes(level));
    const Eigen::Vector3d each_N =
        Eigen::Vector3d(force_N[0], force_N[1], force_N[2]) / static_cast<double>(faces.centre_m.size());
    for (const Point& centre_m : faces.centre_m) {
        // N_a is bilinear on a voxel's face, so that its mean there is its value at the face's centre
        const PlaceInCell place = place_of(cells, faces, centre_m);
        for (int corner = 0; corner < 8; ++corner) {
            double N = 1.0;
            std::array<int, 3> node = place.cell;
            for (int c = 0; c < 3; ++c) {
                const bool high = (corner >> c & 1) != 0;
                N *= high ? place.local[at(c)] : 1.0 - place.local[at(c)];
                node[at(c)] += high ? 1 : 0;
            }
            out.col(number(node[0], node[1], node[2])) += N * each_N;
        }
    }
    return out;
}

int fix_side(const Voxels& voxels, const VoxelCells& cells, const GridLevel& level, Side side, std::uint8_t axes,
             std::vector<std::uint8_t>& fixed) {
    const FilledBox box = filled_box(voxels);
    const std::size_t axis = at(axis_of(side));
    const double plane = static_cast<double>(is_max(side) ? box.high[axis] : box.low[axis]) / cells.voxels_per_cell;
    const int nearest = static_cast<int>(std::lround(plane));
    int n = 0;
    for (std::size_t i = 0; i < level.node_place.size(); ++i) {
        if (level.node_place[i][axis] != nearest) continue;
        fixed[i] = static_cast<std::uint8_t>(fixed[i] | axes);
        ++n;
    }
    return n;
}

int fix_region(const VoxelCells& cells, const GridLevel& level, const Region& region, std::uint8_t axes,
               std::vector<std::uint8_t>& fixed) {
    // What counts is what lies beside a node, where the body is: on a side of the region, the region may lie on either hand
    // (it reaches from its lower sides to just below its upper ones), and what it leaves out of the body is free, though all
    // beyond the body may belong to it.
    std::vector<std::uint8_t> octants(level.node_place.size(), 0);  // bit of each octant in which a cell lies
    for (std::size_t i = 0; i < level.corners.size(); ++i) {
        for (const int node : level.corners[i]) {
            int octant = 0;  // bit c: the cell lies below the node along c
            for (int c = 0; c < 3; ++c)
                octant |= static_cast<int>(level.node_place[at(node)][at(c)] > level.cell_place[i][at(c)]) << c;
            octants[at(node)] = static_cast<std::uint8_t>(octants[at(node)] | 1 << octant);
        }
    }
    const double aside_m = 1e-6 * cells.cell_m;
    const auto is_held = [&](const Point& node_at_m, int in_octants) {
        for (int octant = 0; octant < 8; ++octant) {
            Point near_m = node_at_m;
            for (int c = 0; c < 3; ++c) near_m[at(c)] += (octant >> c & 1) != 0 ? -aside_m : aside_m;
            if ((in_octants >> octant & 1) != 0 && contains(region, near_m)) return true;
        }
        return false;
    };
    constexpr int kAllAround = 0xFF;  // a region that only touches the body from outside holds it there
    int n = 0;
    for (const bool outside : {false, true}) {
        for (std::size_t i = 0; i < level.node_place.size(); ++i) {
            if (!is_held(node_m(cells, level.node_place[i]), outside ? kAllAround : octants[i])) continue;
            fixed[i] = static_cast<std::uint8_t>(fixed[i] | axes);
            ++n;
        }
        if (n > 0) break;
    }
    return n;
}

// The rigid motions that all fixed dofs leave free are the null space of sum over fixed dofs of c c^T, c: the dof's
// displacement by each of six unit motions.
std::string free_motions(const VoxelCells& cells, const GridLevel& level, const std::vector<std::uint8_t>& fixed) {
    const double size = std::max({cells.n[0], cells.n[1], cells.n[2]});
    Eigen::Matrix<double, 6, 6> sum = Eigen::Matrix<double, 6, 6>::Zero();
    for (std::size_t i = 0; i < level.node_place.size(); ++i) {
        const auto& p = level.node_place[i];
        const Eigen::Vector3d x =
            Eigen::Vector3d(p[0] - 0.5 * cells.n[0], p[1] - 0.5 * cells.n[1], p[2] - 0.5 * cells.n[2]) / size;
        for (int c = 0; c < 3; ++c) {
            if ((fixed[i] >> c & 1) == 0) continue;
            Eigen::Matrix<double, 6, 1> row = Eigen::Matrix<double, 6, 1>::Zero();
            row(c) = 1.0;
            for (int turn = 0; turn < 3; ++turn) row(3 + turn) = Eigen::Vector3d::Unit(turn).cross(x)(c);
            sum += row * row.transpose();
        }
    }
    const Eigen::SelfAdjointEigenSolver<Eigen::Matrix<double, 6, 6>> eigen(sum);
    static constexpr std::array<const char*, 6> kMotions{"moves along x", "moves along y", "moves along z",
                                                         "turns about x", "turns about y", "turns about z"};
    std::string out;
    for (int i = 0; i < 6; ++i) {
        if (eigen.eigenvalues()(i) > 1e-9 * std::max(1.0, eigen.eigenvalues()(5))) continue;
        Eigen::Index largest = 0;
        eigen.eigenvectors().col(i).cwiseAbs().maxCoeff(&largest);
        out += text(out.empty() ? "" : ", ", kMotions[at(largest)]);
    }
    return out;
}

}  // namespace palpa::mechanics
