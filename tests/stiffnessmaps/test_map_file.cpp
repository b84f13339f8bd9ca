#include <doctest/doctest.h>
#include <limits>

#include "files/npy.h"
#include "files/text.h"
#include "stiffnessmaps/map_file.h"
#include "tests/close_to.h"
#include "tests/error_message.h"
#include "tests/stiffnessmaps/test_maps.h"
#include "tests/temporary_folder.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::stiffnessmaps;
using namespace palpa::test;

namespace {

Map small() {
    Map map = map_of(4, 3, {1e-3, 2e-3}, [](double x, double y, double d) { return 1e3 * d + x + y; });
    map.origin_m[0] = -0.04e-3;
    map.spacing_m[1] = 2e-3;
    map.nodules.push_back({"A", true, 2e-3, 3e-3, 6e-3, 10e-3, std::nullopt, std::nullopt});
    return map;
}

// What reading says after one text in map.json was replaced by another.
std::string refusal_of_map(const std::string& from, const std::string& to) {
    const TemporaryFolder folder;
    write_map(small(), folder / "x.map");
    std::string text = read_text(folder / "x.map/map.json");
    const auto at = text.find(from);
    REQUIRE(at != std::string::npos);
    text.replace(at, from.size(), to);
    write_text_atomically(folder / "x.map/map.json", text);
    return message_of([&] { read_map(folder / "x.map"); });
}

}  // namespace

TEST_CASE("map file: what is written reads back") {
    const TemporaryFolder folder;
    Map map = small();
    map.normal_N[5] = std::numeric_limits<float>::quiet_NaN();
    write_map(map, folder / "x.map");
    const Map back = read_map(folder / "x.map");
    CHECK(map_json(back) == map_json(map));
    CHECK(back.n_x == 4);
    CHECK(back.n_y == 3);
    CHECK(missing_count(back) == 1);
    CHECK(back.origin_m[0] == close_to(-4e-5));
    CHECK(back.nodules[0].top_depth_m == close_to(6e-3));
    CHECK(contains(message_of([&] { write_map(map, folder / "x.map"); }), "nothing is overwritten"));
    CHECK(std::distance(std::filesystem::directory_iterator(folder.path()), {}) == 1);
}

TEST_CASE("map file: a map that names no nodules because it does not know them says nothing of them") {
    const TemporaryFolder folder;
    Map map = small();
    map.nodules.clear();
    write_map(map, folder / "none.map");
    CHECK(contains(read_text(folder / "none.map/map.json"), "\"nodules\": []"));
    CHECK(read_map(folder / "none.map").nodules_known);
    map.nodules_known = false;
    write_map(map, folder / "unknown.map");
    CHECK_FALSE(contains(read_text(folder / "unknown.map/map.json"), "nodules"));
    CHECK_FALSE(read_map(folder / "unknown.map").nodules_known);
}

TEST_CASE("map file: choices, noise and the filled copy read back; a copy that differs is refused") {
    const TemporaryFolder folder;
    Map map = small();
    map.normal_N[5] = std::numeric_limits<float>::quiet_NaN();
    map.filled_normal_N = map.normal_N;
    map.filled_normal_N[5] = 1.5f;
    map.noise_N = 0.02;
    map.source.choices = {{"grid", std::string("plane"), "no regular grid", "--grid"},
                          {"pitch_mm", std::vector<double>{1.0, 2.0}, "", "--pitch-mm"},
                          {"noise_N", 0.02, "", ""}};
    write_map(map, folder / "x.map");
    const Map back = read_map(folder / "x.map");
    CHECK(map_json(back) == map_json(map));
    CHECK(back.filled_normal_N == map.filled_normal_N);
    CHECK(back.source.choices.size() == 3);
    CHECK(std::get<std::vector<double>>(back.source.choices[1].value)[1] == 2.0);
    const auto said = [&](std::size_t i, float value) {
        NpyArray array{{2, 3, 4}, map.filled_normal_N};
        array.values[i] = value;
        write_text_atomically(folder / "x.map/filled_normal_N.npy", npy_bytes(array));
        return message_of([&] { read_map(folder / "x.map"); });
    };
    CHECK(contains(said(5, NAN), "filled_normal_N.npy: value 5"));
    CHECK(contains(said(6, 100.0f), "value 6: found 100, expected the force of normal_N.npy"));
    CHECK(said(5, 7.0f) == "");
}

TEST_CASE("hard case 7: a transposed or otherwise wrong array is an error, not a picture") {
    const TemporaryFolder folder;
    write_map(small(), folder / "x.map");
    const auto replaced = [&](const NpyArray& array) {
        write_text_atomically(folder / "x.map/normal_N.npy", npy_bytes(array));
        return message_of([&] { read_map(folder / "x.map"); });
    };
    const std::vector<float> values(24, 1.0f);
    CHECK(contains(replaced({{2, 4, 3}, values}), "normal_N.npy: shape: found (2, 4, 3), expected (2, 3, 4)"));
    CHECK(contains(replaced({{3, 4, 2}, values}), "expected (2, n_y, n_x) for 2 depths"));
    CHECK(contains(replaced({{24}, values}), "found (24,)"));
    CHECK(contains(replaced({{2, 3, 4}, std::vector<float>(24, NAN)}), "no force that was measured"));
    CHECK(contains(replaced({{2, 3, 4}, std::vector<float>(24, INFINITY)}), "expected forces in newtons"));
    // without a count the nodules still tell: they would lie beside the map
    CHECK(contains(refusal_of_map("\"count\": [\n    4,\n    3\n  ],", "\"count\": [\n 3,\n 4\n],"),
                   "expected (2, 4, 3)"));
}

TEST_CASE("map file: absurd numbers and unknown keys are refused by key") {
    CHECK(contains(refusal_of_map("\"spacing_mm\": [\n    1.0", "\"spacing_mm\": [\n    -1.0"),
                   "spacing_mm: found -1.0"));
    CHECK(contains(refusal_of_map("\"depths_mm\": [\n    1.0", "\"depths_mm\": [\n    3.0"),
                   "depths_mm: found 2 after 3, expected ascending"));
    CHECK(contains(refusal_of_map("\"name\"", "\"nome\""), "nome: found an unknown key"));
    CHECK(contains(refusal_of_map("\"name\"", "\"colour\": 1, \"name\""), "colour: found an unknown key"));
    CHECK(contains(refusal_of_map("\"none\"", "\"recorded\""),
                   "tangential: found recorded, expected tangential_x_N.npy"));
    CHECK(contains(refusal_of_map("\"x_mm\": 2.0", "\"x_mm\": 20.0"), "are x and y of the arrays exchanged?"));
    CHECK(contains(refusal_of_map("\"nodules\": [",
                                  "\"nodules\": [{\"id\": \"A\", \"origin\": \"placed\", \"x_mm\": 1, \"y_mm\": 1},"),
                   "id: found 'A' twice"));
    CHECK(contains(refusal_of_map("}", ""), "map.json: line"));
}

TEST_CASE("map file: no folder, a file instead, an empty folder") {
    const TemporaryFolder folder;
    CHECK(contains(message_of([&] { read_map(folder / "none.map"); }), "found nothing, expected a map folder"));
    write_text_atomically(folder / "file.map", "x");
    CHECK(contains(message_of([&] { read_map(folder / "file.map"); }), "found a file"));
    std::filesystem::create_directory(folder / "empty.map");
    CHECK(contains(message_of([&] { read_map(folder / "empty.map"); }), "map.json: cannot be read"));
}
