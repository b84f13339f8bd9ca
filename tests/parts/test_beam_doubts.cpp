#include <cmath>
#include <doctest/doctest.h>

#include "parts/stiffness.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

const std::vector<Method> kTimoshenko{Method::timoshenko};
const std::vector<Method> kBoth{Method::timoshenko, Method::voxels};

Json box(double x0, double y0, double z0, double x1, double y1, double z1) {
    return {{"min_mm", {x0, y0, z0}}, {"max_mm", {x1, y1, z1}}};
}

// A bar of one material, clamped at its left end, of so many mm; voxels of 0.5 mm.
Json bar(double x, double y, double z) {
    Json json = small_part();
    json["size_mm"] = {x, y, z};
    json["shape"].erase(1);
    json["loads"].erase("patch");
    return json;
}

std::string doubt(const Json& json, const std::vector<Method>& methods = kTimoshenko) {
    const Part part = parsed(json);
    return stiffness_of(part, part.loads[0], {methods, {}, 1e-4})[0].why_not;
}

}  // namespace

TEST_CASE("beam doubts: a straight bar of one piece has none, and one saw cut is no other beam") {
    Json json = bar(40, 4, 4);
    CHECK(doubt(json, kBoth).empty());
    json["shape"].push_back({{"remove", {{"box", box(20, 1, 1, 20.5, 3, 3)}}}});
    CHECK(doubt(json).empty());
}

TEST_CASE("beam doubts: a slit along the bar makes two bars that bend one by one") {
    Json json = bar(40, 4, 4);
    json["shape"].push_back({{"remove", {{"box", box(4, 0, 1.5, 36, 4, 2.5)}}}});
    CHECK(contains(doubt(json), "in pieces that do not touch, from 4.25 mm"));
    for (const char* direction : {"-x", "-y"}) {  // along z
        CAPTURE(direction);
        const bool along_x = direction[1] == 'x';
        Json upright = bar(4, 4, 40);
        upright["axis"] = "z";
        upright["supports"] = {{{"face", "zmin"}, {"fix", "xyz"}}};
        upright["loads"] = {{"tip", {{"face", "zmax"}, {"direction", direction}}}};
        CHECK(doubt(upright).empty());
        upright["shape"].push_back(
            {{"remove", {{"box", along_x ? box(1.5, 0, 4, 2.5, 4, 36) : box(0, 1.5, 4, 4, 2.5, 36)}}}});
        CHECK(contains(doubt(upright), "in pieces that do not touch, from 4.25 mm"));
        upright["shape"].back() = {{"remove", {{"box", box(1, 1, 0, 4, 4, 40)}}}};
        CHECK(contains(doubt(upright), "turned against the plane of the load"));
    }
}

TEST_CASE("beam doubts: an angle section gives way sideways too") {
    Json json = bar(40, 4, 4);
    json["shape"].push_back({{"remove", {{"box", box(0, 1, 1, 40, 4, 4)}}}});
    CHECK(contains(doubt(json), "turned against the plane of the load"));
    json["shape"].back() = {{"remove", {{"box", box(0, 1, 0, 40, 3, 3)}}}};  // a channel is symmetric
    CHECK(doubt(json).empty());
}

TEST_CASE("beam doubts: a load beside the bar twists it") {
    Json json = bar(40, 12, 4);
    json["shape"].push_back({{"remove", {{"box", box(0, 4, 0, 36, 12, 4)}}}});
    json["loads"] = {{"arm", {{"at_mm", {38, 11, 4}}, {"patch_mm", 1}, {"direction", "-z"}}}};
    CHECK(contains(doubt(json), "mm beside the axis and twists it"));
}

TEST_CASE("beam doubts: a channel twists under a load beside its shear centre, a closed or upright one does not") {
    Json json = bar(60, 10, 10);
    json["shape"].push_back({{"remove", {{"box", box(0, 1.5, 1.5, 60, 10, 8.5)}}}});  // open to +y, under -z
    CHECK(contains(doubt(json), "its section is open, and not symmetric about the plane of the load"));
    Json upright = json;
    upright["loads"]["tip"]["direction"] = "-y";
    CHECK(doubt(upright).empty());
    json["shape"].back()["remove"]["box"] = box(0, 1.5, 1.5, 60, 8.5, 8.5);
    CHECK(doubt(json).empty());
}

TEST_CASE("beam doubts: a folded bar is no straight beam") {
    Json json = bar(60, 10, 10);
    for (int i = 0; i < 5; ++i) {
        const double z = i % 2 == 0 ? 2.0 : 0.0;
        json["shape"].push_back({{"remove", {{"box", box(6.0 + 10.0 * i, 0, z, 12.0 + 10.0 * i, 10, z + 8.0)}}}});
    }
    CHECK(contains(doubt(json), "it is no straight beam"));
}

TEST_CASE("beam doubts: what is wider than long is a plate") {
    CHECK(contains(doubt(bar(20, 20, 2)), "a plate, up to 8.5"));
}

TEST_CASE("beam doubts: stiff faces on a soft core bend by themselves, and the cells say so too") {
    Json json = bar(40, 4, 4);
    json["materials"]["soft"]["young_Pa"] = 1e6;
    json["shape"].push_back({{"permute", {{"box", box(0, 0, 1, 40, 4, 3)}}}, {"material", "soft"}});
    CHECK(contains(doubt(json), "stiff layers on a soft core bend by themselves"));
    const Part part = parsed(json);
    const auto results = stiffness_of(part, part.loads[0], {{Method::euler_bernoulli, Method::voxels}, {}, 1e-4});
    CHECK(std::abs(*results[0].error) > kMostApart);
}

TEST_CASE(
    "part stiffness: a plate held at both ends stretches when it goes deep, and cells of small displacements say so") {
    Json json = bar(40, 8, 1);
    json["supports"] = {{{"face", "xmin"}, {"fix", "xyz"}}, {{"face", "xmax"}, {"fix", "xyz"}}};
    json["loads"] = {{"middle", {{"at_mm", {20, 4, 1}}, {"patch_mm", 2}, {"direction", "-z"}, {"force_N", 30}}}};
    Part part = parsed(json);
    const auto deep = stiffness_of(part, part.loads[0], {{Method::voxels}, {}, 1e-4});
    CHECK(deep[0].displacement_m > 0.25e-3);
    CHECK(contains(deep[0].why_not, "it stretches"));
    part.loads[0].force_N = 1.0;
    CHECK(stiffness_of(part, part.loads[0], {{Method::voxels}, {}, 1e-4})[0].why_not.empty());
}

TEST_CASE(
    "beam doubts: a column beyond its buckling load, and a bar that is bent and pressed or pulled along its axis") {
    Json json = bar(100, 4, 4);
    json["voxel_mm"] = 1.0;
    json["cell_mm"] = 1.0;
    const auto with = [&](const Json& direction, double force_N, Method method) {
        json["loads"] = {{"tip", {{"face", "xmax"}, {"direction", direction}, {"force_N", force_N}}}};
        return doubt(json, {method});
    };
    // Euler's load with the bar's 8.3 GPa: pi^2 E I / (4 L^2) = 43.69 N
    CHECK(contains(with("-x", 2000.0, Method::voxels), "% of the 43.69 N at which the part buckles"));
    CHECK(with("-x", 15.0, Method::voxels).empty());
    CHECK(with("x", 40.0, Method::voxels).empty());
    // a rubber end buckles by itself, whatever the rest's stiffness: pi^2 E I / (4 (30 mm)^2) of 4 x 4 mm, a little less
    const Json uniform = json;
    json["materials"]["rubber"] = {{"young_Pa", 4e6}, {"poisson", 0.49}, {"density_kg_per_m3", 1100}};
    json["shape"].push_back({{"permute", {{"box", box(70, 0, 0, 100, 4, 4)}}}, {"material", "rubber"}});
    CHECK(contains(with("-x", 0.2, Method::voxels), "of the 0.2334 N at which the part buckles"));
    json = uniform;
    const Json oblique{-1.0, 0.0, -2.0}, pulled{1.0, 0.0, -2.0};
    CHECK(contains(with(oblique, 10.0, Method::timoshenko), "and bends it further"));
    CHECK(contains(with(pulled, 10.0, Method::timoshenko), "and pulls it straight"));
    CHECK(with(oblique, 1.0, Method::timoshenko).empty());
    CHECK(contains(with(oblique, 2.5, Method::elastica), "and bends it further"));  // 2.6 % of Euler's load: 5 % off
    CHECK(with("-z", 1.0, Method::timoshenko).empty());
}
