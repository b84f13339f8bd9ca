#include <doctest/doctest.h>
#include <string>

#include "accuracy/speed.h"
#include "files/text.h"
#include "tests/close_to.h"

using namespace palpa;
using namespace palpa::files;
using namespace palpa::scene;
using namespace palpa::accuracy;
using namespace palpa::test;

TEST_CASE("bench speed: every time stands beside its ratio to the machine's unit") {
    const SpeedRow unit = machine_unit(3);
    CHECK(unit.least_us > 0.0);
    CHECK(unit.median_us >= unit.least_us);
    CHECK(unit.repetitions == 3);
    const Scene scene = read_scene(PALPA_SOURCE_DIR "/assets/scenes/off.json", PALPA_SOURCE_DIR "/assets");
    const SpeedRow row = sample_speed(scene, make_plan(scene), 0.5, 2);
    CHECK(row.least_us > 0.0);
    CHECK(row.median_us >= row.least_us);
    CHECK(row.p99_us > 0.0);
    const Json json = speed_json(unit, {row}, this_machine());
    CHECK(json["unit_us"]["least"] == unit.least_us);
    CHECK(json["rows"][0]["least_in_units"].get<double>() == close_to(row.least_us / unit.least_us));
    CHECK(json["rows"][0]["p99_in_units"].get<double>() == close_to(row.p99_us / unit.least_us));
    const std::string table = speed_table(unit, {row});
    CHECK(table.find(row.what) != std::string::npos);
    CHECK(table.find(short_number(row.least_us / unit.least_us) + " units") != std::string::npos);
}
