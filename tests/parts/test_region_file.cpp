#include <doctest/doctest.h>

#include "parts/region_file.h"
#include "tests/error_message.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::mechanics;
using namespace palpa::parts;
using namespace palpa::test;

namespace {

Region region_of(const char* text) {
    const Json json = Json::parse(text);
    JsonReader reader(json, "p.json", "add");
    return read_region(reader);
}

}  // namespace

TEST_CASE("region file: each kind holds the points that it should") {
    struct Case {
        const char* text;
        Point inside_mm, outside_mm;
    };
    for (const Case& c :
         {Case{R"({"box": {"min_mm": [0, 1, 2], "max_mm": [3, 4, 5]}})", {1, 2, 3}, {1, 2, 6}},
          Case{R"({"sphere": {"centre_mm": [5, 5, 5], "radius_mm": 2}})", {6, 6, 6}, {7, 7, 5}},
          Case{
              R"({"cylinder": {"from_mm": [0, 0, 0], "to_mm": [0, 0, 9], "radius_mm": 1}})", {0.5, 0.5, 8}, {0, 0, 10}},
          Case{R"({"path": {"points_mm": [[0, 0, 0], [9, 0, 0]], "radius_mm": 1}})", {-0.5, 0, 0}, {5, 1.1, 0}},
          Case{R"({"path": {"points_mm": [[0, 0, 0], [9, 0, 0]], "radius_mm": 1, "ends": "flat"}})",
               {1, 0, 0},
               {-0.5, 0, 0}},
          Case{R"({"bands": {"axis": "y", "offset_mm": 1, "period_mm": 4, "width_mm": 1}})", {0, 5.5, 0}, {0, 6.5, 0}},
          Case{R"({"both": [{"all": true}, {"sphere": {"centre_mm": [0, 0, 0], "radius_mm": 1}}]})",
               {0.5, 0, 0},
               {2, 0, 0}},
          Case{R"({"any": [{"sphere": {"centre_mm": [5, 0, 0], "radius_mm": 1}},
                           {"sphere": {"centre_mm": [0, 0, 0], "radius_mm": 1}}]})",
               {5, 0, 0},
               {2, 0, 0}},
          Case{R"({"without": [{"sphere": {"centre_mm": [0, 0, 0], "radius_mm": 3}},
                               {"sphere": {"centre_mm": [0, 0, 0], "radius_mm": 1}}]})",
               {2, 0, 0},
               {0.5, 0, 0}}}) {
        CAPTURE(c.text);
        const Region region = region_of(c.text);
        const auto in_m = [](const Point& p) { return Point{1e-3 * p[0], 1e-3 * p[1], 1e-3 * p[2]}; };
        CHECK(mechanics::contains(region, in_m(c.inside_mm)));
        CHECK_FALSE(mechanics::contains(region, in_m(c.outside_mm)));
    }
}

TEST_CASE("region file: what is no region is refused with its key") {
    struct Case {
        const char* text;
        const char* message;
    };
    for (const Case& c :
         {Case{"{}", "0 regions"}, Case{R"({"all": true, "box": {}})", "2 regions"},
          Case{R"({"all": false})", "add.all"},
          Case{R"({"box": {"min_mm": [0, 0, 0], "max_mm": [1, 0, 1]}})", "add.box.max_mm"},
          Case{R"({"sphere": {"centre_mm": [0, 0, 0], "radius_mm": 0}})", "add.sphere.radius_mm"},
          Case{R"({"sphere": {"centre_mm": [0, 0], "radius_mm": 1}})", "add.sphere.centre_mm"},
          Case{R"({"cylinder": {"from_mm": [0, 0, 0], "to_mm": [0, 0, 0], "radius_mm": 1}})", "add.cylinder.to_mm"},
          Case{R"({"path": {"points_mm": [], "radius_mm": 1}})", "at least one point"},
          Case{R"({"path": {"points_mm": [[0, 0, 0]], "radius_mm": 1, "ends": "flat"}})", "two, for a cylinder"},
          Case{R"({"stl": {"file": "a.stl"}})", "add.stl.unit"},
          Case{R"({"stl": {"file": "a.stl", "unit": "miles"}})", "add.stl.unit"},
          Case{R"({"path": {"points_mm": [[0, 0, 0], [1, 2]], "radius_mm": 1}})", "points_mm.1"},
          Case{R"({"bands": {"axis": "x", "period_mm": 2, "width_mm": 3}})", "add.bands.width_mm"},
          Case{R"({"any": [{"all": true}]})", "at least 2"}}) {
        CAPTURE(c.text);
        const std::string message = message_of([&] { region_of(c.text); });
        CAPTURE(message);
        CHECK(test::contains(message, c.message));
    }
}
