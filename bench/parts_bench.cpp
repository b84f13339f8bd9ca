// Parts: edits of runs against the same edits of one byte per voxel, their memory, an STL file to voxels, and surfaces to 3MF.
// Median, 99th percentile and worst of single calls, and the ratio of the median to that of the alternative.

#include <algorithm>
#include <benchmark/benchmark.h>
#include <cmath>
#include <random>

#include "accuracy/timing.h"
#include "parts/export/export.h"
#include "parts/info.h"
#include "parts/shape_file.h"
#include "parts/stl_file.h"
#include "tests/parts/solids.h"

namespace {

using namespace palpa;
using namespace palpa::mechanics;
using accuracy::quantile_us;
using accuracy::Timing;

constexpr int kSide = 512;
constexpr double kBall = 10.0;  // radius, voxels: a sphere of 20

void report(benchmark::State& bench, const Timing& timing, double against_us) {
    bench.counters["p50_ms"] = 1e-3 * quantile_us(timing, 0.5);
    bench.counters["p99_ms"] = 1e-3 * quantile_us(timing, 0.99);
    bench.counters["worst_ms"] = 1e-3 * quantile_us(timing, 1.0);
    bench.counters["ratio"] = quantile_us(timing, 0.5) / against_us;
}

Voxels full_cube() {
    Voxels voxels = empty_voxels({kSide, kSide, kSide}, {1.0, {}});
    EditHistory history;
    apply({EditKind::add, {EverywhereRegion{}}, 0, {}}, voxels, history);
    return voxels;
}

Point random_centre(std::mt19937& random) {
    std::uniform_real_distribution<double> place(kBall, kSide - kBall);
    return {place(random), place(random), place(random)};
}

// The same edit of an array of bytes; what it replaced is kept for the undo.
double bytes_edit_us(int edits) {
    std::vector<std::uint8_t> bytes(std::size_t{kSide} * kSide * kSide, 1);
    std::vector<std::vector<std::uint8_t>> undo;
    std::mt19937 random(1);
    const Timing timing = accuracy::time_calls(edits, edits, 1e9, [&](int i) {
        const Point c = random_centre(random);
        std::vector<std::uint8_t> kept;
        for (int z = static_cast<int>(c[2] - kBall); z <= static_cast<int>(c[2] + kBall); ++z) {
            for (int y = static_cast<int>(c[1] - kBall); y <= static_cast<int>(c[1] + kBall); ++y) {
                for (int x = static_cast<int>(c[0] - kBall); x <= static_cast<int>(c[0] + kBall); ++x) {
                    const bool out = x < 0 || y < 0 || z < 0 || x >= kSide || y >= kSide || z >= kSide;
                    if (out) continue;
                    std::uint8_t& voxel =
                        bytes[static_cast<std::size_t>(x) +
                              std::size_t{kSide} *
                                  (static_cast<std::size_t>(y) + std::size_t{kSide} * static_cast<std::size_t>(z))];
                    kept.push_back(voxel);
                    const double dx = x + 0.5 - c[0], dy = y + 0.5 - c[1], dz = z + 0.5 - c[2];
                    if (dx * dx + dy * dy + dz * dz <= kBall * kBall) voxel = static_cast<std::uint8_t>(i % 3);
                }
            }
        }
        undo.push_back(std::move(kept));
    });
    return quantile_us(timing, 0.5);
}

void edit_of_a_sphere(benchmark::State& bench) {
    constexpr int kEdits = 2000;
    for (auto _ : bench) {
        Voxels voxels = full_cube();
        EditHistory history;
        std::mt19937 random(1);
        const Timing timing = accuracy::time_calls(kEdits, kEdits, 1e9, [&](int i) {
            const auto kind = i % 3 == 0 ? EditKind::remove : EditKind::permute;
            apply({kind, {BallRegion{random_centre(random), kBall}}, i % 3, {}}, voxels, history);
        });
        report(bench, timing, bytes_edit_us(200));
    }
}

// What an edit by hand costs besides: whether one body is left.
void count_of_bodies(benchmark::State& bench) {
    const Voxels voxels = full_cube();
    for (auto _ : bench) {
        const Timing timing =
            accuracy::time_calls(20, 20, 1e9, [&](int) { benchmark::DoNotOptimize(count_bodies(voxels)); });
        report(bench, timing, bytes_edit_us(200));
    }
}

void memory_of_the_toothbrush(benchmark::State& bench) {
    for (auto _ : bench) {
        parts::Part part = parts::read_part(PALPA_SOURCE_DIR "/assets/parts/toothbrush-a.json");
        const parts::PartInfo info = parts::info_of(part);
        bench.counters["share_of_bytes"] =
            static_cast<double>(info.memory_bytes) / static_cast<double>(info.plain_bytes);
        std::mt19937 random(1);
        std::uniform_real_distribution<double> share(0.0, 1.0);
        const double h = part.voxels.frame.pitch_m;
        for (int i = 0; i < 2000; ++i) {
            Point centre{};
            for (std::size_t c = 0; c < 3; ++c) centre[c] = h * part.voxels.size[c] * share(random);
            apply({EditKind::permute, {BallRegion{centre, kBall * h}}, i % 2, {}}, part.voxels, part.history);
        }
        const parts::PartInfo later = parts::info_of(part);
        bench.counters["after_2000_spheres"] =
            static_cast<double>(later.memory_bytes) / static_cast<double>(later.plain_bytes);
    }
}

// 224^2 quads of two triangles, less those at the poles.
void stl_to_voxels(benchmark::State& bench) {
    const std::string bytes = test::binary_stl(test::ball_triangles({128.0, 128.0, 128.0}, 127.0, 224));
    for (auto _ : bench) {
        Timing parsed, all;
        for (int i = 0; i < 5; ++i) {
            accuracy::time_call(parsed, [&] { benchmark::DoNotOptimize(parts::parse_stl(bytes, "ball.stl", 1e-3)); });
            accuracy::time_call(all, [&] {
                auto solid = std::make_shared<TriangleSolid>(
                    parts::solid_of(parts::parse_stl(bytes, "ball.stl", 1e-3), "ball.stl"));
                bench.counters["triangles"] = static_cast<double>(solid->triangles.size());
                Voxels voxels = empty_voxels({256, 256, 256}, {1e-3, {}});
                EditHistory history;
                benchmark::DoNotOptimize(apply({EditKind::add, {SolidRegion{solid}}, 0, {}}, voxels, history));
            });
        }
        report(bench, all, quantile_us(parsed, 0.5));
    }
}

// A ball of as many voxel faces as make 600,000 triangles.
void three_mf(benchmark::State& bench) {
    Voxels voxels = empty_voxels({180, 180, 180}, {1e-4, {}});
    EditHistory history;
    apply({EditKind::add, {BallRegion{{9e-3, 9e-3, 9e-3}, 8.4e-3}}, 0, {}}, voxels, history);
    apply({EditKind::permute, {BandsRegion{0, 0.0, 6e-3, 2e-3}}, 1, {}}, voxels, history);
    parts::Part part;
    part.name = "ball";
    part.voxels = voxels;
    part.materials = {{"hard", {}, 1000.0, "#4477aa"}, {"soft", {}, 1000.0, "#ee6677"}};
    for (auto _ : bench) {
        Timing stl, all;
        for (int i = 0; i < 5; ++i) {
            accuracy::time_call(all, [&] {
                const auto surfaces = parts::surfaces_of(part.voxels);
                std::size_t triangles = 0;
                for (const parts::Surface& surface : surfaces) triangles += surface.triangles.size();
                bench.counters["triangles"] = static_cast<double>(triangles);
                benchmark::DoNotOptimize(parts::three_mf_bytes(part, surfaces));
            });
            accuracy::time_call(stl, [&] {
                for (const parts::Surface& surface : parts::surfaces_of(part.voxels))
                    benchmark::DoNotOptimize(parts::stl_bytes(surface, "ball"));
            });
        }
        report(bench, all, quantile_us(stl, 0.5));
    }
}

BENCHMARK(edit_of_a_sphere)->Iterations(1);
BENCHMARK(count_of_bodies)->Iterations(1);
BENCHMARK(memory_of_the_toothbrush)->Iterations(1);
BENCHMARK(stl_to_voxels)->Iterations(1);
BENCHMARK(three_mf)->Iterations(1);

}  // namespace

BENCHMARK_MAIN();
