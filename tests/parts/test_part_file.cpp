#include <doctest/doctest.h>
#include <filesystem>
#include <functional>

#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::mechanics;
using namespace palpa::parts;
using namespace palpa::test;

TEST_CASE("part file: voxels, materials, supports and loads in SI units") {
    const Part part = parsed(small_part());
    CHECK(part.name == "small");
    CHECK(part.voxels.size == std::array<int, 3>{20, 4, 4});
    CHECK(part.voxels.frame.pitch_m == close_to(5e-4));
    CHECK(part.voxels_per_cell == 1);
    CHECK(material_at(part.voxels, 9, 0, 0) == 0);
    CHECK(material_at(part.voxels, 10, 3, 3) == 1);
    REQUIRE(part.materials.size() == 2);
    CHECK(part.materials[1].colour == "#ee6677");
    REQUIRE(part.supports.size() == 1);
    CHECK(part.supports[0].face == Side::xmin);
    REQUIRE(part.loads.size() == 2);
    CHECK(part.loads[1].at_m[0] == close_to(8e-3));
    CHECK(part.loads[1].direction == Point{0.0, 0.0, -1.0});
    CHECK(part.loads[1].force_N == 1.0);
    CHECK(part.axis == 0);
    CHECK(part.history.done.size() == 2);
}

TEST_CASE("part file: an operation that is appended and dropped, and the same part at half the pitch") {
    const Part part = parsed(small_part());
    Json json = small_part();
    json["shape"].push_back({{"sculpt", {{"points_mm", {{2, 1, 2}, {8, 1, 2}}}, {"radius_mm", 0.8}}}});
    Part cut = parsed(json);
    CHECK(count(cut.voxels, 2).voxels < count(part.voxels, 2).voxels);
    CHECK(undo(cut.voxels, cut.history));
    CHECK(cut.voxels.lines == part.voxels.lines);
    json["voxel_mm"] = 0.25;
    CHECK(parsed(json).voxels.size == std::array<int, 3>{40, 8, 8});
    CHECK(parsed(json).voxels_per_cell == 2);
}

TEST_CASE("part file: Gent's modulus of Shore A 50 is 2.456 MPa") {
    CHECK(young_Pa_of_shore_A(50.0) == close_to(2.4558e6).epsilon(1e-3));
    Json json = small_part();
    json["materials"]["soft"].erase("young_Pa");
    json["materials"]["soft"]["shore_A"] = 50;
    CHECK(parsed(json).materials[1].elastic.young_Pa == young_Pa_of_shore_A(50.0));
}

TEST_CASE("part file: what cannot be a part is refused with file and key") {
    struct Case {
        std::function<void(Json&)> change;
        const char* message;
    };
    const Json box{{"box", {{"min_mm", {4, -1, -1}}, {"max_mm", {6, 3, 3}}}}};
    const std::vector<Case> cases{
        {[](Json& j) { j["young_kPa"] = 1; }, "young_kPa"},
        {[](Json& j) { j.erase("materials"); }, "materials"},
        {[](Json& j) { j["materials"]["hard"]["young_Pa"] = 0; }, "materials.hard.young_Pa"},
        {[](Json& j) { j["materials"]["hard"]["poisson"] = 0.5; }, "materials.hard.poisson"},
        {[](Json& j) { j["materials"]["hard"]["shore_A"] = 50; }, "one of young_Pa and shore_A"},
        {[](Json& j) { j["materials"]["hard"]["colour"] = "red"; }, "materials.hard.colour"},
        {[](Json& j) { j["voxel_mm"] = 0.3; }, "a whole number of voxels"},
        {[](Json& j) { j["voxel_mm"] = 1e-4; }, "size_mm"},
        {[](Json& j) { j["cell_mm"] = 0.7; }, "cell_mm"},
        {[](Json& j) { j["shape"] = Json::array(); }, "at least one"},
        {[](Json& j) { j["shape"][0]["material"] = "gel"; }, "one of the materials: hard, soft"},
        {[](Json& j) {
             j["shape"][0]["remove"] = {{"all", true}};
         },
         "2 operations"},
        {[](Json& j) {
             j["shape"][1]["permute"]["box"]["min_mm"] = {20, 0, 0};
         },
         "shape[1]"},
        {[](Json& j) {
             j["shape"].push_back({{"remove", {{"all", true}}}});
         },
         "nothing left"},
        {[&](Json& j) {
             j["shape"].push_back({{"remove", box}});
         },
         "2 bodies"},
        {[](Json& j) { j["supports"][0]["fix"] = "xx"; }, "supports[0].fix"},
        {[](Json& j) { j["supports"][0]["face"] = "top"; }, "supports[0].face"},
        {[](Json& j) {
             j["loads"]["tip"]["at_mm"] = {1, 1, 1};
         },
         "loads.tip.at_mm"},
        {[](Json& j) {
             j["loads"]["tip"]["direction"] = {0, 0, 0};
         },
         "loads.tip.direction"},
        {[](Json& j) { j["loads"]["tip"]["force_N"] = -1; }, "loads.tip.force_N"},
        {[](Json& j) { j["axis"] = "w"; }, "axis"}};
    for (std::size_t i = 0; i < cases.size(); ++i) {
        CAPTURE(i);
        Json json = small_part();
        cases[i].change(json);
        const std::string message = message_of([&] { parsed(json); });
        CAPTURE(message);
        CHECK(test::contains(message, "p.json"));
        CHECK(test::contains(message, cases[i].message));
    }
}

TEST_CASE("part file: all parts that come with the program can be read") {
    int n = 0;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(PALPA_SOURCE_DIR "/assets/parts")) {
        if (entry.path().extension() != ".json") continue;
        CAPTURE(entry.path().string());
        CHECK(message_of([&] { read_part(entry.path()); }).empty());
        ++n;
    }
    CHECK(n >= 7);
}

TEST_CASE("bad input: nothing left, two bodies, a volume outside, E <= 0, nu >= 0.5, too many voxels") {
    const auto refused = [](const char* at, const char* with) {
        Json json = small_part();
        json[Json::json_pointer(at)] = Json::parse(with);
        return message_of([&] { parsed(json); });
    };
    CHECK(test::contains(refused("/shape/1", R"({"remove": {"all": true}})"), "shape: found nothing left"));
    CHECK(test::contains(refused("/shape/1", R"({"remove": {"box": {"min_mm": [4, 0, 0], "max_mm": [5, 2, 2]}}})"),
                         "shape: found 2 bodies"));
    // corners and edges that touch join nothing
    CHECK(test::contains(
        refused("/shape", R"([{"add": {"box": {"min_mm": [0, 0, 0], "max_mm": [1, 1, 1]}}, "material": "hard"},
        {"add": {"box": {"min_mm": [1, 1, 0], "max_mm": [2, 2, 1]}}, "material": "hard"}])"),
        "found 2 bodies"));
    CHECK(test::contains(refused("/shape/1", R"({"sculpt": {"points_mm": [[5, 1, 9]], "radius_mm": 2}})"),
                         "shape[1].sculpt: found a volume outside"));
    CHECK(test::contains(refused("/materials/hard/young_Pa", "-1"), "materials.hard.young_Pa: found -1"));
    CHECK(test::contains(refused("/materials/hard/poisson", "0.5"), "materials.hard.poisson: found 0.5"));
    CHECK(test::contains(refused("/voxel_mm", "1e-4"), "1e+05 voxels along an axis"));
    CHECK(test::contains(refused("/size_mm", "[10, 5000, 5000]"), "100000000 lines of voxels"));
}
