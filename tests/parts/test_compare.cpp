#include <doctest/doctest.h>

#include "parts/button_file.h"
#include "parts/compare.h"
#include "parts/info.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

Json one_material(double young_Pa, double density_kg_per_m3) {
    Json json = small_part();
    json["materials"] = {{"one", {{"young_Pa", young_Pa}, {"poisson", 0.3}, {"density_kg_per_m3", density_kg_per_m3}}}};
    json["shape"] = Json::array({{{"add", {{"all", true}}}, {"material", "one"}}});
    return json;
}

const StiffnessOptions kVoxels{{Method::voxels}, {}, 1e-8}, kRough{{Method::voxels}, {}, 1e-3};

}  // namespace

TEST_CASE("compare: the same shape of another modulus and density has their ratios") {
    const Part a = parsed(one_material(2e9, 1000)), b = parsed(one_material(2.36e9, 1300));
    const PartComparison c = compare_parts(a, b, "tip", kVoxels);
    CHECK(c.stiffness_ratio == close_to(1.18).epsilon(1e-6));
    CHECK(c.mass_ratio == close_to(1.3).epsilon(1e-12));
    CHECK(c.difference == close_to(0.18).epsilon(1e-5));
    CHECK(c.difference > kWeberFractions[0].share);
    CHECK(c.difference < kWeberFractions[1].share);
    CHECK(c.b.mass_kg == close_to(info_of(b).mass_kg));
    // the other way about, the difference is the same
    const PartComparison turned = compare_parts(b, a, "tip", kVoxels);
    CHECK(turned.stiffness_ratio == close_to(1.0 / 1.18).epsilon(1e-6));
    CHECK(turned.difference == close_to(c.difference).epsilon(1e-9));
}

TEST_CASE("compare: buttons that switch at other forces") {
    Json json = read_json(PALPA_SOURCE_DIR "/assets/parts/button.json");
    const Part a = parsed(json);
    json["button"]["support"]["latch"]["threshold_N"] = 2;
    const Part b = parsed(json);
    const PartComparison c = compare_parts(a, b, "cap", kRough);
    REQUIRE(c.switch_force_ratio);
    CHECK(*c.a.switch_force_N == close_to(button_curve(a).peak_N));
    CHECK(*c.switch_force_ratio == close_to(button_curve(b).peak_N / button_curve(a).peak_N));
    CHECK(*c.switch_force_ratio > 1.2);
    const Part cover = parsed(read_json(PALPA_SOURCE_DIR "/assets/parts/bare-cover.json"));  // does not snap
    const PartComparison bare = compare_parts(a, cover, "cap", kRough);
    CHECK_FALSE(bare.b.switch_force_N);
    CHECK_FALSE(bare.switch_force_ratio);
    CHECK_FALSE(compare_parts(parsed(small_part()), parsed(small_part()), "tip", kVoxels).switch_force_ratio);
}

TEST_CASE(
    "bad input: designs without a common load, with several, of different forces, and a method without an answer") {
    const Part a = parsed(small_part());
    const auto refused = [&](const Json& other, const char* load, Method method) {
        return message_of([&] { compare_parts(a, parsed(other), load, {{method}, {}, 1e-3}); });
    };
    Json json = small_part();
    CHECK(test::contains(refused(json, "", Method::voxels), "one of tip, patch"));
    CHECK(test::contains(refused(json, "head", Method::voxels), "found 'head', expected one of tip, patch"));
    json["loads"]["tip"]["force_N"] = 2;
    CHECK(test::contains(refused(json, "tip", Method::voxels), "loads.tip.force_N: found 2, expected 1"));
    json["loads"]["tip"]["force_N"] = 1;
    json["loads"]["tip"]["direction"] = {1, 0, 1};
    CHECK(test::contains(refused(json, "tip", Method::voxels), "loads.tip.direction: found (0.7071, 0, 0.7071)"));
    json.erase("loads");
    CHECK(test::contains(refused(json, "", Method::voxels), "no load of a name"));
    json = small_part();
    json.erase("axis");
    CHECK(test::contains(refused(json, "tip", Method::timoshenko), "no answer"));
}
