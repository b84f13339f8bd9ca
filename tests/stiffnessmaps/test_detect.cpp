#include <algorithm>
#include <doctest/doctest.h>
#include <filesystem>
#include <random>

#include "stiffnessmaps/grid.h"
#include "stiffnessmaps/import/detect.h"
#include "stiffnessmaps/import/import.h"
#include "stiffnessmaps/map_file.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/stiffnessmaps/test_maps.h"

using namespace palpa;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

struct Bump {
    double x_m, y_m, half_length_m, sigma_m, contrast;  // a capsule along x with a Gaussian flank
};

// 400 N/m, `share` of it noise that is alike over `alike_m`, and bumps.
Map noisy(std::size_t n_x, std::size_t n_y, double pitch_m, double share, double alike_m, unsigned seed,
          const std::vector<Bump>& bumps = {}, double tilt = 0.0) {
    std::mt19937 random(seed);
    std::normal_distribution<double> normal;
    std::vector<double> noise(n_x * n_y);
    for (double& v : noise) v = normal(random);
    if (alike_m > 0.0) noise = smooth(noise, {n_x, n_y, pitch_m, pitch_m}, alike_m);
    double square = 0.0;
    for (const double v : noise) square += v * v;
    const double scale = share / std::sqrt(square / static_cast<double>(noise.size()));
    Map map;
    map.name = "noisy";
    map.n_x = n_x;
    map.n_y = n_y;
    map.spacing_m[0] = map.spacing_m[1] = pitch_m;
    map.depths_m = {1e-3, 2e-3, 3e-3};
    map.indenter_radius_m = 3e-3;
    for (const double depth_m : map.depths_m) {
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            const double x = map.x_of(cell % n_x);
            const double y = map.y_of(cell / n_x);
            double k = 1.0 + scale * noise[cell] + tilt * x / map.x_of(n_x - 1);
            for (const Bump& b : bumps) {
                const double along = std::max(0.0, std::abs(x - b.x_m) - b.half_length_m);
                k += (b.contrast - 1.0) *
                     std::exp(-0.5 * (along * along + (y - b.y_m) * (y - b.y_m)) / (b.sigma_m * b.sigma_m));
            }
            map.normal_N.push_back(static_cast<float>(400.0 * depth_m * k));
        }
    }
    return map;
}

Map recording(const char* name, const char* kind = "probing") {
    const auto file = std::filesystem::path(PALPA_RECORDINGS) / kind / name;
    ImportReport report;
    return import_recording({file}, {}, report);
}

bool recordings_are_there() {
    const bool there = std::filesystem::exists(std::filesystem::path(PALPA_RECORDINGS) / "probing");
    if (!there) MESSAGE("not checked: the recordings are not beside the checkout: ", PALPA_RECORDINGS);
    return there;
}

}  // namespace

TEST_CASE("detect: noise alone makes no claim that is not warned about") {
    struct Kind {
        std::size_t n_x, n_y;
        double pitch_m, share, alike_m;
    };
    const Kind kinds[] = {{62, 39, 1.58e-3, 0.15, 0.0},  {62, 39, 1.58e-3, 0.15, 1.5e-3}, {62, 39, 1.58e-3, 0.15, 3e-3},
                          {62, 39, 1.58e-3, 0.15, 6e-3}, {19, 14, 3.16e-3, 0.3, 4e-3},    {13, 12, 5.5e-3, 0.3, 0.0},
                          {13, 12, 5.5e-3, 0.3, 7e-3},   {7, 19, 1.58e-3, 0.1, 0.0},      {7, 19, 1.58e-3, 0.1, 2e-3}};
    int found = 0;
    int sure = 0;
    int maps = 0;
    double nearest = 0.0;
    for (const Kind& kind : kinds) {
        for (unsigned seed = 1; seed <= 12; ++seed) {
            CAPTURE(kind.alike_m);
            CAPTURE(kind.n_x);
            CAPTURE(seed);
            const Detection d =
                detect_regions(noisy(kind.n_x, kind.n_y, kind.pitch_m, kind.share, kind.alike_m, seed), "noise", {});
            CHECK(d.sure() == 0);
            ++maps;
            found += !d.regions.empty();
            sure += d.sure() > 0;
            for (const StiffRegion& r : d.regions) {
                CHECK((r.sure || !r.warnings.empty()));
                nearest = std::max(nearest, r.contrast_to_noise / r.needed);
            }
        }
    }
    MESSAGE(maps, " maps of noise: regions in ", found, ", sure in ", sure, "; nearest to sure ", nearest);
    CHECK(found > 15);  // else nothing was put to the test
}

TEST_CASE("detect: planted nodules are found to within a cell of 1.58 mm, with their size and contrast") {
    const std::vector<Bump> bumps{
        {20e-3, 15e-3, 0.0, 4e-3, 1.8}, {70e-3, 40e-3, 0.0, 3e-3, 2.0}, {60e-3, 12e-3, 12e-3, 3e-3, 1.6}};
    for (unsigned seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        const Detection d =
            detect_regions(noisy(62, 39, 1.58e-3, 0.05, seed % 2 == 0 ? 0.0 : 2e-3, seed, bumps, 0.2), "planted", {});
        REQUIRE(d.sure() == 3);
        for (const Bump& b : bumps) {
            const auto away_m = [&](const StiffRegion& r) { return std::hypot(r.x_m - b.x_m, r.y_m - b.y_m); };
            const StiffRegion& r =
                *std::min_element(d.regions.begin(), d.regions.end(),
                                  [&](const auto& a, const auto& c) { return away_m(a) < away_m(c); });
            CAPTURE(b.x_m);
            CHECK(r.sure);
            CHECK(away_m(r) < 1.58e-3);
            if (b.half_length_m > 0.0) {  // the flank falls to half at 1.18 sigma; smoothing widens it
                CHECK(r.length_m == close_to(2.0 * b.half_length_m + 2.36 * b.sigma_m).epsilon(0.2));
                CHECK(std::abs(r.angle_deg) < 8.0);
                CHECK(r.length_m > 2.0 * r.width_m);
            } else {
                CHECK(r.length_m < 1.6 * r.width_m);
            }
        }
    }
}

TEST_CASE("detect: a tilt, a free edge, or one level make no region") {
    const auto tilted = [](double x, double, double d) { return d * (300.0 + 8000.0 * x); };
    CHECK(detect_regions(map_of(40, 30, kPaperDepths_m, tilted), "tilt", {}).regions.empty());
    CHECK(
        detect_regions(map_of(40, 30, kPaperDepths_m, [](double, double, double d) { return 400.0 * d; }), "level", {})
            .regions.empty());
    const auto edge = [](double x, double y, double d) {
        const double from_edge = std::min({x, y, 0.039 - x, 0.029 - y});
        return 400.0 * d * (1.0 - 0.7 * std::exp(-from_edge / 4e-3));
    };
    CHECK(detect_regions(map_of(40, 30, kPaperDepths_m, edge), "edge", {}).sure() == 0);
}

TEST_CASE("detect: the shipped phantom's three nodules, and nothing else") {
    Map map = read_map(PALPA_SOURCE_DIR "/assets/maps/silicone.map");
    const Detection d = detect_regions(map, "silicone.map", {});
    CHECK(d.regions.size() == 3);
    CHECK(d.sure() == 3);
    for (const Nodule& nodule : map.nodules) {
        double away_m = 1.0;
        for (const StiffRegion& r : d.regions)
            away_m = std::min(away_m, std::hypot(r.x_m - nodule.x_m, r.y_m - nodule.y_m));
        CAPTURE(nodule.id);
        CHECK(away_m < 0.5e-3);
    }
    keep_regions(d, map);
    keep_regions(d, map);  // again: in place of the first
    CHECK(map.nodules.size() == 6);
    CHECK(map.nodules[0].placed);
    CHECK_FALSE(map.nodules[3].placed);
}

TEST_CASE("detect: the recorded zig-zag inclusion is one long region") {
    if (!recordings_are_there()) return;
    const Detection d = detect_regions(recording("probingRAL2018B_T2.csv"), "zig-zag", {});
    REQUIRE(d.regions.size() == 1);
    const StiffRegion& r = d.regions[0];
    CHECK(r.sure);
    CHECK(r.length_m > 55e-3);
    CHECK(r.length_m < 70e-3);
    CHECK(r.width_m < 0.25 * r.length_m);
    CHECK(r.contrast >= 1.5);
    CHECK_FALSE(r.at_edge);
}

TEST_CASE("detect: of the recorded small balls the clear one and the one that the map's edge cuts") {
    if (!recordings_are_there()) return;
    const Detection d = detect_regions(recording("region_small_balls.csv"), "balls", {});
    REQUIRE(d.regions.size() == 2);
    CHECK(d.sure() == 2);
    CHECK(d.regions[0].x_m == close_to(-32e-3).epsilon(0.03));
    CHECK(d.regions[0].y_m == close_to(65.5e-3).epsilon(0.02));
    CHECK(d.regions[0].contrast > 1.5);
    CHECK(d.regions[0].look == 1);
    CHECK(d.regions[1].x_m == close_to(-29.4e-3).epsilon(0.03));
    CHECK(d.regions[1].y_m == close_to(53.2e-3).epsilon(0.02));
    CHECK(d.regions[1].contrast > 1.2);
    CHECK(d.regions[1].contrast < 1.4);
    CHECK(d.regions[1].at_edge);
    CHECK(d.regions[1].look == 2);  // the clear one takes a quarter of this map and hides it
}

TEST_CASE("detect: the rims of sliding rasters make no claim that is not warned about") {
    if (!recordings_are_there()) return;
    for (const char* name : {"ContPalpTrial1.csv", "ContPalpTrial3.csv"}) {
        CAPTURE(name);
        const Detection d = detect_regions(recording(name, "sliding"), name, {});
        CHECK(d.sure() == 0);
        for (const StiffRegion& r : d.regions) CHECK_FALSE(r.warnings.empty());
    }
}

TEST_CASE("detect: a region at the edge is held against the edge's own variation") {
    const auto with_rim = [](double rim, unsigned seed) {
        Map map = noisy(40, 30, 1.58e-3, 0.05, 1.5e-3, seed, {{0.0, 22e-3, 0.0, 3e-3, 1.9}});
        std::mt19937 random(seed);
        std::normal_distribution<double> normal;
        std::vector<double> along(2 * (map.n_x + map.n_y));  // alike over some cells along the rim
        for (double& v : along) v = normal(random);
        along = smooth(along, {along.size(), 1, 1.0, 1.0}, 1.5);
        for (std::size_t cell = 0; cell < map.n_cells(); ++cell) {
            const std::size_t i = cell % map.n_x;
            const std::size_t j = cell / map.n_x;
            if (i > 0 && j > 0 && i + 1 < map.n_x && j + 1 < map.n_y) continue;
            const std::size_t at =
                j == 0 || j + 1 == map.n_y ? (j == 0 ? i : map.n_x + i) : 2 * map.n_x + (i == 0 ? j : map.n_y + j);
            for (std::size_t k = 0; k < map.n_depths(); ++k) {
                map.normal_N[k * map.n_cells() + cell] *= static_cast<float>(std::max(0.1, 1.0 + rim * along[at]));
            }
        }
        return map;
    };
    int sure_on_even_rim = 0;
    int against_edge = 0;
    for (unsigned seed = 1; seed <= 10; ++seed) {
        CAPTURE(seed);
        for (const double rim : {0.0, 1.5}) {
            const Detection d = detect_regions(with_rim(rim, seed), "rim", {});
            for (const StiffRegion& r : d.regions) {
                const bool at_bump = std::hypot(r.x_m, r.y_m - 22e-3) < 4e-3;
                if (rim == 0.0) sure_on_even_rim += r.sure && at_bump;
                if (rim > 0.0 && r.at_edge && !at_bump) CHECK_FALSE(r.sure);
                against_edge += rim > 0.0 && r.at_edge && r.against_edge;
            }
        }
    }
    CHECK(against_edge > 20);  // else nothing was put to the test
    CHECK(sure_on_even_rim == 10);
}

TEST_CASE("detect: what a clear nodule hides is found by looking again, and nothing is made up") {
    const std::vector<Bump> bumps{{14e-3, 18e-3, 0.0, 4e-3, 2.2}, {30e-3, 14e-3, 0.0, 2.5e-3, 1.25}};
    int again = 0;
    for (unsigned seed = 1; seed <= 20; ++seed) {
        CAPTURE(seed);
        const Detection d = detect_regions(noisy(26, 24, 1.58e-3, 0.08, 0.0, seed, bumps), "two", {});
        int clear = 0;
        for (const StiffRegion& r : d.regions) {
            if (!r.sure) continue;
            const auto at = [&](const Bump& b) { return std::hypot(r.x_m - b.x_m, r.y_m - b.y_m) < 3e-3; };
            CHECK((at(bumps[0]) || at(bumps[1])));
            clear += at(bumps[0]) && r.look == 1;
            again += at(bumps[1]) && r.look == 2;
        }
        CHECK(clear == 1);
    }
    MESSAGE("of 20 hidden ones ", again, " found by looking again");
    CHECK(again >= 5);
}

TEST_CASE("detect: recorded liver and meat make no claim that is not warned about") {
    if (!recordings_are_there()) return;
    for (const char* name : {"pig_liver_20150826_region1.csv", "meat20150903_region1.csv"}) {
        CAPTURE(name);
        const Detection d = detect_regions(recording(name), name, {});
        CHECK(d.sure() == 0);
        for (const StiffRegion& r : d.regions) CHECK_FALSE(r.warnings.empty());
    }
}

TEST_CASE("detect: options and maps that cannot be are refused by name; few cells are warned about") {
    const Map level = map_of(12, 10, kPaperDepths_m, [](double, double, double d) { return 400.0 * d; });
    const auto said = [&](const DetectOptions& options) {
        return message_of([&] { detect_regions(level, "x.map", options); });
    };
    CHECK(said({}) == "");
    DetectOptions o;
    o.threshold = 0.9;
    CHECK(contains(said(o), "threshold: found 0.9, expected a ratio above 1"));
    o = {};
    o.deepest_m = 1e-3;  // above the first matrix
    CHECK(contains(said(o), "x.map: found no cell with a force down to 1 mm"));
    o = {};
    o.window_m = 0.0;
    CHECK(contains(said(o), "window"));
    const auto peak = [](double x, double y, double d) {
        return 400.0 * d * (std::hypot(x - 2e-3, y - 2e-3) < 1.1e-3 ? 3.0 : 1.0);
    };
    const Detection few = detect_regions(map_of(5, 5, kPaperDepths_m, peak), "few", {});
    CHECK(few.warnings.size() == 1);
    CHECK(few.sure() == 0);
}
