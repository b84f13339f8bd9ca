#include <cmath>
#include <doctest/doctest.h>
#include <numbers>
#include <utility>

#include "parts/stiffness.h"
#include "parts/thin_walls.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

const std::vector<Method> kAll{Method::euler_bernoulli, Method::timoshenko, Method::voxels, Method::factorised};
const std::vector<Method> kBeams{Method::paper, Method::euler_bernoulli, Method::elastica};

// A neck of 40 x 6 x 4 mm with bands of 4 mm, voxels of 0.1 mm.
Json neck(double cell_mm) {
    Json json = small_part();
    json["voxel_mm"] = 0.1;
    json["size_mm"] = {40, 6, 4};
    json["cell_mm"] = cell_mm;
    json["shape"] = {
        {{"add", {{"all", true}}}, {"material", "hard"}},
        {{"permute", {{"bands", {{"axis", "x"}, {"period_mm", 8}, {"width_mm", 4}}}}}, {"material", "soft"}}};
    json["loads"].erase("patch");
    return json;
}

double neck_mm(double cell_mm) {
    const Part part = parsed(neck(cell_mm));
    return 1e3 * stiffness_of(part, part.loads[0], {{Method::voxels}, {}, 1e-4}).front().displacement_m;
}

}  // namespace

TEST_CASE("part stiffness: a slender beam, all methods agree and say against what they were compared") {
    Json json = small_part();
    json["size_mm"] = {20, 2, 2};
    json["shape"][1]["permute"]["box"] = {{"min_mm", {10, 0, 0}}, {"max_mm", {20, 2, 2}}};
    const Part part = parsed(json);
    const auto results = stiffness_of(part, part.loads[0], {kAll, {}, 1e-10});
    REQUIRE(results.size() == 4);
    for (const MethodResult& result : results) {
        CAPTURE(name_of(result.method));
        CAPTURE(result.why_not);
        CHECK(result.answered);
        CHECK(result.why_not.empty());
        CHECK(result.converged);
        CHECK(result.stiffness_N_per_m * result.displacement_m == close_to(1.0));
        CHECK(result.error.has_value() == (result.method != Method::factorised));
        if (result.error) CHECK(std::abs(*result.error) < (result.method == Method::voxels ? 1e-6 : 0.03));
        if (result.error) CHECK(result.against == "factorised");
    }
    CHECK(results[2].cells == 40 * 4 * 4);
}

TEST_CASE("part stiffness: a force over a patch bends less than at the tip, a skew force only by its part across") {
    const Part part = parsed(small_part());
    const auto tip = stiffness_of(part, part.loads[0], {kAll, {}, 1e-8});
    const auto patch = stiffness_of(part, part.loads[1], {kAll, {}, 1e-8});
    for (std::size_t i = 0; i < tip.size(); ++i) CHECK(patch[i].displacement_m < tip[i].displacement_m);
    PartLoad skew = part.loads[0];
    skew.direction = {0.6, 0.0, -0.8};
    const auto beams = stiffness_of(part, skew, {{Method::timoshenko}, {}, 1e-8});
    CHECK(beams[0].displacement_m == close_to(0.64 * tip[1].displacement_m));
}

TEST_CASE("part stiffness: each method says when it does not apply") {
    Json json = small_part();
    json["size_mm"] = {6, 2, 2};
    json["shape"].erase(1);
    json["loads"].erase("patch");
    Part part = parsed(json);
    CHECK(test::contains(stiffness_of(part, part.loads[0], {kAll, {}, 1e-3})[0].why_not, "length over height is 3"));
    part.loads[0].force_N = 1e4;
    const auto bent = stiffness_of(part, part.loads[0], {kAll, {}, 1e-3});
    CHECK(test::contains(bent[1].why_not, "further than with them (elastica)"));
    CHECK(test::contains(bent[2].why_not, "strains"));
    part.loads[0].force_N = 1.0;
    const auto coarse = stiffness_of(part, part.loads[0], {{Method::timoshenko, Method::voxels}, 2e-3, 1e-3});
    CHECK(test::contains(coarse[1].why_not, "one cell across"));
    CHECK_FALSE(coarse[0].error);  // what does not apply is no reference
    PartLoad held = part.loads[0];
    held.face = mechanics::Side::xmin;  // where the part is clamped
    const auto still = stiffness_of(part, held, {{Method::voxels}, {}, 1e-3});
    CHECK_FALSE(still[0].answered);
    CHECK(test::contains(still[0].why_not, "nothing moves"));
    part.axis.reset();
    CHECK_FALSE(stiffness_of(part, part.loads[0], {kAll, {}, 1e-3})[0].answered);
    part.axis = 2;
    CHECK(test::contains(stiffness_of(part, part.loads[0], {kAll, {}, 1e-3})[0].why_not, "along the axis"));
}

TEST_CASE("part stiffness: cells too large for the toothbrush do not apply, and refuse no beam that is right") {
    const Part brush = read_part(PALPA_SOURCE_DIR "/assets/parts/toothbrush-a.json");
    for (const double cell_mm : {0.8, 2.0, 3.0, 4.0}) {
        CAPTURE(cell_mm);
        const auto results =
            stiffness_of(brush, brush.loads[0], {{Method::euler_bernoulli, Method::voxels}, 1e-3 * cell_mm, 1e-3});
        const bool right = std::abs(results[1].displacement_m / 1.66e-3 - 1.0) < 0.02;
        CHECK(right == (cell_mm < 2.5));
        CHECK(results[0].why_not.empty());
        CHECK(results[1].why_not.empty() == right);
        REQUIRE(results[1].coarser);
        CHECK((std::abs(*results[1].coarser) < kMostByCells) == (cell_mm < 1.0));
        if (right) continue;
        CHECK(contains(results[1].why_not, "on cells of " + std::to_string(static_cast<int>(cell_mm) / 2)));
        CHECK_FALSE(results[0].error);  // what does not apply is no reference
    }
}

TEST_CASE("part stiffness: cells that are as large as a flange do not apply, though larger ones say much the same") {
    const Part slotted = parsed(Json::parse(R"({
        "voxel_mm": 1, "size_mm": [60, 6, 12],
        "materials": {"hard": {"young_Pa": 2e9, "poisson": 0.35, "density_kg_per_m3": 1200}},
        "shape": [{"add": {"all": true}, "material": "hard"},
                  {"remove": {"box": {"min_mm": [12, -1, 4], "max_mm": [48, 7, 8]}}}],
        "supports": [{"face": "xmin", "fix": "xyz"}],
        "loads": {"tip": {"face": "xmax", "direction": "-z", "force_N": 0.2}}})"));
    CHECK(share_of_thin_walls(slotted.voxels, 4) == 0.0);  // flanges of four voxels
    CHECK(share_of_thin_walls(slotted.voxels, 6) == close_to(36.0 * 8.0 / (60.0 * 12.0 - 36.0 * 4.0)));
    const auto on_cells = [&](double cell_mm) {
        return stiffness_of(slotted, slotted.loads[0], {{Method::voxels}, 1e-3 * cell_mm, 1e-3})[0];
    };
    const MethodResult fine = on_cells(1), coarse = on_cells(3);
    CHECK(fine.why_not.empty());
    CHECK(on_cells(2).why_not.empty());  // 2 % off
    CHECK(coarse.displacement_m < 0.6 * fine.displacement_m);
    CHECK(std::abs(coarse.coarser.value_or(1.0)) < kMostByCells);
    CHECK(contains(coarse.why_not, "on cells of 1 mm the displacement is"));
}

TEST_CASE("part stiffness: a beam doubts a load that is oblique across its section, and one that is spread along it") {
    Json json = small_part();
    json["size_mm"] = {20, 2, 2};
    json["shape"].erase(1);
    json["loads"] = {{"oblique", {{"face", "xmax"}, {"direction", {0, 1, 1}}}},
                     {"along", {{"face", "zmax"}, {"direction", "-z"}}},
                     {"short", {{"at_mm", {14, 1, 2}}, {"patch_mm", 10}, {"direction", "-z"}}}};
    const Part part = parsed(json);
    for (const PartLoad& load : part.loads) {
        CAPTURE(load.name);
        const auto results = stiffness_of(part, load, {{Method::timoshenko, Method::voxels}, {}, 1e-6});
        CHECK(results[0].answered);
        CHECK(test::contains(results[0].why_not, load.name == "oblique" ? "along z, 100 % of that along y, is left out"
                                                 : load.name == "along" ? "spread along the beam over 20 mm"
                                                                        : ""));
        // what is doubted is wrong, what is not is right
        REQUIRE(results[0].error);
        CHECK((std::abs(*results[0].error) < 0.03) == results[0].why_not.empty());
    }
}

TEST_CASE("part stiffness: the paper's spring never applies and says why, the elastica does beyond 10 degrees") {
    Json json = small_part();
    json["size_mm"] = {100, 2, 1};
    json["loads"].erase("patch");
    const Part part = parsed(json);
    PartLoad light = part.loads[0];
    light.force_N = 0.001;
    const auto small = stiffness_of(part, light, {kBeams, {}, 1e-3});
    CHECK(test::contains(small[0].why_not, "3 pieces here"));
    CHECK(small[0].answered);
    CHECK(small[2].displacement_m == close_to(small[1].displacement_m).epsilon(1e-4));
    PartLoad bends = part.loads[0];
    bends.force_N = 0.5;
    const auto large = stiffness_of(part, bends, {kBeams, {}, 1e-3});
    CHECK_FALSE(large[1].why_not.empty());
    CHECK(large[2].why_not.empty());
    CHECK(large[2].displacement_m < large[1].displacement_m);
    bends.force_N = 50.0;  // no material bears that
    CHECK(test::contains(stiffness_of(part, bends, {kBeams, {}, 1e-3})[2].why_not, "strains reach up to"));
}

TEST_CASE(
    "part stiffness: a soft end that turns far under a short chord, and shears: no beam applies that leaves it out") {
    // the example of docs/parts.md; the displacements by numpy: sections along the beam, and the elastica by shooting
    Json json = small_part();
    json["size_mm"] = {100, 10, 10};
    json["materials"]["rubber"] = {{"shore_A", 60}, {"poisson", 0.49}, {"density_kg_per_m3", 1100}};
    json["shape"] = {
        {{"add", {{"all", true}}}, {"material", "hard"}},
        {{"permute", {{"box", {{"min_mm", {80, 0, 0}}, {"max_mm", {100, 10, 10}}}}}}, {"material", "rubber"}},
        {{"sculpt", {{"points_mm", {{20, 5, 10}, {60, 5, 10}}}, {"radius_mm", 2}}}}};
    json["materials"]["hard"] = {{"young_Pa", 8.3e9}, {"poisson", 0.28}, {"density_kg_per_m3", 1200}};
    json["loads"] = {{"tip", {{"face", "xmax"}, {"direction", "-z"}, {"force_N", 10}}}};
    const Part part = parsed(json);
    const auto at_N = [&](double force_N) {
        PartLoad load = part.loads[0];
        load.force_N = force_N;
        return stiffness_of(part, load, {{Method::euler_bernoulli, Method::timoshenko, Method::elastica}, {}, 1e-3});
    };
    const auto strong = at_N(10.0);
    CHECK(strong[0].displacement_m == close_to(9.392e-3).epsilon(1e-3));
    CHECK(strong[2].displacement_m == close_to(8.018e-3).epsilon(1e-3));
    CHECK(test::contains(strong[0].why_not, "goes 17."));
    CHECK(test::contains(strong[1].why_not, "goes 17."));
    CHECK(test::contains(strong[2].why_not, "shear, which it leaves out, adds 21."));
    const auto light = at_N(1.0);
    CHECK(test::contains(light[0].why_not, "shear, which it leaves out, adds 21."));
    CHECK(light[1].why_not.empty());
}

TEST_CASE("part stiffness: cells of 0.7 to 1 mm that fit neither bands nor section, within 3 % of cells of 0.4 mm") {
    const double fine_mm = neck_mm(0.4);
    for (const double cell_mm : {0.7, 0.9, 1.0}) {
        CAPTURE(cell_mm);
        CHECK(neck_mm(cell_mm) == close_to(fine_mm).epsilon(0.03));
    }
}

TEST_CASE("part stiffness: a box that holds a bar up to a plane holds it in that plane too") {
    Json json = small_part();
    json["size_mm"] = {40, 4, 4};
    json["cell_mm"] = 1.0;
    json["shape"] = {{{"add", {{"all", true}}}, {"material", "hard"}}};
    json["loads"].erase("patch");
    const auto held_up_to = [&](double x_mm) {
        json["supports"] = {{{"box", {{"min_mm", {0, 0, 0}}, {"max_mm", {x_mm, 4, 4}}}}, {"fix", "xyz"}}};
        const Part part = parsed(json);
        return 1e3 * stiffness_of(part, part.loads[0], {{Method::voxels}, {}, 1e-8}).front().displacement_m;
    };
    const double up_to_8_mm = held_up_to(8.0);
    CHECK(up_to_8_mm == close_to(held_up_to(8.5)).epsilon(1e-6));
    CHECK(up_to_8_mm < 0.95 * held_up_to(7.5));
}

TEST_CASE("part stiffness: a plate that is held outside of a hole in the region is free over the hole") {
    const auto deflection_mm = [](const std::string& supports) {
        const Part plate = parsed(Json::parse(R"({
            "voxel_mm": 0.5, "size_mm": [20, 20, 1],
            "materials": {"rubber": {"young_Pa": 2e6, "poisson": 0.3, "density_kg_per_m3": 1000}},
            "shape": [{"add": {"all": true}, "material": "rubber"}],
            "supports": [)" + supports + R"(],
            "loads": {"middle": {"at_mm": [10, 10, 1], "patch_mm": 2, "direction": "-z", "force_N": 0.001}}})"));
        return 1e3 * stiffness_of(plate, plate.loads[0], {{Method::voxels}, {}, 1e-6}).front().displacement_m;
    };
    const auto rim = [](double from_mm, double to_mm) {
        return R"({"without": [{"all": true}, {"cylinder": {"from_mm": [10, 10, )" + std::to_string(from_mm) +
               R"(], "to_mm": [10, 10, )" + std::to_string(to_mm) + R"(], "radius_mm": 8}}], "fix": "xyz"})";
    };
    const double clamped_mm = deflection_mm(rim(-1.0, 2.0));
    const double D = 2e6 * 1e-9 / (12.0 * (1.0 - 0.09));  // N m, of the plate
    CHECK(
        clamped_mm ==
        close_to(1e3 * 0.001 * 64e-6 / (16.0 * std::numbers::pi * D)).epsilon(0.2));  // P a^2 / (16 pi D); patch, steps
    // where the hole ends at the plate's own faces
    for (const auto& [from_mm, to_mm] : {std::pair{0.0, 2.0}, {-1.0, 1.0}, {0.0, 1.0}})
        CHECK(deflection_mm(rim(from_mm, to_mm)) == close_to(clamped_mm));
    // a plate on a box that touches it from below is held by that face
    CHECK(deflection_mm(R"({"box": {"min_mm": [0, 0, -1], "max_mm": [20, 20, 0]}, "fix": "xyz"})") ==
          close_to(deflection_mm(R"({"face": "zmin", "fix": "xyz"})")));
}

TEST_CASE("part stiffness: a force on air, nothing held and cells of half a voxel are refused") {
    const Part part = parsed(small_part());
    const auto message = [](const Part& changed, const StiffnessOptions& options) {
        return message_of([&] { stiffness_of(changed, changed.loads.back(), options); });
    };
    Part air = part;
    air.loads[1].at_m = {8e-3, 1e-3, 9e-3};
    CHECK(test::contains(message(air, {{Method::voxels}, {}, 1e-3}), "loads.patch.at_mm"));
    Part loose = part;
    loose.supports[0].axes = 1;
    CHECK(test::contains(message(loose, {{Method::voxels}, {}, 1e-3}), "moves along"));
    loose.supports.clear();
    CHECK(test::contains(message(loose, {{Method::voxels}, {}, 1e-3}), "supports"));
    CHECK(test::contains(message(part, {{Method::voxels}, 2.5e-4, 1e-3}), "a whole number of voxels"));
}
