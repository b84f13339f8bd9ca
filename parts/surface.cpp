#include "parts/surface.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <optional>
#include <unordered_map>

#include "mechanics/error.h"
#include "mechanics/text.h"
#include "mechanics/voxel_load.h"
#include "parts/surface_fans.h"

namespace palpa::parts {
namespace {

using namespace mechanics;
using VoxelPlace = std::array<int, 3>;

constexpr int kMostMaterials = 254;
constexpr int kBorder = 2;  // an edge's other end asks for the voxels around it

// The box around all that is filled, a byte per voxel, with empty ones around it.
struct Block {
    VoxelPlace low{}, n{};             // first voxel of the part, voxels with the border
    std::vector<std::uint8_t> filled;  // material + 1

    std::size_t at(int x, int y, int z) const {
        return static_cast<std::size_t>(x) +
               static_cast<std::size_t>(n[0]) *
                   (static_cast<std::size_t>(y) + static_cast<std::size_t>(n[1]) * static_cast<std::size_t>(z));
    }
};

Block block_of(const Voxels& voxels) {
    const FilledBox box = filled_box(voxels);
    Block block;
    std::int64_t bytes = 1;
    for (std::size_t c = 0; c < 3; ++c) {
        block.low[c] = box.low[c];
        block.n[c] = std::max(0, box.high[c] - box.low[c]) + 2 * kBorder;
        bytes *= block.n[c];
    }
    if (bytes > kMostSurfaceVoxels) {
        throw MeshError(text(bytes, " voxels in the box around the part, must be at most ", kMostSurfaceVoxels), {});
    }
    block.filled.resize(static_cast<std::size_t>(bytes));
    for (int z = box.low[2]; z < box.high[2]; ++z) {
        for (int y = box.low[1]; y < box.high[1]; ++y) {
            for (const Run& run : voxels.lines[line_of(voxels, y, z)]) {
                if (run.material >= kMostMaterials)
                    throw MeshError(text("material ", run.material, ", must be below ", kMostMaterials), {});
                const auto from = block.filled.begin() + static_cast<std::ptrdiff_t>(block.at(
                                                             run.x0 - box.low[0] + kBorder, y - box.low[1] + kBorder,
                                                             z - box.low[2] + kBorder));
                std::fill(from, from + (run.x1 - run.x0), static_cast<std::uint8_t>(run.material + 1));
            }
        }
    }
    return block;
}

// Makes the surface of one material.
class Builder {
  public:
    Builder(const Block& block, int material) : block_(block), own_(static_cast<std::uint8_t>(material + 1)) {}

    struct Result {
        std::vector<std::size_t> corner;  // of each vertex: its place in the lattice, as Block::at() numbers voxels
        std::vector<std::array<int, 3>> triangles;
        std::vector<std::size_t> split;  // corners with more than one vertex
    };
    Result build() {
        for (int z = kBorder; z < block_.n[2] - kBorder; ++z) {
            for (int y = kBorder; y < block_.n[1] - kBorder; ++y) {
                for (int x = kBorder; x < block_.n[0] - kBorder; ++x) {
                    if (block_.filled[block_.at(x, y, z)] == own_) add_faces({x, y, z});
                }
            }
        }
        return std::move(result_);
    }

  private:
    // The octants around a corner that are of this material.
    unsigned filled_around(const VoxelPlace& corner) const {
        unsigned out = 0;
        for (int o = 0; o < 8; ++o) {
            const std::size_t voxel =
                block_.at(corner[0] - 1 + (o & 1), corner[1] - 1 + (o >> 1 & 1), corner[2] - 1 + (o >> 2));
            if (block_.filled[voxel] == own_) out |= 1U << o;
        }
        return out;
    }

    // Edges whose four faces are joined across, as fans_of() wants them.
    unsigned joined_edges(const VoxelPlace& corner, unsigned filled) const {
        unsigned out = 0;
        for (int edge = 0; edge < 6; ++edge) {
            const auto [p, q] = diagonal_of(filled, edge);
            if (p < 0 || !joined_around(filled, p, q)) continue;
            VoxelPlace other = corner;
            other[static_cast<std::size_t>(edge / 2)] += edge % 2 == 0 ? -1 : 1;
            const int turned = 1 << (edge / 2);
            if (joined_around(filled_around(other), p ^ turned, q ^ turned)) out |= 1U << edge;
        }
        return out;
    }

    const Fans& fans_around(const VoxelPlace& corner) {
        const unsigned filled = filled_around(corner);
        const unsigned joined = joined_edges(corner, filled);
        std::optional<Fans>& known = fans_[filled | joined << 8];
        if (!known) known = fans_of(filled, joined);
        return *known;
    }

    int vertex(const VoxelPlace& corner, int face) {
        const std::uint8_t fan = fans_around(corner)[static_cast<std::size_t>(face)];
        const std::size_t place = block_.at(corner[0], corner[1], corner[2]);
        const auto [found, is_new] =
            vertices_.try_emplace(8 * std::uint64_t{place} + fan, static_cast<int>(result_.corner.size()));
        if (is_new) {
            result_.corner.push_back(place);
            if (fan > 0) result_.split.push_back(place);
        }
        return found->second;
    }

    void add_faces(const VoxelPlace& voxel) {
        for (int a = 0; a < 3; ++a) {
            for (const int side : {0, 1}) {
                VoxelPlace next = voxel;
                next[static_cast<std::size_t>(a)] += 2 * side - 1;
                if (block_.filled[block_.at(next[0], next[1], next[2])] != own_) add_quad(voxel, a, side);
            }
        }
    }

    void add_quad(const VoxelPlace& voxel, int a, int side) {
        constexpr int kRound[4][2] = {{0, 0}, {1, 0}, {1, 1}, {0, 1}};
        const int b = (a + 1) % 3, c = (a + 2) % 3;
        std::array<int, 4> q{};
        for (std::size_t i = 0; i < 4; ++i) {
            VoxelPlace high{};  // 1 where the corner is on the voxel's high side
            high[static_cast<std::size_t>(a)] = side;
            high[static_cast<std::size_t>(b)] = kRound[i][0];
            high[static_cast<std::size_t>(c)] = kRound[i][1];
            const int octant = (1 - high[0]) | (1 - high[1]) << 1 | (1 - high[2]) << 2;
            q[i] = vertex({voxel[0] + high[0], voxel[1] + high[1], voxel[2] + high[2]}, 3 * octant + a);
        }
        // one diagonal for both sides of a face
        if (side == 1) {
            result_.triangles.push_back({q[0], q[1], q[2]});
            result_.triangles.push_back({q[0], q[2], q[3]});
        } else {
            result_.triangles.push_back({q[0], q[2], q[1]});
            result_.triangles.push_back({q[0], q[3], q[2]});
        }
    }

    const Block& block_;
    std::uint8_t own_;
    Result result_;
    std::unordered_map<std::uint64_t, int> vertices_;
    std::vector<std::optional<Fans>> fans_ = std::vector<std::optional<Fans>>(std::size_t{1} << 14);
};

// Corners of all surfaces, each once, and how they move.
struct Lattice {
    std::unordered_map<std::size_t, std::size_t> number;
    std::vector<std::array<double, 3>> moved;  // voxels
    std::vector<std::uint8_t> edges;           // bit 2 a + side: a surface has the edge along axis a
    std::vector<std::uint8_t> held;
};

Lattice lattice_of(const Block& block, const std::vector<Builder::Result>& built) {
    Lattice lattice;
    const std::array<std::size_t, 3> stride{block.at(1, 0, 0), block.at(0, 1, 0), block.at(0, 0, 1)};
    for (const Builder::Result& surface : built) {
        for (const std::size_t corner : surface.corner) {
            if (lattice.number.try_emplace(corner, lattice.number.size()).second) {
                lattice.edges.push_back(0);
                lattice.held.push_back(0);
            }
        }
        for (const std::size_t corner : surface.split) lattice.held[lattice.number.at(corner)] = 1;
        for (const auto& triangle : surface.triangles) {
            for (std::size_t i = 0; i < 3; ++i) {
                const std::size_t from = surface.corner[static_cast<std::size_t>(triangle[i])];
                const std::size_t to = surface.corner[static_cast<std::size_t>(triangle[(i + 1) % 3])];
                for (std::size_t a = 0; a < 3; ++a) {  // diagonals are no edges of the lattice
                    auto& edges = lattice.edges[lattice.number.at(from)];
                    if (to == from + stride[a]) edges = static_cast<std::uint8_t>(edges | 2U << (2 * a));
                    if (to + stride[a] == from) edges = static_cast<std::uint8_t>(edges | 1U << (2 * a));
                }
            }
        }
    }
    lattice.moved.resize(lattice.number.size());
    return lattice;
}

// Returns where the neighbours of each corner are: six per corner, -1 where no edge is.
std::vector<std::array<int, 6>> neighbours_of(const Block& block, const Lattice& lattice) {
    std::vector<std::array<int, 6>> out(lattice.number.size());
    const std::array<std::size_t, 3> stride{block.at(1, 0, 0), block.at(0, 1, 0), block.at(0, 0, 1)};
    for (const auto& [corner, i] : lattice.number) {
        for (std::size_t e = 0; e < 6; ++e) {
            const std::size_t other = e % 2 == 0 ? corner - stride[e / 2] : corner + stride[e / 2];
            out[i][e] = (static_cast<unsigned>(lattice.edges[i]) >> e & 1U) != 0
                            ? static_cast<int>(lattice.number.at(other))
                            : -1;
        }
    }
    return out;
}

constexpr int kSmoothPasses = 10;
constexpr double kSmoothIn = 0.5, kSmoothOut = -0.53;  // Taubin's
constexpr double kFurthest = 0.5;                      // voxels

void smooth_step(const std::vector<std::array<int, 6>>& neighbours, double factor, Lattice& lattice) {
    const std::vector<std::array<double, 3>> before = lattice.moved;
    for (std::size_t i = 0; i < before.size(); ++i) {
        if (lattice.held[i] != 0) continue;
        std::array<double, 3> sum{};
        int n = 0;
        for (std::size_t e = 0; e < 6; ++e) {
            if (neighbours[i][e] < 0) continue;
            ++n;
            for (std::size_t c = 0; c < 3; ++c)
                sum[c] += before[static_cast<std::size_t>(neighbours[i][e])][c] - before[i][c];
            sum[e / 2] += e % 2 == 0 ? -1.0 : 1.0;
        }
        double length2 = 0.0;
        for (std::size_t c = 0; c < 3; ++c) {
            lattice.moved[i][c] = before[i][c] + factor * sum[c] / n;
            length2 += lattice.moved[i][c] * lattice.moved[i][c];
        }
        if (length2 <= kFurthest * kFurthest) continue;
        for (double& m : lattice.moved[i]) m *= kFurthest / std::sqrt(length2);
    }
}

Lattice smoothed(const Block& block, const std::vector<Builder::Result>& built) {
    Lattice lattice = lattice_of(block, built);
    const auto neighbours = neighbours_of(block, lattice);
    for (int pass = 0; pass < kSmoothPasses; ++pass) {
        smooth_step(neighbours, kSmoothIn, lattice);
        smooth_step(neighbours, kSmoothOut, lattice);
    }
    return lattice;
}

Point place_m(const Voxels& voxels, const Block& block, std::size_t corner, const std::array<double, 3>& moved) {
    const auto nx = static_cast<std::size_t>(block.n[0]), ny = static_cast<std::size_t>(block.n[1]);
    const std::array<std::size_t, 3> at{corner % nx, corner / nx % ny, corner / nx / ny};
    Point out{};
    for (std::size_t c = 0; c < 3; ++c) {
        const double voxel = static_cast<double>(at[c]) - kBorder + block.low[c] + moved[c];
        out[c] = voxels.frame.origin_m[c] + voxels.frame.pitch_m * voxel;
    }
    return out;
}

}  // namespace

std::vector<Surface> surfaces_of(const Voxels& voxels, bool smooth) {
    const Block block = block_of(voxels);
    std::array<bool, 256> used{};
    for (const std::uint8_t material : block.filled) used[material] = true;
    std::vector<Surface> out;
    std::vector<Builder::Result> built;
    for (int m = 0; m < kMostMaterials; ++m) {
        if (!used[static_cast<std::size_t>(m + 1)]) continue;
        out.push_back({m, {}, {}});
        built.push_back(Builder(block, m).build());
    }
    const Lattice lattice = smooth ? smoothed(block, built) : Lattice{};
    for (std::size_t s = 0; s < out.size(); ++s) {
        out[s].vertices_m.reserve(built[s].corner.size());
        for (const std::size_t corner : built[s].corner) {
            const auto moved = smooth ? lattice.moved[lattice.number.at(corner)] : std::array<double, 3>{};
            out[s].vertices_m.push_back(place_m(voxels, block, corner, moved));
        }
        out[s].triangles = std::move(built[s].triangles);
    }
    return out;
}

double volume_m3(const Surface& surface) {
    if (surface.vertices_m.empty()) return 0.0;
    const Point& o = surface.vertices_m[0];
    double six_m3 = 0.0;
    for (const auto& triangle : surface.triangles) {
        std::array<Point, 3> p{};
        for (std::size_t i = 0; i < 3; ++i) {
            for (std::size_t c = 0; c < 3; ++c)
                p[i][c] = surface.vertices_m[static_cast<std::size_t>(triangle[i])][c] - o[c];
        }
        six_m3 += p[0][0] * (p[1][1] * p[2][2] - p[1][2] * p[2][1]) -
                  p[0][1] * (p[1][0] * p[2][2] - p[1][2] * p[2][0]) + p[0][2] * (p[1][0] * p[2][1] - p[1][1] * p[2][0]);
    }
    return six_m3 / 6.0;
}

}  // namespace palpa::parts
