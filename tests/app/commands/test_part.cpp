// `palpa part` as a person calls it.

#include <doctest/doctest.h>

#include "files/json.h"
#include "files/text.h"
#include "tests/app/palpa_with.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::test;

namespace {

const std::string kParts = PALPA_SOURCE_DIR "/assets/parts/";

// The displacement that a method gives for one of the beams, mm.
double displacement_mm(const Json& json, const char* method) {
    return json["methods"][method]["displacement_mm"].get<double>();
}

}  // namespace

TEST_CASE(
    "part stiffness: the five beams have the displacements of the closed forms and of the same element elsewhere") {
    struct Beam {
        const char* name;
        double euler_mm, timoshenko_mm, voxels_mm;
    };
    for (const Beam& beam :
         {Beam{"homogeneous", 0.481928, 0.485629, 0.4816322}, Beam{"alternating-hshsh", 1.016289, 1.025201, 1.0044452},
          Beam{"alternating-shshs", 1.465639, 1.477156, 1.4321732}, Beam{"sandwich-hsh", 0.495868, 0.506614, 0.5028904},
          Beam{"sandwich-shs", 1.791045, 1.799366, 1.7670337}}) {
        CAPTURE(beam.name);
        const Called called =
            palpa_with("part evaluate " + kParts + "beams/" + beam.name + ".json --tolerance 1e-8 --json");
        REQUIRE_MESSAGE(called.status == 0, called.err);
        const Json json = parse_json(called.out, "stdout");
        CHECK(displacement_mm(json, "euler-bernoulli") == doctest::Approx(beam.euler_mm).epsilon(2e-6));
        CHECK(displacement_mm(json, "timoshenko") == doctest::Approx(beam.timoshenko_mm).epsilon(2e-6));
        CHECK(displacement_mm(json, "voxels") == doctest::Approx(beam.voxels_mm).epsilon(1e-6));
        CHECK(json["methods"]["voxels"]["converged"] == true);
        CHECK(json["methods"]["timoshenko"]["applies"] == true);
        CHECK(json["methods"]["timoshenko"]["error_against"] == "voxels");
    }
}

TEST_CASE("part info: a table for people, and every key in JSON") {
    const std::string file = kParts + "toothbrush-a.json";
    const Called table = palpa_with("part info " + file);
    CHECK_MESSAGE(table.status == 0, table.err);
    for (const char* word : {"Toothbrush a", "voxels of 0.1 mm", "mm3", "of soft"})
        CHECK(test::contains(table.out, word));
    const Json json = parse_json(palpa_with("part info " + file + " --json").out, "stdout");
    for (const char* key : {"voxels", "runs", "memory_bytes", "plain_bytes", "volume_mm3", "mass_g", "centroid_mm",
                            "voxels_of_material", "runs_sha256"}) {
        CAPTURE(key);
        CHECK(json.contains(key));
    }
    CHECK(json["plain_bytes"] == 1900 * 140 * 120);
    CHECK(20 * json["memory_bytes"].get<double>() < json["plain_bytes"].get<double>());
}

TEST_CASE("part: wrong usage and wrong parts end with status 2 and a message") {
    const std::string beam = kParts + "beams/homogeneous.json";
    for (const std::string& arguments :
         {std::string("part info nowhere.json"), "part stiffness " + beam + " --load head",
          "part stiffness " + beam + " --method magic", "part stiffness " + beam + " --cell-mm 1.3",
          "part stiffness " + beam + " --tolerance 0", std::string("part")}) {
        CAPTURE(arguments);
        const Called called = palpa_with(arguments);
        CHECK(called.status == 2);
        CHECK_FALSE(called.err.empty());
    }
    CHECK(test::contains(palpa_with("part stiffness " + beam + " --load head").err, "one of tip"));
    CHECK(test::contains(palpa_with("part stiffness " + beam).out, "euler-bernoulli"));
}
