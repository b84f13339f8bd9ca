#include <array>
#include <cmath>
#include <doctest/doctest.h>
#include <map>
#include <random>
#include <set>
#include <utility>

#include "mechanics/error.h"
#include "parts/surface.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

Voxels random_voxels(std::mt19937& random, unsigned materials) {
    Voxels voxels = empty_voxels({9, 8, 7}, {1e-4, {1.0, 2.0, 3.0}});
    for (int z = 0; z < 7; ++z) {
        for (int y = 0; y < 8; ++y) {
            std::vector<Run> runs;
            for (int x = 0; x < 9; ++x) {
                if (const auto m = static_cast<int>(random() % (materials + 1)); m > 0)
                    runs.push_back({x, x + 1, m - 1});
            }
            set_line(y, z, runs, voxels);
        }
    }
    return voxels;
}

// Edges that are not used once each way.
int open_edges(const Surface& surface) {
    std::map<std::pair<int, int>, int> uses;
    for (const auto& t : surface.triangles) {
        for (std::size_t i = 0; i < 3; ++i) ++uses[{t[i], t[(i + 1) % 3]}];
    }
    int open = 0;
    for (const auto& [edge, n] : uses) {
        const auto back = uses.find({edge.second, edge.first});
        open += n == 1 && back != uses.end() && back->second == 1 ? 0 : 1;
    }
    return open;
}

Voxels voxels_of(const std::vector<std::array<int, 3>>& places) {
    Voxels voxels = empty_voxels({4, 4, 4}, {1.0, {}});
    EditHistory history;
    for (const auto& p : places) {
        const Point low{p[0] + 0.1, p[1] + 0.1, p[2] + 0.1}, high{p[0] + 0.9, p[1] + 0.9, p[2] + 0.9};
        apply({EditKind::add, {BoxRegion{low, high}}, 0, {}}, voxels, history);
    }
    return voxels;
}

using Spot = std::array<long, 3>;
Spot spot_of(const Point& p) { return {std::lround(p[0] * 1e9), std::lround(p[1] * 1e9), std::lround(p[2] * 1e9)}; }

}  // namespace

TEST_CASE("surface: of random voxels, every edge is used once each way, and volumes are the voxels'") {
    constexpr unsigned kSeed = 3;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    for (int round = 0; round < 30; ++round) {
        CAPTURE(round);
        const Voxels voxels = random_voxels(random, static_cast<unsigned>(1 + round % 3));
        const VoxelCounts counts = count(voxels, 1);
        for (const bool smooth : {false, true}) {
            for (const Surface& surface : surfaces_of(voxels, smooth)) {
                CHECK(open_edges(surface) == 0);
                const auto m = static_cast<std::size_t>(surface.material);
                if (!smooth)
                    CHECK(volume_m3(surface) ==
                          close_to(static_cast<double>(counts.of_material[m]) * 1e-12).epsilon(1e-9));
            }
        }
    }
}

TEST_CASE("surface: one voxel has 8 vertices and 12 triangles; two have none between them") {
    const Surface one = surfaces_of(voxels_of({{1, 1, 1}})).at(0);
    CHECK(one.vertices_m.size() == 8);
    CHECK(one.triangles.size() == 12);
    CHECK(volume_m3(one) == close_to(1.0).epsilon(1e-12));
    CHECK(surfaces_of(voxels_of({{1, 1, 1}, {2, 1, 1}})).at(0).triangles.size() == 20);
}

TEST_CASE("hard case: a material that touches itself along an edge or at a corner has a vertex for each side") {
    CHECK(surfaces_of(voxels_of({{0, 0, 0}, {1, 1, 0}})).at(0).vertices_m.size() == 16);
    CHECK(surfaces_of(voxels_of({{0, 0, 0}, {1, 1, 1}})).at(0).vertices_m.size() == 16);
    // around the edge, joined at one of its ends, and at both
    const std::vector<std::array<int, 3>> hook{{0, 0, 1}, {1, 1, 1}, {0, 0, 2}, {1, 0, 2}, {1, 1, 2}};
    CHECK(open_edges(surfaces_of(voxels_of(hook)).at(0)) == 0);
    std::vector<std::array<int, 3>> ring = hook;
    for (const auto& p : {std::array{0, 0, 0}, std::array{0, 1, 0}, std::array{1, 1, 0}}) ring.push_back(p);
    const Surface both = surfaces_of(voxels_of(ring)).at(0);
    CHECK(open_edges(both) == 0);
    CHECK(volume_m3(both) == close_to(8.0).epsilon(1e-12));
}

TEST_CASE(
    "surface: materials that touch share corners and diagonals, smooth or not, and none moves beyond half a voxel") {
    constexpr unsigned kSeed = 8;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    Voxels voxels = random_voxels(random, 2);
    EditHistory history;
    apply({EditKind::add, {BallRegion{{1.00045, 2.0004, 3.00035}, 4e-4}}, 0, {}}, voxels, history);
    apply({EditKind::permute, {BandsRegion{0, 1.0, 4e-4, 2e-4}}, 1, {}}, voxels, history);
    const auto plain = surfaces_of(voxels), smooth = surfaces_of(voxels, true);
    REQUIRE(plain.size() == 2);
    double furthest_m = 0.0;
    std::map<Spot, std::set<Spot>> moved_to;
    for (std::size_t s = 0; s < 2; ++s) {
        CHECK(plain[s].triangles == smooth[s].triangles);
        for (std::size_t v = 0; v < plain[s].vertices_m.size(); ++v) {
            const Point &a = plain[s].vertices_m[v], &b = smooth[s].vertices_m[v];
            moved_to[spot_of(a)].insert(spot_of(b));
            furthest_m = std::max(furthest_m, std::hypot(a[0] - b[0], a[1] - b[1], a[2] - b[2]));
        }
    }
    CHECK(furthest_m > 1e-5);
    CHECK(furthest_m < 0.5e-4 * (1.0 + 1e-9));
    for (const auto& [from, to] : moved_to) CHECK(to.size() == 1);
    // interface: triangles of one are, turned, triangles of the other
    std::set<std::set<Spot>> of_first;
    for (const auto& t : smooth[0].triangles) {
        std::set<Spot> corners;
        for (const int v : t) corners.insert(spot_of(smooth[0].vertices_m[static_cast<std::size_t>(v)]));
        of_first.insert(corners);
    }
    int shared = 0;
    for (const auto& t : smooth[1].triangles) {
        std::set<Spot> corners;
        for (const int v : t) corners.insert(spot_of(smooth[1].vertices_m[static_cast<std::size_t>(v)]));
        shared += of_first.count(corners) > 0 ? 1 : 0;
    }
    int faces = 0;
    for (int z = 0; z < 7; ++z) {
        for (int y = 0; y < 8; ++y) {
            for (int x = 0; x < 9; ++x) {
                for (const Spot& next : {Spot{1, 0, 0}, Spot{0, 1, 0}, Spot{0, 0, 1}}) {
                    const int a = material_at(voxels, x, y, z);
                    const int b = material_at(voxels, x + static_cast<int>(next[0]), y + static_cast<int>(next[1]),
                                              z + static_cast<int>(next[2]));
                    faces += a >= 0 && b >= 0 && a != b ? 1 : 0;
                }
            }
        }
    }
    CHECK(faces > 20);
    CHECK(shared == 2 * faces);
}

TEST_CASE("surface: smoothing keeps a ball's volume within 2 %, and takes away most of its steps") {
    Voxels voxels = empty_voxels({40, 40, 40}, {1.0, {}});
    EditHistory history;
    apply({EditKind::add, {BallRegion{{20, 20, 20}, 15.0}}, 0, {}}, voxels, history);
    const Surface plain = surfaces_of(voxels).at(0), smooth = surfaces_of(voxels, true).at(0);
    CHECK(volume_m3(smooth) == close_to(volume_m3(plain)).epsilon(0.02));
    const auto roughness = [](const Surface& s) {
        double sum = 0.0;
        for (const Point& p : s.vertices_m) {
            const double off = std::hypot(p[0] - 20, p[1] - 20, p[2] - 20) - 15.0;
            sum += off * off;
        }
        return std::sqrt(sum / static_cast<double>(s.vertices_m.size()));
    };
    CHECK(roughness(smooth) < 0.5 * roughness(plain));
}

TEST_CASE("bad input: a surface of too many materials") {
    Voxels voxels = empty_voxels({4, 1, 1}, {});
    set_line(0, 0, {{0, 1, 300}}, voxels);
    CHECK_THROWS_AS(surfaces_of(voxels), MeshError);
    CHECK(surfaces_of(empty_voxels({4, 4, 4}, {})).empty());
}
