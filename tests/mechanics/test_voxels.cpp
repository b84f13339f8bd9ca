#include <cmath>
#include <doctest/doctest.h>
#include <random>

#include "mechanics/error.h"
#include "mechanics/voxels.h"
#include "tests/close_to.h"

using namespace palpa::mechanics;
using namespace palpa::test;

namespace {

Voxels filled(int nx, int ny, int nz, double pitch_m = 1.0) {
    Voxels voxels = empty_voxels({nx, ny, nz}, {pitch_m, {}});
    EditHistory history;
    apply({EditKind::add, {EverywhereRegion{}}, 0, {}}, voxels, history);
    return voxels;
}

// Sorted, disjoint, inside, and merged.
bool is_sound(const Voxels& voxels) {
    for (const std::vector<Run>& line : voxels.lines) {
        for (std::size_t r = 0; r < line.size(); ++r) {
            if (line[r].x0 >= line[r].x1 || line[r].x0 < 0 || line[r].x1 > voxels.size[0]) return false;
            if (r == 0) continue;
            if (line[r].x0 < line[r - 1].x1) return false;
            if (line[r].x0 == line[r - 1].x1 && line[r].material == line[r - 1].material) return false;
        }
    }
    return true;
}

Region random_region(std::mt19937& random) {
    std::uniform_real_distribution<double> place(-2.0, 22.0), size(0.5, 6.0);
    const Point p{place(random), place(random), place(random)}, q{place(random), place(random), place(random)};
    switch (random() % 6) {
        case 0:
            return {BoxRegion{p, {p[0] + size(random), p[1] + size(random), p[2] + size(random)}}};
        case 1:
            return {BallRegion{p, size(random)}};
        case 2:
            return {CylinderRegion{p, q, size(random)}};
        case 3:
            return {PathRegion{{p, q, {place(random), place(random), place(random)}}, size(random), random() % 2 == 0}};
        case 4:
            return {BandsRegion{static_cast<int>(random() % 3), place(random), 5.0, 2.0}};
        default:
            return {BooleanRegion{static_cast<Boolean>(random() % 3), {{BallRegion{p, 6.0}}, {BallRegion{q, 6.0}}}}};
    }
}

}  // namespace

TEST_CASE("voxels: random edits keep runs sound and agree with a plain array; undo and redo bring every state back") {
    constexpr unsigned kSeed = 20;
    CAPTURE(kSeed);
    std::mt19937 random(kSeed);
    Voxels voxels = empty_voxels({20, 17, 13}, {1.0, {}});
    EditHistory history;
    std::vector<std::vector<std::vector<Run>>> states{voxels.lines};
    std::vector<int> plain(20 * 17 * 13, -1);
    for (int i = 0; i < 200; ++i) {
        CAPTURE(i);
        VoxelEdit edit{static_cast<EditKind>(random() % 3), random_region(random), static_cast<int>(random() % 3), {}};
        if (random() % 2 == 0) edit.from = static_cast<int>(random() % 3);
        std::int64_t changed = 0;
        for (int v = 0; v < 20 * 17 * 13; ++v) {
            int& material = plain[static_cast<std::size_t>(v)];
            const Point centre{v % 20 + 0.5, v / 20 % 17 + 0.5, v / 340 + 0.5};
            if (!contains(edit.region, centre)) continue;
            const bool taken = material >= 0 && (!edit.from || *edit.from == material);
            const int after = edit.kind == EditKind::add      ? edit.material
                              : edit.kind == EditKind::remove ? -1
                              : taken                         ? edit.material
                                                              : material;
            changed += after != material ? 1 : 0;
            material = after;
        }
        CHECK(apply(edit, voxels, history) == changed);
        REQUIRE(is_sound(voxels));
        int wrong = 0;
        for (int v = 0; v < 20 * 17 * 13; ++v)
            wrong += material_at(voxels, v % 20, v / 20 % 17, v / 340) != plain[static_cast<std::size_t>(v)] ? 1 : 0;
        REQUIRE(wrong == 0);
        states.push_back(voxels.lines);
    }
    for (std::size_t i = states.size() - 1; i-- > 0;) {
        REQUIRE(undo(voxels, history));
        REQUIRE(voxels.lines == states[i]);
    }
    CHECK_FALSE(undo(voxels, history));
    for (std::size_t i = 1; i < states.size(); ++i) {
        REQUIRE(redo(voxels, history));
        REQUIRE(voxels.lines == states[i]);
    }
    CHECK_FALSE(redo(voxels, history));
}

TEST_CASE("voxels: permute and its inverse are the identity, keep the volume, and an empty region costs nothing") {
    Voxels voxels = filled(30, 10, 10);
    const auto before = voxels.lines;
    EditHistory history;
    const Region ball{BallRegion{{15, 5, 5}, 4.0}};
    const std::int64_t swapped = apply({EditKind::permute, ball, 1, 0}, voxels, history);
    CHECK(swapped > 200);
    const VoxelCounts counts = count(voxels, 2);
    CHECK(counts.voxels == 3000);
    CHECK(counts.of_material == std::vector<std::int64_t>{3000 - swapped, swapped});
    CHECK(counts.centre_m[1][0] == close_to(15.0));
    CHECK(apply({EditKind::permute, ball, 0, 1}, voxels, history) == swapped);
    CHECK(voxels.lines == before);
    CHECK(apply({EditKind::permute, {BallRegion{{-50, 0, 0}, 4.0}}, 1, {}}, voxels, history) == 0);
    CHECK(history.done.back().empty());
}

TEST_CASE("voxels: volumes of a ball, a cylinder aslant and a path come to the closed forms") {
    Voxels voxels = empty_voxels({100, 100, 100}, {0.01, {}});
    EditHistory history;
    const double pi = 3.14159265358979;
    const auto share_of = [&](const Region& region) {
        const auto n = static_cast<double>(apply({EditKind::add, region, 0, {}}, voxels, history)) * 1e-6;
        undo(voxels, history);
        return n;
    };
    CHECK(share_of({BallRegion{{0.5, 0.5, 0.5}, 0.4}}) == close_to(4.0 / 3.0 * pi * 0.064).epsilon(2e-3));
    CHECK(share_of({CylinderRegion{{0.3, 0.3, 0.2}, {0.7, 0.6, 0.8}, 0.2}}) ==
          close_to(pi * 0.04 * std::sqrt(0.16 + 0.09 + 0.36)).epsilon(2e-3));
    const std::vector<Point> straight{{0.3, 0.5, 0.5}, {0.7, 0.5, 0.5}};
    CHECK(share_of({PathRegion{straight, 0.2, false}}) ==
          close_to(pi * 0.04 * 0.4 + 4.0 / 3.0 * pi * 0.008).epsilon(5e-3));
    // along an axis every slice is the same: 1264 centres lie in a circle of 20 voxels, whose area is 1256.6
    CHECK(share_of({PathRegion{straight, 0.2, true}}) == close_to(1e-6 * 1264 * 40));
    CHECK(share_of({BandsRegion{2, 0.0, 0.2, 0.05}}) == close_to(0.25).epsilon(1e-12));
}

TEST_CASE("voxels: boxes whose sides are voxel faces in decimal fractions fill exactly those voxels") {
    Voxels voxels = empty_voxels({1000, 3, 3}, {1e-4, {}});
    EditHistory history;
    for (int i = 0; i < 100; ++i) {
        const Region box{BoxRegion{{1e-3 * i, 0.0, 0.1e-3}, {1e-3 * i + 0.3e-3, 0.2e-3, 0.3e-3}}};
        CAPTURE(i);
        CHECK(apply({EditKind::add, box, 0, {}}, voxels, history) == 3 * 2 * 2);
    }
}

TEST_CASE("voxels: bodies are joined by faces, not by edges") {
    Voxels voxels = empty_voxels({4, 3, 3}, {1.0, {}});
    set_line(0, 0, {{0, 2, 0}}, voxels);
    CHECK(count_bodies(voxels) == 1);
    set_line(1, 1, {{0, 2, 0}}, voxels);  // touches along an edge
    CHECK(count_bodies(voxels) == 2);
    set_line(1, 0, {{1, 3, 1}}, voxels);
    CHECK(count_bodies(voxels) == 1);
    set_line(2, 2, {{0, 1, 0}, {3, 4, 0}}, voxels);
    CHECK(count_bodies(voxels) == 3);
}

TEST_CASE("voxels: lines that overlap and sizes out of range are refused") {
    Voxels voxels = empty_voxels({10, 2, 2}, {1.0, {}});
    CHECK_THROWS_WITH_AS(set_line(1, 0, {{0, 3, 0}, {2, 5, 0}}, voxels), doctest::Contains("y 1, z 0"), MeshError);
    CHECK_THROWS_AS(set_line(0, 0, {{3, 3, 0}}, voxels), MeshError);
    CHECK_THROWS_AS(set_line(0, 0, {{0, 11, 0}}, voxels), MeshError);
    CHECK_THROWS_AS(set_line(0, 2, {{0, 1, 0}}, voxels), MeshError);
    CHECK_THROWS_AS(empty_voxels({0, 1, 1}, {1.0, {}}), MeshError);
    CHECK_THROWS_AS(empty_voxels({1, 30000, 30000}, {1.0, {}}), MeshError);
    CHECK_THROWS_AS(empty_voxels({1, 1, 1}, {0.0, {}}), MeshError);
}

TEST_CASE("hard case: bands finer than a voxel are looked up voxel by voxel, the same along every axis") {
    for (const double period : {1.9, 0.7, 1e-4}) {
        CAPTURE(period);
        std::array<std::vector<int>, 3> in;
        for (int axis = 0; axis < 3; ++axis) {
            Voxels voxels = empty_voxels({30, 30, 30}, {1.0, {}});
            EditHistory history;
            apply({EditKind::add, {BandsRegion{axis, 0.3, period, 0.4 * period}}, 0, {}}, voxels, history);
            for (int i = 0; i < 30; ++i)
                in[static_cast<std::size_t>(axis)].push_back(
                    material_at(voxels, axis == 0 ? i : 7, axis == 1 ? i : 7, axis == 2 ? i : 7));
        }
        CHECK(in[0] == in[1]);
        CHECK(in[1] == in[2]);
    }
}
