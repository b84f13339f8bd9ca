#include <doctest/doctest.h>

#include "parts/info.h"
#include "tests/close_to.h"
#include "tests/parts/small_part.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::parts;
using namespace palpa::test;

TEST_CASE("part info: volume, mass, centroid and sizes of a beam that is half soft") {
    const PartInfo info = info_of(parsed(small_part()));
    CHECK(info.voxels == 320);
    CHECK(info.runs == 2 * 16);
    CHECK(info.plain_bytes == 320);
    CHECK(info.volume_m3 == close_to(40e-9));
    CHECK(info.mass_kg == close_to(20e-9 * (1200 + 1020)));
    CHECK(info.centroid_m[0] == close_to(1e-3 * (2.5 * 1200 + 7.5 * 1020) / 2220));
    CHECK(info.centroid_m[1] == close_to(1e-3));
    CHECK(info.runs_sha256.size() == 64);
}

TEST_CASE("part info: permute and its inverse give the same hash, and the mass changes by V (rho2 - rho1)") {
    const PartInfo before = info_of(parsed(small_part()));
    const Json ball{{"sphere", {{"centre_mm", {2, 1, 1}}, {"radius_mm", 0.9}}}};
    Json json = small_part();
    json["shape"].push_back({{"permute", ball}, {"material", "soft"}, {"from", "hard"}});
    const PartInfo swapped = info_of(parsed(json));
    CHECK(swapped.runs_sha256 != before.runs_sha256);
    const auto n = static_cast<double>(before.voxels_of_material[0] - swapped.voxels_of_material[0]);
    CHECK(n > 10);
    CHECK(swapped.voxels == before.voxels);
    CHECK(swapped.mass_kg - before.mass_kg == close_to(n * 0.125e-9 * (1020 - 1200)).epsilon(1e-9));
    json["shape"].push_back({{"permute", ball}, {"material", "hard"}, {"from", "soft"}});
    CHECK(info_of(parsed(json)).runs_sha256 == before.runs_sha256);
}
