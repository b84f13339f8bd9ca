#include <cmath>
#include <doctest/doctest.h>

#include "files/text.h"
#include "parts/info.h"
#include "parts/stl_file.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/parts/small_part.h"
#include "tests/parts/solids.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::mechanics;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

std::string refusal(const std::string& bytes) {
    return message_of([&] { solid_of(parse_stl(bytes, "a.stl", 1e-3), "a.stl"); });
}

// A part whose shape is one STL file.
Json stl_part(const std::string& file) {
    Json json = small_part();
    json["shape"] = Json::array({{{"add", {{"stl", {{"file", file}, {"unit", "mm"}}}}}, {"material", "hard"}}});
    return json;
}

}  // namespace

TEST_CASE("stl: text and binary say the same, in every unit; a binary file may begin with 'solid'") {
    const auto box = box_triangles({1, 2, 3}, {4, 6, 8});
    for (const std::string& bytes : {text_stl(box), binary_stl(box), binary_stl(box, "solid by another program")}) {
        const TriangleSolid solid = solid_of(parse_stl(bytes, "a.stl", 1e-2), "a.stl");
        CHECK(solid.triangles.size() == 12);
        CHECK(solid.low_m[1] == close_to(0.02).epsilon(1e-12));
        CHECK(check_solid(solid).volume_m3 == close_to(60e-6).epsilon(1e-12));
        CHECK(check_solid(solid).open_edges == 0);
    }
}

TEST_CASE("stl: a box whose sides are voxel faces fills exactly those voxels, a ball nearly its volume") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "box.stl", binary_stl(box_triangles({0, 0, 0}, {10, 2, 2})));
    write_text_atomically(folder / "part.json", json_text(stl_part("box.stl")));
    Json plain = small_part();
    plain["shape"].erase(1);
    CHECK(info_of(read_part(folder / "part.json")).runs_sha256 == info_of(parsed(plain)).runs_sha256);

    write_text_atomically(folder / "ball.stl", text_stl(ball_triangles({5, 5, 5}, 4.0, 64)));
    Json ball = stl_part("ball.stl");
    ball["voxel_mm"] = 0.1;
    ball["size_mm"] = {10, 10, 10};
    ball["cell_mm"] = 0.1;
    write_text_atomically(folder / "ball.json", json_text(ball));
    const double inscribed = check_solid(read_stl(folder / "ball.stl", 1e-3, {})).volume_m3;
    CHECK(info_of(read_part(folder / "ball.json")).volume_m3 == close_to(inscribed).epsilon(2e-3));
}

TEST_CASE("stl: a solid that reaches out of the part's space is cut off with a warning that names where") {
    const TemporaryFolder folder;
    write_text_atomically(folder / "box.stl", binary_stl(box_triangles({0, 0, 0}, {10, 2, 2})));
    write_text_atomically(folder / "part.json", json_text(stl_part("box.stl")));
    CHECK(read_part(folder / "part.json").warnings.empty());
    write_text_atomically(folder / "box.stl", binary_stl(box_triangles({0, 0, 0}, {14, 2, 2})));
    const Part cut = read_part(folder / "part.json");
    REQUIRE(cut.warnings.size() == 1);
    CHECK(contains(cut.warnings[0], "reaches from 0 to 14 mm along x, and is cut off at 0 and 10 mm"));
}

TEST_CASE("stl: overlapping bodies are one, a cavity stays empty, moved ones move") {
    auto bodies = box_triangles({0, 0, 0}, {4, 2, 2});
    for (const auto& t : box_triangles({3, 0, 0}, {10, 2, 2})) bodies.push_back(t);
    for (const auto& t : turned(box_triangles({1, 0.5, 0.5}, {2, 1.5, 1.5}))) bodies.push_back(t);
    const TemporaryFolder folder;
    write_text_atomically(folder / "a.stl", binary_stl(bodies));
    Json json = stl_part("a.stl");
    json["shape"][0]["add"]["stl"]["offset_mm"] = {-1, 0, 0};
    write_text_atomically(folder / "p.json", json_text(json));
    const Part part = read_part(folder / "p.json");
    CHECK(material_at(part.voxels, 0, 1, 1) == -1);
    CHECK(material_at(part.voxels, 0, 0, 1) == 0);
    CHECK(material_at(part.voxels, 17, 1, 1) == 0);
    CHECK(material_at(part.voxels, 18, 1, 1) == -1);
}

TEST_CASE("bad input: an STL with holes names the share of lines on which the three axes disagree") {
    auto box = box_triangles({0, 0, 0}, {4, 4, 4});
    box.pop_back();
    const std::string message = refusal(binary_stl(box));
    CAPTURE(message);
    CHECK(test::contains(message, "% of the lines the three axes disagree; 3 edges of triangles have no partner"));
}

TEST_CASE("bad input: an STL that is inside out, or partly") {
    CHECK(test::contains(refusal(binary_stl(turned(box_triangles({0, 0, 0}, {4, 4, 4})))), "inside out"));
    auto two = box_triangles({0, 0, 0}, {4, 4, 4});
    for (const auto& t : turned(box_triangles({5, 0, 0}, {6, 1, 1}))) two.push_back(t);
    CHECK(test::contains(refusal(binary_stl(two)), "partly inside out"));
}

TEST_CASE("bad input: an STL without unit") {
    Json json = stl_part("a.stl");
    json["shape"][0]["add"]["stl"].erase("unit");
    const std::string message = message_of([&] { parsed(json); });
    CHECK(test::contains(message, "shape[0].add.stl.unit"));
    CHECK(test::contains(message, "um, mm, cm, m or inch"));
}

TEST_CASE("bad input: a binary STL that begins with 'solid' and is cut off, and files that are no STL") {
    const auto box = box_triangles({0, 0, 0}, {4, 4, 4});
    const std::string whole = binary_stl(box, "solid");
    CHECK(
        test::contains(refusal(whole.substr(0, whole.size() - 10)), "a binary file that begins with 'solid', of 674"));
    CHECK(test::contains(refusal("solid\n"), "the end of the file"));
    CHECK(test::contains(refusal("solid\nendsolid\n"), "0 triangles"));
    CHECK(test::contains(refusal("solid\nfacet normal 0 0 1\nouter loop\nvertex 0 0 zero\n"), "line 4"));
    CHECK(test::contains(refusal("solid\nfacet normal 0 0 1\nouter ring\n"), "'loop'"));
    CHECK(test::contains(refusal("PK"), "2 bytes"));
    CHECK(test::contains(refusal(binary_stl({})), "0 triangles"));
    auto nan = box;
    nan[3][1][2] = std::nan("");
    CHECK(test::contains(refusal(binary_stl(nan)), "triangle 4"));
    CHECK(test::contains(refusal(text_stl(nan)), "found 'nan'"));
    CHECK(test::contains(refusal(binary_stl({box[0]})), "holes"));
    CHECK(test::contains(message_of([] { parsed(stl_part("nowhere.stl")); }), "nowhere.stl"));
}
